// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdlib>
#include <limits>
#include <plica/meshes/msh/msh_gather.hpp>

namespace plica {

void MshGather::add_name(const TextLines& lines) {
  const std::int64_t dimension = lines.integer(0, "the dimension of a physical group");
  if (dimension < 0 || dimension > 3)
    lines.fail("the dimension of a physical group is " + std::to_string(dimension) + "; it must be 0 to 3");
  const Group group(static_cast<int>(dimension), lines.integer(1, "the tag of a physical group"));
  const std::string_view text = lines.text();
  const std::size_t open = text.find('"'), close = text.rfind('"');
  if (lines.words().size() < 3 || lines.words()[2].front() != '"' || close <= open + 1 || close + 1 != text.size())
    lines.expected("a dimension, a tag and a name in quotes");
  const std::string name(text.substr(open + 1, close - open - 1));
  const auto taken = names_.find(group);
  const auto [region, is_new] = group.first == 3 ? regions_.try_emplace(name, group) : std::pair(regions_.end(), true);
  if (taken != names_.end() || !is_new) {
    const Group other = taken != names_.end() ? group : region->second;
    lines.fail("physical group " + std::to_string(group.second) + " " + shown(name) + ": group " +
               std::to_string(other.second) + " of dimension " + std::to_string(other.first) + " is " +
               shown(names_.at(other)) + " already");
  }
  names_[group] = name;
}

void MshGather::add_node(std::int64_t tag, Numbers& numbers, const Place& place) {
  constexpr const char* what[] = {"coordinate x", "coordinate y", "coordinate z"};
  RawVertex vertex{tag, {}, place};
  for (int a = 0; a < 3; ++a) vertex.position[a] = numbers.number(NumberType::float64, what[a]);
  raw_.vertices.push_back(vertex);
}

void MshGather::add_element(const ElementKind& kind, std::int64_t tag, std::span<const std::int64_t> groups,
                            NumberType node_type, Numbers& numbers, const Place& place) {
  std::array<std::int64_t, 4> nodes = {};
  const std::size_t corners = static_cast<std::size_t>(kind.vertices);
  for (std::size_t k = 0; k < corners; ++k) nodes[k] = numbers.integer(node_type, "a node of an element");
  numbers.end(kind.name);
  const std::int64_t group = groups.empty() ? 0 : groups.front();
  if (kind.dimension == 3) {
    raw_.tets.push_back({tag, nodes, 0, place});
    tet_groups_.push_back(group);
    return;
  }
  ++report_.other_elements[kind.name];
  if (corners == 3) raw_.triangles.push_back({tag, {nodes[0], nodes[1], nodes[2]}, 0, place});
  for (std::size_t k = 0; k < corners; ++k) {
    if (group == 0 && corners != 3) raw_.others.push_back({nodes[k], place});
    for (const std::int64_t g : groups)
      if (g != 0) groups_[{kind.dimension, g}].push_back({nodes[k], place});
  }
}

std::string MshGather::name_of(const Group& group) const {
  const auto found = names_.find(group);
  return found != names_.end() ? found->second : "physical_" + std::to_string(group.second);
}

RawMesh MshGather::take() {
  name_regions(raw_, tet_groups_, [this](std::int64_t tag) { return name_of({3, tag}); });
  for (const auto& [group, mentions] : groups_) {
    auto& set = raw_.vertex_sets[name_of(group)];
    set.insert(set.end(), mentions.begin(), mentions.end());
  }
  return std::move(raw_);
}

const ElementKind& taken_element(std::int64_t type, const std::function<std::string()>& who, const Numbers& numbers) {
  return taken_kind(msh_elements, type, who, numbers.file(), numbers.place());
}

std::int64_t msh_tag(NumberType type, std::string_view what, Numbers& numbers) {
  const std::int64_t tag = numbers.integer(type, what);
  if (tag < 1) numbers.fail(std::string(what) + " is " + std::to_string(tag) + "; it must be 1 or more");
  return tag;
}

std::int64_t physical_tag(Numbers& numbers) {
  const std::int64_t tag = numbers.integer(NumberType::int32, "the physical group of an element");
  if (std::max(tag, -1 - tag) > std::numeric_limits<int>::max())
    numbers.fail("the physical group of an element is " + std::to_string(tag) + "; it must fit 32 bits");
  return std::abs(tag);
}

}  // namespace plica
