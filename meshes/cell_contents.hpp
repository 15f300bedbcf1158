// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <plica/core/mesh.hpp>
#include <plica/meshes/inside_lines.hpp>
#include <vector>

namespace plica {

/// What of a lattice's cells a body fills. Each cell is cut into six tetrahedra as box_mesh() has them, and looked at along 8 x 8 lines.
class CellContents {
 public:
  static constexpr int lines = 8;  ///< along a cell's edge

  struct Contents {
    std::array<double, 6> filled = {};  ///< the body's part of each tetrahedron
    int parts = 0;  ///< of the body, not connected in the cell; those of less than a fiftieth of it do not count
  };

  /// @param low   the lattice's lowest corner [m]
  /// @param size  of its cells [m]
  CellContents(const TriangleSurface& surface, const Point& low, double size, const std::array<int, 3>& cells);

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
