// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <numeric>
#include <plica/core/error.hpp>
#include <plica/meshes/barycentric.hpp>
#include <plica/meshes/checked.hpp>
#include <plica/meshes/sound_mesh.hpp>
#include <plica/meshes/vertex_numbers.hpp>
#include <sstream>
#include <utility>

namespace plica {

namespace {

constexpr double flat = 1e-9;  // six volumes over the longest edge cubed

template <typename... Parts>
[[noreturn]] void refuse(const RawMesh& raw, const Place& place, const Parts&... parts) {
  std::ostringstream text;
  text.precision(12);
  (text << ... << parts);
  refuse(raw.file, place, text.str());
}

std::string nodes(const RawTet& tet) {
  std::string text;
  for (const std::int64_t v : tet.vertices) text += (text.empty() ? "" : " ") + std::to_string(v);
  return text;
}

std::array<int, 4> sorted(std::array<int, 4> tet) {
  std::sort(tet.begin(), tet.end());
  return tet;
}

void refuse_flat(const RawMesh& raw, const RawTet& tet, const std::array<Point, 4>& corners, double volume) {
  double longest = 0.0;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = i + 1; j < 4; ++j) longest = std::max(longest, (corners[j] - corners[i]).norm());
  if (!(std::abs(6.0 * volume) > flat * longest * longest * longest))
    refuse(raw, tet.place, "tetrahedron ", tet.tag, " (nodes ", nodes(tet), ") has no volume: ", volume,
           " for a longest edge of ", longest);
}

// All vertices as yet, with their positions in the file as indices; the tetrahedra turned right side out
void add_tets(const RawMesh& raw, const VertexNumbers& numbering, TetMesh& mesh, MeshReport& report) {
  mesh.tets.reserve(raw.tets.size());
  for (const RawTet& tet : raw.tets) {
    std::array<int, 4> v;
    for (std::size_t k = 0; k < 4; ++k)
      v[k] = numbering.at(tet.vertices[k], tet.place, [&] { return "tetrahedron " + std::to_string(tet.tag); });
    const auto ascending = sorted(v);
    if (std::adjacent_find(ascending.begin(), ascending.end()) != ascending.end())
      refuse(raw, tet.place, "tetrahedron ", tet.tag, " names a node twice: ", nodes(tet));
    mesh.tets.push_back(v);
    const auto corners = corners_of(mesh, static_cast<int>(mesh.tets.size()) - 1);
    const double volume = tet_volume(corners[0], corners[1], corners[2], corners[3]);
    refuse_flat(raw, tet, corners, volume);
    if (volume < 0.0) std::swap(mesh.tets.back()[2], mesh.tets.back()[3]), ++report.flipped;
    if (!raw.region_names.empty()) mesh.region.push_back(tet.region);
    report.tet_tags.push_back(tet.tag);
  }
}

void refuse_repeats(const RawMesh& raw, const TetMesh& mesh) {
  std::vector<std::pair<std::array<int, 4>, std::size_t>> keys;
  keys.reserve(mesh.tets.size());
  for (const auto& tet : mesh.tets) keys.emplace_back(sorted(tet), keys.size());
  std::sort(keys.begin(), keys.end());
  std::size_t first = 0, again = keys.size();  // the first repeat in the file
  for (std::size_t k = 1; k < keys.size(); ++k)
    if (keys[k].first == keys[k - 1].first && keys[k].second < again)
      first = keys[k - 1].second, again = keys[k].second;
  if (again == keys.size()) return;
  const RawTet &one = raw.tets[first], &other = raw.tets[again];
  refuse(raw, other.place, "tetrahedron ", other.tag, " repeats tetrahedron ", one.tag, " ", to_text(one.place),
         " (nodes ", nodes(one), "); an element belongs in one group of volumes only");
}

void add_sets(const RawMesh& raw, const VertexNumbers& numbering, TetMesh& mesh) {
  const auto element = [] { return "an element"; };
  for (const RawTriangle& triangle : raw.triangles)
    for (const std::int64_t v : triangle.vertices) numbering.at(v, triangle.place, element);
  for (const RawMention& mention : raw.others) numbering.at(mention.vertex, mention.place, element);
  for (const auto& [name, mentions] : raw.vertex_sets) {
    std::vector<int>& set = mesh.vertex_sets[name];
    for (const RawMention& mention : mentions) set.push_back(numbering.at(mention.vertex, mention.place, element));
    std::sort(set.begin(), set.end());
    set.erase(std::unique(set.begin(), set.end()), set.end());
  }
}

void drop_unreferenced(const RawMesh& raw, TetMesh& mesh, MeshReport& report) {
  std::vector<int> number(mesh.vertices.size(), -1);
  for (const auto& tet : mesh.tets)
    for (const int v : tet) number[static_cast<std::size_t>(v)] = 0;
  std::size_t kept = 0;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] < 0) continue;
    number[v] = static_cast<int>(kept);
    mesh.vertices[kept++] = mesh.vertices[v];
    report.vertex_tags.push_back(raw.vertices[v].tag);
  }
  report.unreferenced = static_cast<int>(mesh.vertices.size() - kept);
  mesh.vertices.resize(kept);
  for (auto& tet : mesh.tets)
    for (int& v : tet) v = number[static_cast<std::size_t>(v)];
  for (auto& [name, set] : mesh.vertex_sets) {
    for (int& v : set) v = number[static_cast<std::size_t>(v)];
    std::erase(set, -1);
  }
}

}  // namespace

TetMesh sound_mesh(const RawMesh& raw, MeshReport& report) {
  if (raw.tets.empty()) refuse(raw, {}, "the file holds no tetrahedron");
  checked_count("the number of vertices", static_cast<double>(raw.vertices.size()));
  checked_count("the number of tetrahedra", static_cast<double>(raw.tets.size()));

  const VertexNumbers numbering(raw);
  TetMesh mesh;
  mesh.region_names = raw.region_names;
  mesh.vertices.reserve(raw.vertices.size());
  for (const RawVertex& vertex : raw.vertices) mesh.vertices.push_back(vertex.position);
  add_tets(raw, numbering, mesh, report);
  refuse_repeats(raw, mesh);
  add_sets(raw, numbering, mesh);
  drop_unreferenced(raw, mesh, report);
  return mesh;
}

}  // namespace plica
