// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <map>
#include <plica/meshes/close_slits.hpp>
#include <vector>

namespace plica {

namespace {

using Loop = std::vector<int>;  // points, in the direction of the edges of the triangles beside

/// Returns the loops of open edges. Where several open edges start at a point, none of them is
/// used.
std::vector<Loop> open_loops(const TriangleSurface& surface) {
  std::map<std::array<int, 2>, int> uses;
  for (const auto& t : surface.triangles)
    for (std::size_t c = 0; c < 3; ++c) ++uses[{t[c], t[(c + 1) % 3]}];
  std::map<int, int> next;
  std::vector<int> crowded;
  for (const auto& [edge, count] : uses)
    if (!uses.contains({edge[1], edge[0]}) && !next.emplace(edge[0], edge[1]).second)
      crowded.push_back(edge[0]);
  for (const int p : crowded) next.erase(p);
  std::vector<Loop> loops;
  while (!next.empty()) {
    Loop loop{next.begin()->first};
    for (auto at = next.begin(); at != next.end();) {
      const int to = at->second;
      next.erase(at);
      if (to == loop.front()) {
        loops.push_back(loop);
        break;
      }
      loop.push_back(to);
      at = next.find(to);
    }
  }
  return loops;
}

}  // namespace

int close_slits(TriangleSurface& surface, double width) {
  int closed = 0;
  for (const Loop& loop : open_loops(surface)) {
    const auto x = [&](std::size_t i) -> const Point& {
      return surface.vertices[static_cast<std::size_t>(loop[i % loop.size()])];
    };
    Point middle = Point::Zero();
    for (std::size_t i = 0; i < loop.size(); ++i) middle += x(i) / static_cast<double>(loop.size());
    double around = 0, area = 0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      around += (x(i + 1) - x(i)).norm();
      area += (x(i) - middle).cross(x(i + 1) - middle).norm() / 2;
    }
    if (!(area < width * around / 2)) continue;
    ++closed;
    if (loop.size() == 3) {
      surface.triangles.push_back({loop[0], loop[2], loop[1]});
      continue;
    }
    const int centre = static_cast<int>(surface.vertices.size());
    for (std::size_t i = 0; i < loop.size(); ++i)
      surface.triangles.push_back({loop[(i + 1) % loop.size()], loop[i], centre});
    surface.vertices.push_back(middle);
  }
  if (!surface.texture.empty()) surface.texture.resize(surface.triangles.size());
  return closed;
}

}  // namespace plica
