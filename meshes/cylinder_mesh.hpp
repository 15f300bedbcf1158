// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>

namespace plica {

/// A cylinder that stands on `base` and rises along z: layers of a square of cells whose rings become circles.
///
/// @param base    centre of the lower disc, finite [m]
/// @param radius  above zero [m]
/// @param length  above zero [m]
/// @param across  cells across the diameter, 1 or more
/// @param along   cells along the axis, 1 or more
/// @return        (across + 1)^2 (along + 1) vertices, 6 across^2 along tetrahedra; InputError for anything else
TetMesh cylinder_mesh(const Point& base, double radius, double length, int across, int along);

}  // namespace plica
