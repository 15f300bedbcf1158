// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdlib>
#include <limits>
#include <plica/meshes/files/msh_bodies.hpp>

namespace plica {

void MshGather::add_name(const TextLines& lines) {
  const std::int64_t dimension = lines.integer(0, "the dimension of a physical group");
  if (dimension < 0 || dimension > 3)
    lines.fail("the dimension of a physical group is " + std::to_string(dimension) +
               "; it must be 0 to 3");
  const Group group(static_cast<int>(dimension), lines.integer(1, "the tag of a physical group"));
  const std::string_view text = lines.text();
  const std::size_t open = text.find('"'), close = text.rfind('"');
  if (lines.words().size() < 3 || lines.words()[2].front() != '"' || close <= open + 1 ||
      close + 1 != text.size())
    lines.expected("a dimension, a tag and a name in quotes");
  const std::string name(text.substr(open + 1, close - open - 1));
  const auto taken = names_.find(group);
  const auto [region, is_new] =
      group.first == 3 ? regions_.try_emplace(name, group) : std::pair(regions_.end(), true);
  if (taken != names_.end() || !is_new) {
    const Group other = taken != names_.end() ? group : region->second;
    lines.fail("physical group " + std::to_string(group.second) + " " + shown(name) + ": group " +
               std::to_string(other.second) + " of dimension " + std::to_string(other.first) +
               " is " + shown(names_.at(other)) + " already");
  }
  names_[group] = name;
}

void MshGather::add_node(std::int64_t tag, Numbers& numbers, const Place& place) {
  constexpr const char* what[] = {"coordinate x", "coordinate y", "coordinate z"};
  RawVertex vertex{tag, {}, place};
  for (int a = 0; a < 3; ++a) vertex.position[a] = numbers.number(NumberType::float64, what[a]);
  raw_.vertices.push_back(vertex);
}

void MshGather::add_element(const ElementKind& kind, std::int64_t tag,
                            std::span<const std::int64_t> groups, NumberType node_type,
                            Numbers& numbers, const Place& place) {
  nodes_.clear();
  for (int k = 0; k < kind.vertices; ++k)
    nodes_.push_back(numbers.integer(node_type, "a node of an element"));
  numbers.end(kind.name);
  const std::size_t tets = plica::add_element(kind, tag, nodes_, place, raw_, report_);
  tet_groups_.insert(tet_groups_.end(), tets, groups.empty() ? 0 : groups.front());
  if (kind.dimension == 3) return;
  for (const std::int64_t g : groups)
    if (g != 0) add_to_group(kind, tag, nodes_, place, groups_[{kind.dimension, g}]);
}

void MshGather::add_vectors(const std::string& name, bool of_nodes, std::int64_t count,
                            Numbers& numbers) {
  RawVectors& field = raw_.vectors.emplace_back(RawVectors{name, of_nodes, {}, {}});
  for (std::int64_t i = 1; i <= count; ++i) {
    numbers.begin("vector", i, count);
    const std::int64_t tag = msh_tag(NumberType::int32, "the tag of a vector", numbers);
    if (!field.place.try_emplace(tag, field.values.size()).second)
      numbers.fail("tag " + std::to_string(tag) + " has a vector " + shown(name) + " already");
    Point& value = field.values.emplace_back();
    for (double& x : value) x = numbers.any_number(NumberType::float64, "a component of a vector");
    numbers.end("a vector: its tag and three components");
  }
}

void MshGather::add_filled(std::int64_t count, Numbers& numbers) {
  for (std::int64_t i = 1; i <= count; ++i) {
    numbers.begin("part", i, count);
    const std::int64_t tag = msh_tag(NumberType::int32, "the tag of a part", numbers);
    if (!raw_.filled.place.try_emplace(tag, raw_.filled.values.size()).second)
      numbers.fail("tag " + std::to_string(tag) + " has a part already");
    raw_.filled.values.emplace_back(numbers.number(NumberType::float64, "the part of an element"),
                                    0, 0);
    numbers.end("a part: its tag and a number");
  }
}

std::string MshGather::name_of(const Group& group, const std::map<Group, std::string>& names) {
  const auto found = names.find(group);
  return found != names.end() ? found->second : "physical_" + std::to_string(group.second);
}

ParsedMesh MshGather::take() {
  raw_.numbers.push_back({"physical",
                          std::move(tet_groups_),
                          [names = names_](std::int64_t tag) {
                            return name_of({3, tag}, names);
                          },
                          true,
                          {}});
  for (auto& [key, group] : groups_) {
    group.name = name_of(key, names_), group.dimension = key.first, group.tag = key.second;
    raw_.groups.push_back(std::move(group));
  }
  return std::move(raw_);
}

const ElementKind& taken_element(std::int64_t type, const std::function<std::string()>& who,
                                 const Numbers& numbers) {
  return taken_kind(msh_elements, type, who, numbers.file(), numbers.place());
}

std::int64_t msh_tag(NumberType type, std::string_view what, Numbers& numbers) {
  const std::int64_t tag = numbers.integer(type, what);
  if (tag < 1)
    numbers.fail(std::string(what) + " is " + std::to_string(tag) + "; it must be 1 or more");
  return tag;
}

std::int64_t physical_tag(Numbers& numbers) {
  const std::int64_t tag = numbers.integer(NumberType::int32, "the physical group of an element");
  if (std::max(tag, -1 - tag) > std::numeric_limits<int>::max())
    numbers.fail("the physical group of an element is " + std::to_string(tag) +
                 "; it must fit 32 bits");
  return std::abs(tag);
}

namespace {

void read_element(const ElementKind& kind, std::int64_t tag, std::int64_t tags, const Place& place,
                  Numbers& numbers, MshGather& gather) {
  const std::int64_t group = tags > 0 ? physical_tag(numbers) : 0;
  for (std::int64_t t = 1; t < tags; ++t) numbers.integer(NumberType::int32, "a tag of an element");
  gather.add_element(kind, tag, {&group, 1}, NumberType::int32, numbers, place);
}

std::int64_t read_tags(Numbers& numbers) {
  return numbers.count(NumberType::int32, "the number of tags of an element", NumberType::int32, 1);
}

}  // namespace

void msh2_nodes(std::int64_t count, Numbers& numbers, MshGather& gather) {
  for (std::int64_t i = 1; i <= count; ++i) {
    numbers.begin("node", i, count);
    const std::int64_t tag = msh_tag(NumberType::int32, "the tag of a node", numbers);
    gather.add_node(tag, numbers, numbers.place());
    numbers.end("a node: its tag and three coordinates");
  }
}

void msh1_elements(std::int64_t count, Numbers& numbers, MshGather& gather) {
  constexpr NumberType type = NumberType::int32;
  for (std::int64_t i = 1; i <= count; ++i) {
    numbers.begin("element", i, count);
    const std::int64_t tag = numbers.integer(type, "the tag of an element");
    const Place place = numbers.place();
    const auto who = [&] { return "element " + std::to_string(tag); };
    const ElementKind& kind =
        taken_element(numbers.integer(type, "the type of an element"), who, numbers);
    const std::int64_t group = physical_tag(numbers);
    numbers.integer(type, "the elementary group of an element");
    if (const std::int64_t nodes = numbers.integer(type, "the number of nodes of an element");
        nodes != kind.vertices)
      numbers.fail(who() + ", a " + kind.name + ", has " + std::to_string(nodes) +
                   " nodes; expected " + std::to_string(kind.vertices));
    gather.add_element(kind, tag, {&group, 1}, type, numbers, place);
  }
}

void msh2_elements(std::int64_t count, bool binary, Numbers& numbers, MshGather& gather) {
  constexpr NumberType type = NumberType::int32;
  for (std::int64_t done = 0; done < count;) {
    numbers.begin("element", done + 1, count);
    std::int64_t tag = binary ? 0 : numbers.integer(type, "the tag of an element");
    const Place place = numbers.place();
    const std::int64_t code = numbers.integer(type, "the type of an element");
    const auto who = [&] {
      return binary ? "a block of elements" : "element " + std::to_string(tag);
    };
    const ElementKind& kind = taken_element(code, who, numbers);
    if (!binary) {
      read_element(kind, tag, read_tags(numbers), place, numbers, gather);
      ++done;
      continue;
    }
    const std::int64_t block = numbers.integer(type, "the number of elements of a block");
    if (block < 1 || block > count - done)
      numbers.fail("the number of elements of a block is " + std::to_string(block) +
                   "; it must be 1 to " + std::to_string(count - done) + ", as there are " +
                   std::to_string(count) + " in all");
    const std::int64_t tags = read_tags(numbers);
    for (std::int64_t i = 0; i < block; ++i, ++done) {
      tag = numbers.integer(type, "the tag of an element");
      read_element(kind, tag, tags, numbers.place(), numbers, gather);
    }
  }
}

namespace {

constexpr NumberType tag_type = NumberType::int32, size_type = NumberType::uint64,
                     coordinate_type = NumberType::float64;
constexpr const char* dimension_names[] = {"point", "curve", "surface", "volume"};

std::int64_t read_dimension(Numbers& numbers) {
  const std::int64_t dimension = numbers.integer(tag_type, "the dimension of an entity");
  if (dimension < 0 || dimension > 3)
    numbers.fail("the dimension of an entity is " + std::to_string(dimension) +
                 "; it must be 0 to 3");
  return dimension;
}

// Head of a section of blocks: the number of blocks, and of nodes or elements in all of them
struct Blocks {
  std::int64_t blocks = 0, total = 0;
};
Blocks read_blocks(const std::string& what, std::int64_t fewest, Numbers& numbers) {
  numbers.begin("the number of blocks of " + what);
  Blocks header;
  header.blocks = numbers.count(size_type, "the number of blocks of " + what, tag_type, 4);
  header.total = numbers.count(size_type, "the number of " + what, tag_type, fewest);
  numbers.skip(2, size_type, "the smallest and largest tag");
  numbers.end("the number of blocks and of " + what + ", the smallest and the largest tag");
  return header;
}

// Reads the number of nodes or elements of a block; `done` have been read before it
std::int64_t read_size(const std::string& what, std::int64_t done, const Blocks& all,
                       Numbers& numbers) {
  const std::int64_t size = numbers.integer(size_type, "the number of " + what + " of a block");
  if (size < 0 || size > all.total - done)
    numbers.fail("the number of " + what + " of a block is " + std::to_string(size) +
                 "; it must be 0 to " + std::to_string(all.total - done) + ", as there are " +
                 std::to_string(all.total) + " in all");
  return size;
}

void check_total(const std::string& what, std::int64_t done, const Blocks& all,
                 const Numbers& numbers) {
  if (done != all.total)
    numbers.fail("the blocks hold " + std::to_string(done) + " " + what + " and not " +
                 std::to_string(all.total));
}

}  // namespace

void Msh4Bodies::read_entity(std::int64_t dimension, bool partitioned, Numbers& numbers,
                             std::map<Entity, std::size_t>& here) {
  numbers.begin("an entity");
  const Entity entity(dimension, numbers.integer(tag_type, "the tag of an entity"));
  const std::string who = dimension_names[dimension] + (" " + std::to_string(entity.second));
  if (!here.try_emplace(entity, here.size()).second) numbers.fail(who + " is defined again");
  if (partitioned) {
    numbers.skip(2, tag_type, "the dimension and tag of the parent");
    const auto partitions =
        numbers.count(size_type, "the number of partitions of an entity", tag_type, 1);
    numbers.skip(partitions, tag_type, "a partition");
  }
  for (int i = 0; i < (dimension == 0 ? 3 : 6); ++i)
    numbers.number(coordinate_type, "a coordinate of an entity");
  std::vector<std::int64_t>& groups = groups_[entity];
  groups.clear();
  const auto count =
      numbers.count(size_type, "the number of physical groups of an entity", tag_type, 1);
  for (std::int64_t i = 0; i < count; ++i) groups.push_back(physical_tag(numbers));
  std::sort(groups.begin(), groups.end());
  groups.erase(std::unique(groups.begin(), groups.end()), groups.end());
  if (dimension == 3 && groups.size() > 1)
    numbers.fail(who + " belongs to the physical groups " + std::to_string(groups[0]) + " and " +
                 std::to_string(groups[1]) + "; an element belongs in one group of volumes only");
  if (dimension > 0) {
    const auto boundary =
        numbers.count(size_type, "the number of parts of the boundary of an entity", tag_type, 1);
    numbers.skip(boundary, tag_type, "a part of the boundary");
  }
  numbers.end("an entity");
}

void Msh4Bodies::read_entities(bool partitioned, Numbers& numbers) {
  known_ = true;
  numbers.begin("the numbers of points, curves, surfaces and volumes");
  std::int64_t counts[4];
  for (std::size_t d = 0; d < 4; ++d)
    counts[d] = numbers.count(size_type, "the number of entities", tag_type, d == 0 ? 8 : 16);
  numbers.end("the numbers of points, curves, surfaces and volumes");
  std::map<Entity, std::size_t> here;
  for (std::int64_t d = 0; d < 4; ++d)
    for (std::int64_t i = 0; i < counts[d]; ++i) read_entity(d, partitioned, numbers, here);
}

void Msh4Bodies::partitioned_entities(Numbers& numbers) {
  numbers.begin("the number of partitions");
  numbers.integer(size_type, "the number of partitions");
  numbers.end("the number of partitions");
  numbers.begin("the number of ghost entities");
  const auto ghosts = numbers.count(size_type, "the number of ghost entities", tag_type, 2);
  numbers.end("the number of ghost entities");
  for (std::int64_t i = 1; i <= ghosts; ++i) {
    numbers.begin("ghost entity", i, ghosts);
    numbers.skip(2, tag_type, "the tag and partition of a ghost entity");
    numbers.end("a ghost entity");
  }
  read_entities(true, numbers);
}

std::string Msh4Bodies::nodes(Numbers& numbers, MshGather& gather) const {
  const Blocks all = read_blocks("nodes", 4, numbers);
  std::int64_t done = 0;
  std::vector<std::pair<std::int64_t, Place>> tags;
  for (std::int64_t b = 1; b <= all.blocks; ++b) {
    numbers.begin("block of nodes", b, all.blocks);
    const std::int64_t dimension = read_dimension(numbers);
    numbers.integer(tag_type, "the tag of an entity");
    const std::int64_t parametric = numbers.integer(tag_type, "whether nodes are parametric");
    if (parametric != 0 && parametric != 1)
      numbers.fail("whether nodes are parametric is " + std::to_string(parametric) +
                   "; it must be 0 or 1");
    const std::int64_t size = read_size("nodes", done, all, numbers);
    numbers.end("a block of nodes: dimension and tag of its entity, 0 or 1, number of nodes");
    tags.clear();
    for (std::int64_t i = 1; i <= size; ++i) {
      numbers.begin("node", done + i, all.total);
      const std::int64_t tag = msh_tag(size_type, "the tag of a node", numbers);
      tags.emplace_back(tag, numbers.place());
      numbers.end("the tag of a node");
    }
    for (const auto& [tag, place] : tags) {
      numbers.begin("the coordinates of node", ++done, all.total);
      gather.add_node(tag, numbers, place);
      if (parametric == 1) numbers.skip(dimension, coordinate_type, "a parametric coordinate");
      numbers.end("the coordinates of a node");
    }
  }
  check_total("nodes", done, all, numbers);
  return std::to_string(done) + " nodes";
}

const std::vector<std::int64_t>& Msh4Bodies::groups_of(const Entity& entity,
                                                       const Numbers& numbers) const {
  static const std::vector<std::int64_t> none;
  if (!known_) return none;  // a file without $Entities has no groups
  const auto found = groups_.find(entity);
  if (found == groups_.end())
    numbers.fail("a block of elements is in " +
                 (dimension_names[entity.first] + (" " + std::to_string(entity.second))) +
                 ", which the file does not define");
  return found->second;
}

std::string Msh4Bodies::elements(Numbers& numbers, MshGather& gather) const {
  const auto who = [] { return std::string("a block of elements"); };
  const Blocks all = read_blocks("elements", 2, numbers);
  std::int64_t done = 0;
  for (std::int64_t b = 1; b <= all.blocks; ++b) {
    numbers.begin("block of elements", b, all.blocks);
    const std::int64_t dimension = read_dimension(numbers);
    const std::int64_t tag = numbers.integer(tag_type, "the tag of an entity");
    const auto& groups = groups_of({dimension, tag}, numbers);
    const ElementKind& kind =
        taken_element(numbers.integer(tag_type, "the type of elements"), who, numbers);
    if (kind.dimension != dimension)
      numbers.fail("a block of elements of dimension " + std::to_string(kind.dimension) +
                   " is in an entity of dimension " + std::to_string(dimension));
    const std::int64_t size = read_size("elements", done, all, numbers);
    numbers.end(
        "a block of elements: dimension and tag of its entity, type and number of elements");
    for (std::int64_t i = 0; i < size; ++i) {
      numbers.begin("element", ++done, all.total);
      const std::int64_t element = numbers.integer(size_type, "the tag of an element");
      gather.add_element(kind, element, groups, size_type, numbers, numbers.place());
    }
  }
  check_total("elements", done, all, numbers);
  return std::to_string(done) + " elements";
}

}  // namespace plica
