// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <plica/meshes/cell_contents.hpp>
#include <plica/meshes/embedding.hpp>
#include <plica/meshes/generators.hpp>
#include <tuple>
#include <utility>

namespace plica {

namespace {

struct Crossing {
  std::size_t line;
  double z;
  int turns;  // change of the winding number, upwards; 1: into the body; -1: out of it
};

// Side of an edge on which a line is, seen from above. `area` is twice the area of the triangle of
// the edge and the line, positive to the edge's left. It is computed from the lower vertex to the
// higher one, so that both triangles at an edge get one value.
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

// Calls visit(i, j) for the lines that pass through a triangle's bounding box
template <class Visit>
void for_lines(const std::array<const Point*, 3>& t, const Point& low, double spacing,
               const std::array<int, 2>& counts, const Visit& visit) {
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
      const auto line = static_cast<std::size_t>(j) * static_cast<std::size_t>(counts[0]) +
                        static_cast<std::size_t>(i);
      crossings.push_back({line, height, left == 3 ? -1 : 1});
    });
  }
  std::ranges::sort(crossings, {},
                    [](const Crossing& c) { return std::tuple(c.line, c.z, -c.turns); });
  return crossings;
}

}  // namespace

InsideLines::InsideLines(const TriangleSurface& surface, const Point& low, double spacing,
                         const std::array<int, 2>& counts)
    : counts_(counts) {
  const std::vector<Crossing> crossings = crossings_of(surface, low, spacing, counts);
  auto next = crossings.begin();
  const std::size_t lines =
      static_cast<std::size_t>(counts[0]) * static_cast<std::size_t>(counts[1]);
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

namespace {

constexpr double counted_part = 0.02;  // relative to the volume of a cell

double common(const InsideLines::Interval& a, const InsideLines::Interval& b) {
  return std::max(0.0, std::min(a.to, b.to) - std::max(a.from, b.from));
}

// Returns the interval of a line along z that is in a tetrahedron of the unit cell. There none of
// the barycentric weights, which are linear in z, is below zero.
InsideLines::Interval along(double x, double y, const std::array<Point, 4>& corners) {
  InsideLines::Interval inside{0, 1};
  const Weights low = barycentric({x, y, 0}, corners), high = barycentric({x, y, 1}, corners);
  for (std::size_t c = 0; c < 4; ++c) {
    const double slope = high[c] - low[c];
    if (slope > 0) inside.from = std::max(inside.from, -low[c] / slope);
    if (slope < 0) inside.to = std::min(inside.to, -low[c] / slope);
    if (slope == 0 && low[c] < 0) return {0, 0};
  }
  return inside;
}

}  // namespace

CellContents::CellContents(const TriangleSurface& surface, const Point& low, double size,
                           const std::array<int, 3>& cells)
    : low_(low),
      size_(size),
      inside_(surface, low, size / lines, {lines * cells[0], lines * cells[1]}) {
  const TetMesh cell = box_mesh({Point::Zero(), Point::Ones()}, {1, 1, 1});
  for (std::size_t l = 0; l < lines_.size(); ++l) {
    Line& line = lines_[l];
    const auto i = static_cast<int>(l) % lines, j = static_cast<int>(l) / lines;
    double sum = 0;
    for (std::size_t t = 0; t < 6; ++t) {
      line.tets[t] =
          along((i + 0.5) / lines, (j + 0.5) / lines, corners_of(cell, static_cast<int>(t)));
      sum += common(line.tets[t], {0, 1});
    }
    line.weight = 1 / sum;
    for (std::size_t t = 0; t < 6; ++t) whole_[t] += line.weight * common(line.tets[t], {0, 1});
  }
}

CellContents::Contents CellContents::of(int i, int j, int k) const {
  Contents contents;
  std::vector<Piece> pieces;
  const double bottom = low_[2] + k * size_;
  for (std::size_t l = 0; l < lines_.size(); ++l) {
    const int a = static_cast<int>(l) % lines, b = static_cast<int>(l) / lines;
    for (const auto& [from, to] : inside_.at(lines * i + a, lines * j + b)) {
      const Interval here{std::max(0.0, (from - bottom) / size_),
                          std::min(1.0, (to - bottom) / size_)};
      if (!(here.to > here.from)) continue;
      pieces.push_back({a, b, here, pieces.size()});
      for (std::size_t t = 0; t < 6; ++t)
        contents.filled[t] += lines_[l].weight * common(lines_[l].tets[t], here) / whole_[t];
    }
  }
  for (double& part : contents.filled) part = std::min(part, 1.0);
  contents.parts = parts_of(std::move(pieces));
  return contents;
}

// Returns the number of connected parts. Pieces of neighbouring lines are connected where their
// intervals overlap.
int CellContents::parts_of(std::vector<Piece> pieces) {
  const auto part_of = [&](std::size_t p) {
    while (pieces[p].part != p) p = pieces[p].part = pieces[pieces[p].part].part;
    return p;
  };
  for (std::size_t p = 0; p < pieces.size(); ++p)
    for (std::size_t q = p + 1; q < pieces.size(); ++q) {
      const bool beside =
          std::abs(pieces[p].i - pieces[q].i) + std::abs(pieces[p].j - pieces[q].j) == 1;
      if (beside && common(pieces[p].along, pieces[q].along) > 0)
        pieces[part_of(p)].part = part_of(q);
    }
  std::map<std::size_t, double> volume;  // volume of each part over that of a cell
  for (std::size_t p = 0; p < pieces.size(); ++p)
    volume[part_of(p)] += (pieces[p].along.to - pieces[p].along.from) / (lines * lines);
  int parts = 0;
  for (const auto& [part, of_it] : volume) parts += of_it > counted_part;
  return parts;
}

}  // namespace plica
