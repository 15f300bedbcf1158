// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>

namespace plica {

/// Carries the cube [-1, 1]^3 to the unit ball, the square z = 0 to the unit disc, shell by shell.
///
/// On a shell the angle is proportional to the coordinate (an "equiangular cubed sphere"), which spreads the vertices
/// evenly; towards the centre the shells become cubes again, where the grid is best left alone.
Point rounded(const Point& p);

}  // namespace plica
