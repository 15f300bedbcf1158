// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <plica/meshes/inside_lines.hpp>
#include <tuple>
#include <utility>

namespace plica {

namespace {

struct Crossing {
  std::size_t line;
  double z;
  int turns;  // 1: into the body, upwards; -1: out of it
};

// Seen from above: twice the area of an edge and the line, positive to the edge's left. It is computed from the lower vertex to the
// higher one, so that both triangles at an edge get the same.
struct Side {
  double area;
  bool left;
};

Side side_of(const TriangleSurface& surface, int from, int to, double x, double y) {
  const Point &a = surface.vertices[static_cast<std::size_t>(std::min(from, to))],
              &b = surface.vertices[static_cast<std::size_t>(std::max(from, to))];
  const double area = (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
  return from < to ? Side{area, area >= 0} : Side{-area, area < 0};
}

// Calls visit(i, j) for the lines that a triangle is over or under, by its box
template <class Visit>
void for_lines(const std::array<const Point*, 3>& t, const Point& low, double spacing, const std::array<int, 2>& counts,
               const Visit& visit) {
  std::array<int, 2> first, last;
  for (int a = 0; a < 2; ++a) {
    const auto [from, to] = std::minmax({(*t[0])[a], (*t[1])[a], (*t[2])[a]});
    const double most = counts[static_cast<std::size_t>(a)];
    first[static_cast<std::size_t>(a)] =
        static_cast<int>(std::clamp(std::floor((from - low[a]) / spacing - 0.5), 0.0, most));
    last[static_cast<std::size_t>(a)] =
        static_cast<int>(std::clamp(std::ceil((to - low[a]) / spacing - 0.5), -1.0, most - 1));
  }
  for (int j = first[1]; j <= last[1]; ++j)
    for (int i = first[0]; i <= last[0]; ++i) visit(i, j);
}

std::vector<Crossing> crossings_of(const TriangleSurface& surface, const Point& low, double spacing,
                                   const std::array<int, 2>& counts) {
  std::vector<Crossing> crossings;
  for (const auto& t : surface.triangles) {
    std::array<const Point*, 3> at;
    for (std::size_t k = 0; k < 3; ++k) at[k] = &surface.vertices[static_cast<std::size_t>(t[k])];
    for_lines(at, low, spacing, counts, [&](int i, int j) {
      const double x = low[0] + (i + 0.5) * spacing, y = low[1] + (j + 0.5) * spacing;
      double sum = 0, z = 0;
      int left = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const Side side = side_of(surface, t[k], t[(k + 1) % 3], x, y);
        left += side.left, sum += side.area, z += side.area * (*at[(k + 2) % 3])[2];
      }
      if (left != 0 && left != 3) return;
      const double height = sum != 0 ? z / sum : (*at[0])[2];
      const auto line = static_cast<std::size_t>(j) * static_cast<std::size_t>(counts[0]) + static_cast<std::size_t>(i);
      crossings.push_back({line, height, left == 3 ? -1 : 1});
    });
  }
  std::ranges::sort(crossings, {}, [](const Crossing& c) { return std::tuple(c.line, c.z, -c.turns); });
  return crossings;
}

}  // namespace

InsideLines::InsideLines(const TriangleSurface& surface, const Point& low, double spacing,
                         const std::array<int, 2>& counts)
    : counts_(counts) {
  const std::vector<Crossing> crossings = crossings_of(surface, low, spacing, counts);
  auto next = crossings.begin();
  const std::size_t lines = static_cast<std::size_t>(counts[0]) * static_cast<std::size_t>(counts[1]);
  for (std::size_t line = 0; line < lines; ++line) {
    double from = 0;
    for (int turns = 0; next != crossings.end() && next->line == line; ++next) {
      const int before = std::exchange(turns, turns + next->turns);
      if (before <= 0 && turns > 0) from = next->z;
      if (before > 0 && turns <= 0 && next->z > from) intervals_.push_back({from, next->z});
    }
    first_.push_back(intervals_.size());
  }
}

}  // namespace plica
