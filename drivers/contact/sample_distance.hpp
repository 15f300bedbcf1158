// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <plica/core/mesh.hpp>
#include <vector>

namespace plica {

/// Signed distances [m] at the nodes of a grid of cubes around a surface, x fastest.
struct DistanceGrid {
  Point origin = Point::Zero();
  double cell = 0;    ///< [m]
  double margin = 0;  ///< the surface stays that far from the grid's outside [m]
  std::array<int, 3> nodes = {};
  std::vector<double> value;
};

/// Of a closed surface, or of a sheet of a thickness [m]; with `cells` along its longest extent, 0:
/// 64, and more where it is thin. InputError where the grid would be too large, or too coarse to
/// have a node inside.
DistanceGrid sample_distance(const TriangleSurface& surface, int cells, double thickness = 0);
/// The edge of that grid's cells [m].
double distance_cell(const TriangleSurface& surface, int cells, double thickness = 0);

}  // namespace plica
