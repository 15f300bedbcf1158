// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <numeric>
#include <plica/core/error.hpp>
#include <plica/core/valid_utf8.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/checked.hpp>
#include <plica/meshes/embedding.hpp>
#include <plica/meshes/files/raw_mesh.hpp>
#include <plica/meshes/files/sound_mesh.hpp>
#include <plica/meshes/mesh_quality.hpp>
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

// Files name groups in any encoding; from here on names are UTF-8. A name of a region and of a set stays one name.
void name_in_utf8(TetMesh& mesh) {
  std::vector<std::string> names = mesh.region_names;
  for (const auto& [name, set] : mesh.vertex_sets) names.push_back(name);
  const std::map<std::string, std::string> valid = valid_names(names);
  for (std::string& name : mesh.region_names) name = valid.at(name);
  std::map<std::string, std::vector<int>> sets;
  for (auto& [name, set] : mesh.vertex_sets) sets[valid.at(name)] = std::move(set);
  mesh.vertex_sets = std::move(sets);
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
  name_in_utf8(mesh);
  return mesh;
}

namespace {

constexpr double flat_triangle = 1e-12;  // twice the area over the longest edge squared

using Triangle = std::array<int, 3>;

void refuse_flat(const RawMesh& raw, const RawTriangle& triangle, const Point& a, const Point& b, const Point& c) {
  const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
  if (!((b - a).cross(c - a).norm() > flat_triangle * longest * longest))
    refuse(raw.file, triangle.place,
           "triangle " + std::to_string(triangle.tag) + " has no area: its vertices lie on a line");
}

// All vertices as yet, with their positions in the file as indices
void add_triangles(const RawMesh& raw, TriangleSurface& surface, SurfaceReport& report) {
  const VertexNumbers numbering(raw);
  for (const RawMention& mention : raw.others)
    numbering.at(mention.vertex, mention.place, [] { return std::string("an element"); });
  for (const RawTriangle& triangle : raw.triangles) {
    Triangle v;
    for (std::size_t k = 0; k < 3; ++k)
      v[k] = numbering.at(triangle.vertices[k], triangle.place,
                          [&] { return "triangle " + std::to_string(triangle.tag); });
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) {
      ++report.collapsed;
      continue;
    }
    const auto at = [&](int k) -> const Point& { return surface.vertices[static_cast<std::size_t>(k)]; };
    refuse_flat(raw, triangle, at(v[0]), at(v[1]), at(v[2]));
    surface.triangles.push_back(v);
  }
  if (surface.triangles.empty()) refuse(raw.file, Place{}, "all triangles of the file name a vertex twice");
}

// With the smallest vertex first, in the same turn
Triangle turned(Triangle t) {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}

// The first of each is kept, in its order
void drop_repeats(TriangleSurface& surface, SurfaceReport& report) {
  std::vector<std::size_t> order(surface.triangles.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto key = [&](std::size_t t) { return turned(surface.triangles[t]); };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
  std::vector<bool> again(order.size(), false);
  for (std::size_t k = 1; k < order.size(); ++k) again[order[k]] = key(order[k]) == key(order[k - 1]);
  std::size_t kept = 0;
  for (std::size_t t = 0; t < again.size(); ++t)
    if (!again[t]) surface.triangles[kept++] = surface.triangles[t];
  report.repeated = static_cast<int>(surface.triangles.size() - kept);
  surface.triangles.resize(kept);
}

void drop_unreferenced(TriangleSurface& surface, SurfaceReport& report) {
  std::vector<int> number(surface.vertices.size(), -1);
  for (const Triangle& triangle : surface.triangles)
    for (const int v : triangle) number[static_cast<std::size_t>(v)] = 0;
  std::size_t kept = 0;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] < 0) continue;
    number[v] = static_cast<int>(kept);
    surface.vertices[kept++] = surface.vertices[v];
  }
  report.unreferenced = static_cast<int>(surface.vertices.size() - kept);
  surface.vertices.resize(kept);
  for (Triangle& triangle : surface.triangles)
    for (int& v : triangle) v = number[static_cast<std::size_t>(v)];
}

}  // namespace

TriangleSurface sound_surface(const RawMesh& raw, const MeshReport& found, SurfaceReport& report) {
  if (raw.triangles.empty()) refuse(raw.file, Place{}, "the file holds no triangle");
  if (const auto quads = found.other_elements.find("quadrangle"); quads != found.other_elements.end())
    refuse(raw.file, Place{},
           "the file holds " + std::to_string(quads->second) + " quadrangles; supported are triangles");
  checked_count("the number of vertices", static_cast<double>(raw.vertices.size()));
  checked_count("the number of triangles", static_cast<double>(raw.triangles.size()));
  report.format = found.format;
  TriangleSurface surface;
  for (const RawVertex& vertex : raw.vertices) surface.vertices.push_back(vertex.position);
  add_triangles(raw, surface, report);
  drop_repeats(surface, report);
  drop_unreferenced(surface, report);
  count_edges(surface, report);
  report.parts = count_parts(surface);
  report.turned = report.closed() && enclosed_volume(surface) < 0.0;
  if (report.turned)
    for (Triangle& triangle : surface.triangles) std::swap(triangle[1], triangle[2]);
  return surface;
}

namespace {

// Per vertex the one that stands for it
std::vector<std::int64_t> representatives(const TetMesh& mesh, double tolerance) {
  std::vector<std::int64_t> stands_for;
  for (const int twin : lower_twins(mesh.vertices, tolerance)) {
    const auto self = static_cast<std::int64_t>(stands_for.size());
    stands_for.push_back(twin < 0 ? self : stands_for[static_cast<std::size_t>(twin)]);
  }
  return stands_for;
}

}  // namespace

MergedMesh merge_duplicates(const TetMesh& mesh, double tolerance) {
  if (!std::isfinite(tolerance) || tolerance < 0.0)
    throw InputError("the tolerance for duplicate vertices is " + std::to_string(tolerance) +
                     "; it must be finite and not below zero");
  const std::vector<std::int64_t> stands_for = representatives(mesh, tolerance);
  const auto of = [&](int v) { return stands_for[static_cast<std::size_t>(v)]; };
  RawMesh raw;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    if (stands_for[v] == static_cast<std::int64_t>(v)) raw.vertices.push_back({stands_for[v], mesh.vertices[v], {}});
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const auto& [a, b, c, d] = mesh.tets[t];
    raw.tets.push_back(
        {static_cast<std::int64_t>(t), {of(a), of(b), of(c), of(d)}, mesh.region.empty() ? 0 : mesh.region[t], {}});
  }
  raw.region_names = mesh.region_names;
  for (const auto& [name, vertices] : mesh.vertex_sets)
    for (auto& mentions = raw.vertex_sets[name]; const int v : vertices) mentions.push_back({of(v), {}});

  MergedMesh result;
  MeshReport report;
  try {
    result.mesh = sound_mesh(raw, report);
  } catch (const InputError& error) {
    std::ostringstream text;
    text << "vertices at most " << tolerance << " m apart cannot be merged: " << error.what();
    throw InputError(text.str());
  }
  result.merged = static_cast<int>(mesh.vertices.size() - raw.vertices.size());
  result.original_vertex.assign(report.vertex_tags.begin(), report.vertex_tags.end());
  return result;
}

}  // namespace plica
