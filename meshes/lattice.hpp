// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>

namespace plica {

/// Throws an InputError if the `size` [m] of cells is larger than a body with these points.
void check_cell_size(const std::vector<Point>& points, double size);

/// Returns a lattice of cubes with edges of `size` [m] over the body inside a closed surface. The
/// lattice is centred at the surface's bounding box. It has every cube that the body or its surface
/// reaches into, cut into six tetrahedra. Unconnected parts of the body in one cube become
/// connected.
/// @param surface  closed, counter-clockwise seen from outside
/// @param size     length of the cubes' edges [m]
/// @throw InputError for a size that is not above zero, larger than the body, or so small that the
/// bounding box holds more than 8 million cubes
TetMesh lattice_mesh(const TriangleSurface& surface, double size);

/// Lattice whose tetrahedra count by the fraction of them that is body (TetMesh::filled). The
/// lattice thus has the body's mass and stiffness where the body is. The frequency of an element
/// does not depend on its fraction, and neither does the critical step.
struct WeightedLattice {
  /// lattice; no fraction is below 0.02, and cells that the body fills by 0.02 or less are left out
  TetMesh mesh;
  /// number of cells with several unconnected parts of the body, which the cell connects
  int shared_cells = 0;
};
/// Returns a lattice over a closed surface, with the fraction of each tetrahedron that is body.
/// Arguments and errors are those of lattice_mesh().
WeightedLattice weighted_lattice(const TriangleSurface& surface, double size);

/// Returns the lattice over a mesh with the most vertices that are not above a given number. A cube
/// gets the region that its centre is in or nearest to; vertex sets are left out. The cube size is
/// found by 16 steps of bisection.
/// @param mesh      mesh of the body
/// @param vertices  30 to as many as the mesh has; InputError for any other number
TetMesh coarse_lattice(const TetMesh& mesh, int vertices);

}  // namespace plica
