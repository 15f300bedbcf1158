// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <plica/core/mesh.hpp>
#include <span>
#include <vector>

namespace plica {

/// Where lines along z are inside a closed surface, exactly but for rounding. A point is inside where the surface winds about it: parts that
/// overlap are one body, and a surface inside another that looks inwards encloses a hole. Of two triangles that meet at an edge
/// one has the edge's points, so that no line slips through between them.
class InsideLines {
 public:
  /// Of a line, along z [m].
  struct Interval {
    double from, to;
  };

  /// The lines are at low + ((i + 1/2) spacing, (j + 1/2) spacing).
  /// @param surface  closed, counter-clockwise seen from outside
  /// @param counts   of lines along x and y
  InsideLines(const TriangleSurface& surface, const Point& low, double spacing, const std::array<int, 2>& counts);

  /// The inside of a line, upwards.
  std::span<const Interval> at(int i, int j) const {
    const auto line = static_cast<std::size_t>(j) * static_cast<std::size_t>(counts_[0]) + static_cast<std::size_t>(i);
    return std::span(intervals_).subspan(first_[line], first_[line + 1] - first_[line]);
  }

 private:
  std::array<int, 2> counts_;
  std::vector<std::size_t> first_{0};
  std::vector<Interval> intervals_;
};

}  // namespace plica
