// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>

namespace plica {

/// A ball: a cube of cells whose shells become spheres. The diagonals of the cells point away from the centre, so that
/// no tetrahedron has two faces on the sphere, where it would be flat.
///
/// @param centre  finite [m]
/// @param radius  above zero [m]
/// @param cells   across the diameter, 1 or more
/// @return        (cells + 1)^3 vertices, 6 cells^3 tetrahedra; InputError for anything else
TetMesh ball_mesh(const Point& centre, double radius, int cells);

}  // namespace plica
