// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>
#include <vector>

namespace plica {

/// A mesh whose duplicate vertices were merged.
struct MergedMesh {
  TetMesh mesh;                      ///< glued together
  int merged = 0;                    ///< vertices that became one with another
  std::vector<int> original_vertex;  ///< per vertex of the mesh its number before
};

/// Glues a mesh together where vertices lie within `tolerance` [m], from zero, of another one: each becomes one with such
/// a vertex of a lower number, and so on along chains. Tetrahedra keep their order.
/// @throw InputError when a tetrahedron would lose its volume, or two would become the same: the tolerance is too large,
///        or two bodies lie in each other
MergedMesh merge_duplicates(const TetMesh& mesh, double tolerance);

}  // namespace plica
