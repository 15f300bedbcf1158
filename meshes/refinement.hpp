// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>

namespace plica {

/// Returns a mesh twice as fine: every tetrahedron is cut into eight (J. Bey, Tetrahedral grid
/// refinement, Computing 55, 1995). Four of them are at a corner each and have the shape of the
/// tetrahedron. The octahedron between them is cut around its shortest diagonal. Among equally
/// short ones this is the diagonal that is most parallel to the tetrahedron's longest edge. A
/// box_mesh() thus becomes the one with twice the cells.
///
/// Vertices keep their numbers. The middles of the edges come after them, in the order in which the
/// tetrahedra use them. The eight tetrahedra replace the one in the order of the mesh, and have its
/// region, its part that is body and its vectors. The middle of an edge is in the vertex sets that
/// both ends are in. If all of a set lies on the boundary, the edge must lie there too. The
/// boundary keeps its shape: middles are not moved onto a curved surface.
///
/// @return  8 times the tetrahedra, each with 1/8 of the volume; InputError where a count does not
/// fit an int, or for a mesh of several pieces
TetMesh refined(const TetMesh& mesh);

/// Returns whether `fine` is a mesh twice as fine of the body `coarse`. It must have eight times
/// the tetrahedra, the volume to a relative 1e-9, and a vertex within 1e-6 of an edge at each
/// vertex of `coarse`.
bool is_refinement_of(const TetMesh& fine, const TetMesh& coarse);

}  // namespace plica
