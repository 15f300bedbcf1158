// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <plica/core/mesh.hpp>
#include <vector>

namespace plica {

/// The faces that belong to one tetrahedron only, counter-clockwise seen from outside; mesh vertex numbers, in the
/// order of the tetrahedra.
std::vector<std::array<int, 3>> boundary_triangles(const TetMesh& mesh);

/// The boundary as a surface of its own.
struct BoundarySurface {
  TriangleSurface surface;       ///< its triangles, and their vertices only
  std::vector<int> mesh_vertex;  ///< per surface vertex its number in the mesh, ascending
};
/// Of a mesh.
BoundarySurface boundary_surface(const TetMesh& mesh);

/// The sum of the areas of the triangles. [m^2]
double surface_area(const TriangleSurface& surface);

/// The volume a closed surface encloses, above zero when its triangles look outwards. [m^3]
double enclosed_volume(const TriangleSurface& surface);

}  // namespace plica
