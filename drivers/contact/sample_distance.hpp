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
  double margin = 0;  ///< distance from the surface to the boundary of the grid, at least [m]
  std::array<int, 3> nodes = {};
  std::vector<double> value;
};

/// Returns the signed distances to a closed surface, or to a sheet of `thickness` [m] above 0.
/// `cells`: number along the longest extent; 0: 64, and more where the shape is thin.
/// Throws InputError where the grid would be too large, or too coarse to have a node inside.
DistanceGrid sample_distance(const TriangleSurface& surface, int cells, double thickness = 0);
/// Returns the edge of the cells of the grid that sample_distance() makes [m].
double distance_cell(const TriangleSurface& surface, int cells, double thickness = 0);

}  // namespace plica
