// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <functional>
#include <plica/core/mesh.hpp>

namespace plica {

/// A grid of cells, each cut into the six tetrahedra around one of its diagonals (Kuhn's triangulation), carried to
/// space by `map`, which takes the unit cube to the body and must keep its orientation.
///
/// Vertices are numbered x fastest, then y, then z. Along an axis that is not mirrored every diagonal points up; along
/// a mirrored one it points away from the middle. Neighbours agree on the cut of their common face in either case: it
/// depends on the two axes of the face only, and along those both cells have the same index.
///
/// @param cells     per axis, 1 or more; InputError otherwise, or when a count does not fit an int
/// @param mirrored  per axis
/// @return          (cells + 1) vertices along each axis, six tetrahedra per cell
TetMesh grid_mesh(const std::array<int, 3>& cells, const std::array<bool, 3>& mirrored,
                  const std::function<Point(const Point&)>& map);

}  // namespace plica
