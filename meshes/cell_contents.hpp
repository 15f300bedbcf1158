// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <plica/core/mesh.hpp>
#include <span>
#include <vector>

namespace plica {

/// Where lines along z are inside a closed surface, exactly but for rounding. A point is inside
/// where the surface winds about it: parts that overlap are one body, and a surface inside another
/// that looks inwards encloses a hole. Of two triangles that meet at an edge one has the edge's
/// points, so that no line slips through between them.
class InsideLines {
 public:
  /// Of a line, along z [m].
  struct Interval {
    double from, to;
  };

  /// The lines are at low + ((i + 1/2) spacing, (j + 1/2) spacing).
  /// @param surface  closed, counter-clockwise seen from outside
  /// @param counts   of lines along x and y
  InsideLines(const TriangleSurface& surface, const Point& low, double spacing,
              const std::array<int, 2>& counts);

  /// The inside of a line, upwards.
  std::span<const Interval> at(int i, int j) const {
    const auto line = static_cast<std::size_t>(j) * static_cast<std::size_t>(counts_[0]) +
                      static_cast<std::size_t>(i);
    return std::span(intervals_).subspan(first_[line], first_[line + 1] - first_[line]);
  }

 private:
  std::array<int, 2> counts_;
  std::vector<std::size_t> first_{0};
  std::vector<Interval> intervals_;
};

/// What of a lattice's cells a body fills. Each cell is cut into six tetrahedra as box_mesh() has
/// them, and looked at along 8 x 8 lines.
class CellContents {
 public:
  static constexpr int lines = 8;  ///< along a cell's edge

  struct Contents {
    std::array<double, 6> filled = {};  ///< the body's part of each tetrahedron
    /// of the body, not connected in the cell; those of less than a fiftieth of it do not count
    int parts = 0;
  };

  /// @param low   the lattice's lowest corner [m]
  /// @param size  of its cells [m]
  CellContents(const TriangleSurface& surface, const Point& low, double size,
               const std::array<int, 3>& cells);

  Contents of(int i, int j, int k) const;

 private:
  using Interval = InsideLines::Interval;
  struct Piece {
    int i, j;  // its line in the cell
    Interval along;
    std::size_t part;  // the number of a piece that it hangs together with, at last the part's own
  };
  static int parts_of(std::vector<Piece> pieces);

  Point low_;
  double size_;
  InsideLines inside_;
  struct Line {
    std::array<Interval, 6> tets;  // along it, of 1
    double weight;                 // a line in a face is in two tetrahedra
  };
  std::array<Line, static_cast<std::size_t>(lines* lines)> lines_;  // of a cell
  std::array<double, 6> whole_ = {};                                // sums over them
};

}  // namespace plica
