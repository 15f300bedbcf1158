// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>

namespace plica {

/// The same body on a mesh twice as fine: every tetrahedron is cut into eight (J. Bey, Tetrahedral
/// grid refinement, Computing 55, 1995). Four keep a corner each and its shape; the octahedron
/// between them is cut around its shortest diagonal, of equally short ones around that most
/// parallel to the tetrahedron's longest edge. A box_mesh() so becomes the one with twice the
/// cells.
///
/// Vertices keep their numbers; the middles of the edges come after them, in the order in which the
/// tetrahedra use them. The eight follow each other in the place of the one, with its region. The
/// middle of an edge is in the vertex sets that both ends are in; where all of a set lies on the
/// boundary, only if the edge does too. Curved faces stay as flat as they are.
///
/// @return  8 times the tetrahedra, 1/8 of their volume each; InputError where a count does not fit
/// an int
TetMesh refined(const TetMesh& mesh);

/// Whether `fine` has eight times the tetrahedra of `coarse`, a vertex at each of its vertices, to
/// 1e-6 of an edge, and its volume, to 1e-9 of it.
bool is_refinement_of(const TetMesh& fine, const TetMesh& coarse);

}  // namespace plica
