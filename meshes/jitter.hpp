// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>

namespace plica {

/// Returns a body on an irregular mesh: every vertex is moved at random. Along each axis it moves
/// by up to `amount` of the shortest edge that meets there. Vertices of the boundary, and of faces
/// between regions, move only within the planes of all their faces. Flat faces, straight edges and
/// corners therefore stay. The moves of a tetrahedron's vertices are halved until it keeps a tenth
/// of its volume.
///
/// @param mesh    the body
/// @param amount  in [0, 0.5); InputError otherwise
/// @param seed    seed of the random numbers; equal seeds give equal moves on every machine
/// @return        the mesh with moved vertices; tetrahedra, regions and sets do not change
TetMesh jittered(TetMesh mesh, double amount, unsigned seed = 1);

}  // namespace plica
