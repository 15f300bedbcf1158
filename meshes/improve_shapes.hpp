// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>
#include <vector>

namespace plica {

/// The longest edge of a tetrahedron over its smallest height, 1.22 at best; infinite without volume.
double height_ratio(const TetMesh& mesh, const std::array<int, 4>& tet);

/// What improve_shapes() did.
struct Improvement {
  int moved = 0;            ///< vertices
  int collapsed = 0;        ///< edges
  std::vector<int> vertex;  ///< per vertex the one that it became: itself unless its edge was collapsed
};

/// Shapes slivers better, as repair_mesh() says. Vertices keep their numbers; those that are gone have no tetrahedron left.
/// @param numbers  a number per tetrahedron, which keeps to it
Improvement improve_shapes(TetMesh& mesh, std::vector<int>& numbers);

}  // namespace plica
