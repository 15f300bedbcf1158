// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <numeric>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/checked.hpp>
#include <plica/meshes/connectivity.hpp>
#include <plica/meshes/sound_surface.hpp>
#include <plica/meshes/vertex_numbers.hpp>
#include <utility>

namespace plica {

namespace {

constexpr double flat = 1e-12;  // twice the area over the longest edge squared

using Triangle = std::array<int, 3>;

void refuse_flat(const RawMesh& raw, const RawTriangle& triangle, const Point& a, const Point& b, const Point& c) {
  const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
  if (!((b - a).cross(c - a).norm() > flat * longest * longest))
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
  if (surface.triangles.empty()) refuse(raw.file, {}, "all triangles of the file name a vertex twice");
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

void count_edges(const TriangleSurface& surface, SurfaceReport& report) {
  std::vector<std::pair<std::array<int, 2>, bool>> edges;  // ascending; whether the triangle runs so
  edges.reserve(surface.triangles.size() * 3);
  for (const Triangle& t : surface.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      edges.push_back({{std::min(a, b), std::max(a, b)}, a < b});
    }
  std::sort(edges.begin(), edges.end());
  for (std::size_t e = 0, end = 0; e < edges.size(); e = end) {
    while (end < edges.size() && edges[end].first == edges[e].first) ++end;
    if (end == e + 1) ++report.open_edges;
    if (end > e + 2) ++report.crowded_edges;
    if (end == e + 2 && edges[e].second == edges[e + 1].second) ++report.inconsistent_edges;
  }
}

TriangleSurface sound_surface(const RawMesh& raw, const MeshReport& found, SurfaceReport& report) {
  if (raw.triangles.empty()) refuse(raw.file, {}, "the file holds no triangle");
  if (const auto quads = found.other_elements.find("quadrangle"); quads != found.other_elements.end())
    refuse(raw.file, {}, "the file holds " + std::to_string(quads->second) + " quadrangles; supported are triangles");
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

}  // namespace plica
