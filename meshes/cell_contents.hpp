// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <plica/core/mesh.hpp>
#include <span>
#include <vector>

namespace plica {

/// Intervals of lines along z that are inside a closed surface, exact to rounding. A point is
/// inside if the winding number of the surface around it is above zero. Parts that overlap are
/// therefore one body, and an inner surface that looks inwards encloses a hole. The points of an
/// edge belong to one of the two triangles that meet there, so that no line passes between them.
class InsideLines {
 public:
  /// Interval of a line along z [m].
  struct Interval {
    double from, to;
  };

  /// Intersects the surface with lines at low + ((i + 1/2) spacing, (j + 1/2) spacing).
  /// @param surface  closed, counter-clockwise seen from outside
  /// @param counts   numbers of lines along x and y
  InsideLines(const TriangleSurface& surface, const Point& low, double spacing,
              const std::array<int, 2>& counts);

  /// Returns the intervals of line (i, j) that are inside, upwards.
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

/// Fractions of a lattice's cells that a body fills. Each cell is cut into the six tetrahedra of
/// box_mesh(), and sampled along 8 x 8 lines.
class CellContents {
 public:
  static constexpr int lines = 8;  ///< number of lines along a cell's edge

  /// Filling of one cell.
  struct Contents {
    std::array<double, 6> filled = {};  ///< fraction of each tetrahedron that is body [1]
    /// number of parts of the body that are not connected within the cell; a part counts if it
    /// fills more than a fiftieth of the cell
    int parts = 0;
  };

  /// Intersects the surface with the lines of all cells.
  /// @param low   lowest corner of the lattice [m]
  /// @param size  edge length of the cells [m]
  CellContents(const TriangleSurface& surface, const Point& low, double size,
               const std::array<int, 3>& cells);

  /// Returns the filling of cell (i, j, k).
  Contents of(int i, int j, int k) const;

 private:
  using Interval = InsideLines::Interval;
  struct Piece {
    int i, j;  // line of the cell
    Interval along;
    std::size_t part;  // number of a connected piece (union-find; the root names the part)
  };
  static int parts_of(std::vector<Piece> pieces);

  Point low_;
  double size_;
  InsideLines inside_;
  struct Line {
    std::array<Interval, 6> tets;  // interval in each tetrahedron, in the unit cell
    double weight;                 // below 1 for a line in a face: it is in two tetrahedra
  };
  std::array<Line, static_cast<std::size_t>(lines* lines)> lines_;  // lines of one cell
  std::array<double, 6> whole_ = {};  // weighted length of all lines in each tetrahedron
};

}  // namespace plica
