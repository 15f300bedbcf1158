// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <numeric>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/mesh_quality.hpp>
#include <plica/meshes/weld_open_edges.hpp>

namespace plica {

namespace {

using Edge = std::array<int, 2>;  // vertices, ascending

// Returns the vertices on edges of one triangle only, ascending
std::vector<int> open_vertices(const TriangleSurface& surface) {
  std::vector<Edge> edges;
  for (const auto& t : surface.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      edges.push_back({std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])});
  std::sort(edges.begin(), edges.end());
  std::vector<int> vertices;
  for (std::size_t e = 0, end = 0; e < edges.size(); e = end) {
    while (end < edges.size() && edges[end] == edges[e]) ++end;
    if (end == e + 1) vertices.insert(vertices.end(), edges[e].begin(), edges[e].end());
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

int faulty_edges(const TriangleSurface& surface) {
  SurfaceReport report;
  count_edges(surface, report);
  return report.open_edges + report.crowded_edges + report.inconsistent_edges;
}

}  // namespace

int weld_open_edges(TriangleSurface& surface, double distance) {
  const std::vector<int> open = open_vertices(surface);
  std::vector<Point> points;
  for (const int v : open) points.push_back(surface.vertices[static_cast<std::size_t>(v)]);
  std::vector<int> stands_for(surface.vertices.size());
  std::iota(stands_for.begin(), stands_for.end(), 0);
  const std::vector<int> twins = lower_twins(points, distance);
  int welded = 0;
  for (std::size_t k = 0; k < open.size(); ++k)
    if (twins[k] >= 0) {
      const int twin = open[static_cast<std::size_t>(twins[k])];
      stands_for[static_cast<std::size_t>(open[k])] = stands_for[static_cast<std::size_t>(twin)];
      ++welded;
    }
  if (welded == 0) return 0;

  std::vector<int> number(surface.vertices.size());
  TriangleSurface result;
  for (std::size_t v = 0; v < number.size(); ++v) {
    const auto one = static_cast<std::size_t>(stands_for[v]);
    number[v] = one == v ? static_cast<int>(result.vertices.size()) : number[one];
    if (one == v) result.vertices.push_back(surface.vertices[v]);
  }
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    auto triangle = surface.triangles[t];
    for (int& v : triangle) v = number[static_cast<std::size_t>(v)];
    if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0])
      continue;
    result.triangles.push_back(triangle);
    if (!surface.texture.empty()) result.texture.push_back(surface.texture[t]);
  }
  if (result.triangles.empty() || faulty_edges(result) >= faulty_edges(surface)) return 0;
  surface = std::move(result);
  return welded;
}

}  // namespace plica
