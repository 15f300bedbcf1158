// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/meshes/surface_report.hpp>
#include <utility>

namespace plica {

void count_edges(const TriangleSurface& surface, SurfaceReport& report) {
  std::vector<std::pair<std::array<int, 2>, bool>> edges;  // ascending; whether the triangle runs so
  edges.reserve(surface.triangles.size() * 3);
  for (const std::array<int, 3>& t : surface.triangles)
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

}  // namespace plica
