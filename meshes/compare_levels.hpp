// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>
#include <string>
#include <vector>

namespace plica {

/// A mesh as a whole.
struct MeshSize {
  Box box;  ///< around its vertices [m]
  /// cells that the body fills in part: larger than it, not to be compared
  bool around = false;
  double volume = 0;               ///< [m^3]
  double mass = 0;                 ///< [kg]
  Point centroid = Point::Zero();  ///< of the volume [m]
};

/// @param mesh     every tetrahedron with positive volume
/// @param density  per region, or one for a mesh without regions [kg/m^3]
MeshSize mesh_size(const TetMesh& mesh, const std::vector<double>& density);

/// How far a coarse level is from the same body as the finest one.
enum class SameBody {
  /// every length within 5 %, volume and mass within 25 %, the centroid within 3 % of the extent
  yes,
  doubtful,  ///< further apart, as coarse meshes of round bodies may be
  /// a length differs by a factor above 2, volume or mass by more than 4, or the centroid by a
  /// quarter of the extent
  no
};

/// The judgement, and a sentence with the numbers and the likely cause where it is not `yes`.
struct LevelComparison {
  SameBody same = SameBody::yes;  ///< the judgement
  std::string sentence;           ///< "level 1 is not the size of level 0: it measures ..."
};

/// Compares a coarse level with the finest: extent along each axis, volume, mass and centroid. A
/// mesh that was read with the wrong scale, or lies elsewhere, still has an embedding in the finest
/// level, and the cycle would only be wrong.
LevelComparison compare_levels(const MeshSize& finest, const MeshSize& coarse, std::size_t level);

}  // namespace plica
