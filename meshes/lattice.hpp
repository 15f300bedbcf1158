// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>

namespace plica {

/// InputError for cells of a `size` [m] that is larger than a body with these points.
void check_cell_size(const std::vector<Point>& points, double size);

/// A lattice of cubes with edges of `size` [m] over a closed surface, around its bounding box's
/// centre: every cube that the body or its surface reaches into, cut into six tetrahedra. Where
/// several unconnected parts of the body lie in one cube, they become connected.
/// @param surface  closed, counter-clockwise seen from outside
/// @throw InputError for a size that is not above zero, larger than the body, or so small that the
/// bounding box holds more than 8
///        million cubes
TetMesh lattice_mesh(const TriangleSurface& surface, double size);

/// A lattice whose tetrahedra are filled by the part of them that is body (TetMesh::filled), so
/// that all of it has the body's mass and stiffness where the body is. An element's frequency does
/// not depend on its part, and neither does the critical step.
struct WeightedLattice {
  TetMesh mesh;  ///< no part is below 0.02, and cells with less than that are left out
  /// that hold several unconnected parts of the body: there they are connected
  int shared_cells = 0;
};
/// The arguments are those of lattice_mesh().
WeightedLattice weighted_lattice(const TriangleSurface& surface, double size);

/// The lattice over a mesh that comes nearest to a number of vertices, not above it. A cube is of
/// the region that its centre is in or nearest to; vertex sets are left out.
/// @param vertices  30 to as many as the mesh has; InputError for any other number
TetMesh coarse_lattice(const TetMesh& mesh, int vertices);

}  // namespace plica
