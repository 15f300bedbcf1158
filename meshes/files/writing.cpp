// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <plica/meshes/files/writing.hpp>
#include <set>

namespace plica {

namespace {

constexpr std::int64_t tags_end = 1'000'000'000;

// Returns the number after the last underscore, 1 or more; 0: there is none
std::int64_t number_at_end(const std::string& name) {
  const std::size_t at = name.rfind('_');
  std::int64_t number = 0;
  if (at == std::string::npos) return 0;
  const char *begin = name.data() + at + 1, *end = name.data() + name.size();
  const auto [stop, error] = std::from_chars(begin, end, number);
  return error == std::errc() && stop == end && *begin != '0' && number > 0 && number < tags_end
             ? number
             : 0;
}

// Replaces numbers that a group cannot have, such as 0 for none, by free ones
void make_positive(std::vector<std::int64_t>& tags) {
  const auto usable = [](std::int64_t tag) { return tag > 0 && tag < tags_end; };
  std::int64_t last = 0;
  for (const std::int64_t tag : tags)
    if (usable(tag)) last = std::max(last, tag);
  for (std::int64_t& tag : tags)
    if (!usable(tag)) tag = ++last;
}

template <typename Number>
void append(std::string& text, Number number) {
  char digits[32];
  text.append(digits, std::to_chars(digits, digits + sizeof(digits), number).ptr);
}

}  // namespace

TextOut& TextOut::operator<<(double number) { return append(text_, number), *this; }

TextOut& TextOut::operator<<(std::int64_t number) { return append(text_, number), *this; }

std::vector<std::int64_t> numbers_of(const std::vector<std::string>& names) {
  std::vector<std::int64_t> numbers;
  for (const std::string& name : names) numbers.push_back(number_at_end(name));
  const std::set<std::int64_t> used(numbers.begin(), numbers.end());
  if (used.size() == numbers.size() && !used.contains(0)) return numbers;
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<std::int64_t>(i) + 1;
  return numbers;
}

std::vector<std::int64_t> region_tags(const TetMesh& mesh, const MeshGroups& groups) {
  std::vector<std::int64_t> tags = groups.region_tags;
  return tags.size() == mesh.region_names.size() ? (make_positive(tags), tags)
                                                 : numbers_of(mesh.region_names);
}

std::vector<std::int64_t> region_numbers(const TetMesh& mesh, const MeshGroups& groups) {
  const std::vector<std::int64_t> numbers = region_tags(mesh, groups);
  std::vector<std::int64_t> regions;
  for (const int region : mesh.region) regions.push_back(numbers[static_cast<std::size_t>(region)]);
  return regions;
}

std::vector<ElementGroup> groups_of(const TetMesh& mesh, const MeshGroups& groups) {
  std::vector<ElementGroup> all = groups.sets;
  for (const auto& [name, vertices] : mesh.vertex_sets) {
    if (std::ranges::any_of(groups.sets,
                            [&](const ElementGroup& group) { return group.name == name; }))
      continue;
    std::set<int> alone(vertices.begin(), vertices.end());  // vertices of no triangle of the set
    const auto triangles = mesh.triangle_sets.find(name);
    if (triangles != mesh.triangle_sets.end()) {
      all.push_back({name, 2, 0, triangles->second});
      for (const auto& triangle : triangles->second)
        for (const int v : triangle) alone.erase(v);
      if (alone.empty()) continue;
    }
    ElementGroup& group = all.emplace_back(ElementGroup{name, 0, 0, {}});
    for (const int v : alone) group.elements.push_back({v, -1, -1});
  }
  for (int dimension = 0; dimension < 3; ++dimension) {
    std::vector<std::int64_t> tags;
    for (const ElementGroup& group : all)
      if (group.dimension == dimension) tags.push_back(group.tag);
    make_positive(tags);
    auto next = tags.begin();
    for (ElementGroup& group : all)
      if (group.dimension == dimension) group.tag = *next++;
  }
  return all;
}

void leave_out_region_names(const TetMesh& mesh, const MeshGroups& groups,
                            const std::string& prefix, WrittenMesh& written) {
  const std::vector<std::int64_t> numbers = region_tags(mesh, groups);
  for (std::size_t i = 0; i < numbers.size(); ++i)
    if (const std::string now = prefix + std::to_string(numbers[i]); mesh.region_names[i] != now)
      written.left_out.push_back("the region '" + mesh.region_names[i] + "' is now '" + now +
                                 "', as this format numbers them");
}

void leave_out_filled(const TetMesh& mesh, WrittenMesh& written) {
  if (!mesh.filled.empty())
    written.left_out.push_back(
        "the parts of the tetrahedra that are body are left out: only .msh has them");
}

void leave_out_vertex_sets(const TetMesh& mesh, WrittenMesh& written) {
  for (const auto& [name, vertices] : mesh.vertex_sets)
    written.left_out.push_back("the vertex set '" + name + "' is left out: this format has none");
}

NumbersOut& NumbersOut::text(std::string_view text) { return bytes_ += text, *this; }

template <typename Number>
NumbersOut& NumbersOut::add(Number number) {
  if (binary_) {
    std::array<char, sizeof(Number)> bytes;
    std::memcpy(bytes.data(), &number, sizeof(Number));
    if (order_ != std::endian::native) std::reverse(bytes.begin(), bytes.end());
    bytes_.append(bytes.data(), bytes.size());
    return *this;
  }
  char digits[32];
  if (line_begun_) bytes_ += ' ';
  bytes_.append(digits, std::to_chars(digits, digits + sizeof(digits), number).ptr);
  line_begun_ = true;
  return *this;
}

NumbersOut& NumbersOut::int32(std::int64_t number) {
  return add(static_cast<std::int32_t>(number));
}
NumbersOut& NumbersOut::int64(std::int64_t number) { return add(number); }
NumbersOut& NumbersOut::real32(double number) {
  return binary_ ? add(static_cast<float>(number)) : add(number);
}
NumbersOut& NumbersOut::real64(double number) { return add(number); }

NumbersOut& NumbersOut::end() {
  if (!binary_) bytes_ += '\n';
  line_begun_ = false;
  return *this;
}

}  // namespace plica
