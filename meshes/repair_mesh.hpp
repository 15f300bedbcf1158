// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>
#include <vector>

namespace plica {

/// Returns the longest edge of a tetrahedron over its smallest height [1]. It is 1.22 at best, and
/// infinite without volume.
double height_ratio(const TetMesh& mesh, const std::array<int, 4>& tet);

/// Changes made by improve_shapes().
struct Improvement {
  int moved = 0;      ///< moved vertices
  int collapsed = 0;  ///< collapsed edges
  /// per vertex the one that it was merged into: itself unless its edge was collapsed
  std::vector<int> vertex;
};

/// Improves the shapes of slivers by the third step of repair_mesh(). Vertices keep their numbers;
/// a vertex whose edge was collapsed has no tetrahedron left.
/// @param mesh     mesh to change
/// @param numbers  one number per tetrahedron; numbers of dropped tetrahedra are dropped as well
Improvement improve_shapes(TetMesh& mesh, std::vector<int>& numbers);

/// Drops slivers that have two faces on the boundary and a height ratio (see TetShape) above 20.
/// There are at most 10 rounds. The surface gets the two other faces, and so the opposite edge. It
/// moves by the sliver's height at most, which is a twentieth of its longest edge. A sliver stays
/// if the edge between its other two faces is an edge of the boundary already.
/// @param mesh     mesh to change
/// @param numbers  one number per tetrahedron; numbers of dropped tetrahedra are dropped as well
/// @return the number of dropped tetrahedra
int peel_slivers(TetMesh& mesh, std::vector<int>& numbers);

/// Result of repair_mesh(): the mesh and the changes.
struct MeshRepair {
  TetMesh mesh;                      ///< repaired mesh
  std::vector<int> vertex;           ///< per original vertex its new number; -1: dropped
  std::vector<int> original_vertex;  ///< per new vertex its original number
  std::vector<int> original_tet;     ///< per new tetrahedron its original number
  int merged = 0;                    ///< vertices that were merged with another at their place
  int parts = 0;                     ///< loose parts, dropped
  int loose_tets = 0;                ///< tetrahedra of the loose parts, dropped
  int peeled = 0;                    ///< slivers on the boundary, dropped
  int moved = 0;                     ///< vertices moved to improve the elements around them
  int collapsed = 0;                 ///< collapsed edges
  int flat = 0;                      ///< tetrahedra that still have no volume at the end, dropped
  /// largest height ratio (see TetShape) of the original mesh; infinite without volume
  double worst_before = 0;
  double worst_after = 0;  ///< largest height ratio of the repaired mesh

  /// Returns whether the repair changed the mesh.
  bool changed() const { return merged + parts + peeled + moved + collapsed + flat > 0; }
};

/// Repairs a mesh so that it can be simulated, in three steps.
///
/// 1. Vertices within 1e-6 of the mean edge of another one are merged with it. Parts that share no
///    vertex with the rest and hold less than a hundredth of the volume are dropped.
/// 2. Slivers on the boundary are dropped, see peel_slivers().
/// 3. Elements with a height ratio above 8 are improved, see improve_shapes(). A vertex moves
///    towards the mean of its neighbours, or away from the face across the sliver. Where that does
///    not help, its edge to a neighbour is collapsed. A change is made only if the worst element
///    around it becomes better, so that the worst of the mesh never becomes worse. Vertices of the
///    boundary, of faces between regions and of vertex sets stay where they are.
///
/// @param mesh  tetrahedra of positive volume, or without volume as Flaws::kept reads them
/// @throw InputError when nothing is left
MeshRepair repair_mesh(const TetMesh& mesh);

}  // namespace plica
