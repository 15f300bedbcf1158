// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>

namespace plica {

/// The same body on an irregular mesh: every vertex is moved at random, along each axis by up to
/// `amount` of the shortest edge that meets there. Vertices of the boundary, and of faces between
/// regions, move within all the planes of their faces: flat faces, straight edges and corners stay.
/// Where a tetrahedron would lose more than nine tenths of its volume, its vertices go half as far,
/// and so on.
///
/// @param mesh    the body
/// @param amount  in [0, 0.5); InputError otherwise
/// @param seed    the same moves for the same seed on every machine
/// @return        the same tetrahedra, regions and sets
TetMesh jittered(TetMesh mesh, double amount, unsigned seed = 1);

}  // namespace plica
