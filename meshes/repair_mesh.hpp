// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>
#include <vector>

namespace plica {

/// The longest edge of a tetrahedron over its smallest height, 1.22 at best; infinite without
/// volume.
double height_ratio(const TetMesh& mesh, const std::array<int, 4>& tet);

/// What improve_shapes() did.
struct Improvement {
  int moved = 0;      ///< vertices
  int collapsed = 0;  ///< edges
  /// per vertex the one that it became: itself unless its edge was collapsed
  std::vector<int> vertex;
};

/// Shapes slivers better, as repair_mesh() says. Vertices keep their numbers; those that are gone
/// have no tetrahedron left.
/// @param numbers  a number per tetrahedron, which keeps to it
Improvement improve_shapes(TetMesh& mesh, std::vector<int>& numbers);

/// Drops slivers that lie on the boundary with two of their faces and have a height ratio (see
/// TetShape) above 20, again and again: the surface turns the edge between these faces, and moves
/// by the sliver's height at most, a twentieth of its longest edge. One whose other two faces would
/// meet at an edge of the boundary stays.
/// @param numbers  a number per tetrahedron, which keeps to it
/// @return how many
int peel_slivers(TetMesh& mesh, std::vector<int>& numbers);

/// What repair_mesh() changed, and what came out.
struct MeshRepair {
  TetMesh mesh;                      ///< sound
  std::vector<int> vertex;           ///< per vertex before its number now; -1: dropped
  std::vector<int> original_vertex;  ///< per vertex its number before
  std::vector<int> original_tet;     ///< likewise of tetrahedra
  int merged = 0;                    ///< vertices that became one with another at their place
  int parts = 0;                     ///< loose parts, dropped
  int loose_tets = 0;                ///< tetrahedra of these
  int peeled = 0;                    ///< slivers on the boundary, dropped
  int moved = 0;                     ///< vertices, to shape the elements around them better
  int collapsed = 0;                 ///< edges
  int flat = 0;                      ///< tetrahedra without volume that nothing helped, dropped
  /// the largest height ratio (see TetShape); infinite without volume
  double worst_before = 0;
  double worst_after = 0;  ///< likewise

  /// Whether anything is other than before.
  bool changed() const { return merged + parts + peeled + moved + collapsed + flat > 0; }
};

/// Makes a mesh fit to be simulated. Vertices within 1e-6 of the mean edge of another one become
/// one with it; parts that share no vertex with the rest and hold less than a hundredth of the
/// volume are dropped. Slivers on the boundary are peeled off (see peel_slivers()). Then the
/// others, elements with a height ratio above 8, are shaped better: a vertex goes towards the mean
/// of its neighbours, or away from the face across the sliver, or, where that does not help, into a
/// neighbour. A step is taken only if the worst element around it becomes better: the worst of the
/// mesh never becomes worse. Vertices of the boundary, of faces between regions and of vertex sets
/// stay where they are.
///
/// @param mesh  of positive volumes, or of none where it was read with Flaws::kept
/// @throw InputError when nothing is left
MeshRepair repair_mesh(const TetMesh& mesh);

}  // namespace plica
