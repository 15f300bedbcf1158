// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdlib>
#include <map>
#include <plica/meshes/cell_contents.hpp>
#include <plica/meshes/embedding.hpp>
#include <plica/meshes/generators.hpp>
#include <utility>

namespace plica {

namespace {

constexpr double counted_part = 0.02;  // of a cell

double common(const InsideLines::Interval& a, const InsideLines::Interval& b) {
  return std::max(0.0, std::min(a.to, b.to) - std::max(a.from, b.from));
}

// Where a line along z is in a tetrahedron: where none of its barycentric weights, linear in z, is below zero
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
    : low_(low), size_(size), inside_(surface, low, size / lines, {lines * cells[0], lines * cells[1]}) {
  const TetMesh cell = box_mesh({Point::Zero(), Point::Ones()}, {1, 1, 1});
  for (std::size_t l = 0; l < lines_.size(); ++l) {
    Line& line = lines_[l];
    const auto i = static_cast<int>(l) % lines, j = static_cast<int>(l) / lines;
    double sum = 0;
    for (std::size_t t = 0; t < 6; ++t) {
      line.tets[t] = along((i + 0.5) / lines, (j + 0.5) / lines, corners_of(cell, static_cast<int>(t)));
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
      const Interval here{std::max(0.0, (from - bottom) / size_), std::min(1.0, (to - bottom) / size_)};
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

// Pieces of neighbouring lines hang together where they have a height in common
int CellContents::parts_of(std::vector<Piece> pieces) {
  const auto part_of = [&](std::size_t p) {
    while (pieces[p].part != p) p = pieces[p].part = pieces[pieces[p].part].part;
    return p;
  };
  for (std::size_t p = 0; p < pieces.size(); ++p)
    for (std::size_t q = p + 1; q < pieces.size(); ++q) {
      const bool beside = std::abs(pieces[p].i - pieces[q].i) + std::abs(pieces[p].j - pieces[q].j) == 1;
      if (beside && common(pieces[p].along, pieces[q].along) > 0) pieces[part_of(p)].part = part_of(q);
    }
  std::map<std::size_t, double> volume;  // of a part, in cells
  for (std::size_t p = 0; p < pieces.size(); ++p)
    volume[part_of(p)] += (pieces[p].along.to - pieces[p].along.from) / (lines * lines);
  int parts = 0;
  for (const auto& [part, of_it] : volume) parts += of_it > counted_part;
  return parts;
}

}  // namespace plica
