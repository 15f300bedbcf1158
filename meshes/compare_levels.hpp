// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>
#include <string>
#include <vector>

namespace plica {

/// Size, volume, mass and centroid of a mesh.
struct MeshSize {
  Box box;  ///< bounding box of the vertices [m]
  /// true where the body fills the cells in part: the box is larger than the body, and its lengths
  /// are not compared
  bool around = false;
  double volume = 0;               ///< [m^3]
  double edge = 0;                 ///< edge of a regular tetrahedron of the mean volume [m]
  double mass = 0;                 ///< [kg]
  Point centroid = Point::Zero();  ///< centre of the volume [m]
};

/// Measures a mesh; tetrahedra that are filled in part count by the filled part.
/// @param mesh     every tetrahedron with positive volume
/// @param density  per region, or one for a mesh without regions [kg/m^3]
MeshSize mesh_size(const TetMesh& mesh, const std::vector<double>& density);

/// Judgement whether a coarse level meshes the same body as the finest one.
enum class SameBody {
  /// every length within 5 %, volume and mass within 25 %, the centroid within 3 % of the extent
  yes,
  doubtful,  ///< between yes and no, as coarse meshes of round bodies may be
  /// a length differs by a factor above 2, volume or mass by one above 4, the centroid by more than
  /// a quarter of the extent, or one of the two covers a part alone: see covers_part()
  no
};

/// Result of a comparison of two levels.
struct LevelComparison {
  SameBody same = SameBody::yes;  ///< the judgement
  /// numbers, with the likely cause for `no`: "level 1 is not the body of level 0: ..."; empty for
  /// `yes`
  std::string sentence;
};

/// Returns whether a mesh covers a part of what another one covers: it lies in the other's box,
/// which reaches further by more than 1.5 edges, and has less than 1/1.1 of its volume; or by more
/// than half an edge, and has less than 1/1.25. Coarse meshes of round bodies lie in them by less.
bool covers_part(const MeshSize& part, const MeshSize& whole);

/// Compares a coarse level with the finest: extent along each axis, volume, mass and centroid. A
/// mesh that was read with the wrong scale, or lies elsewhere, can still be embedded in the finest
/// level: without this check the cycle would be wrong without a message.
LevelComparison compare_levels(const MeshSize& finest, const MeshSize& coarse, std::size_t level);

}  // namespace plica
