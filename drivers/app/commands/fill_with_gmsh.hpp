// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>

namespace plica::app {

/// Returns true if the external program Gmsh is on PATH.
bool has_gmsh();

/// Returns a mesh, made by Gmsh, of the inside of a closed surface. The mesh fits the surface; its
/// edges are about `size` [m] long. Gmsh runs as a separate process in a temporary folder, for at
/// most `time_limit` [s]. Throws InputError with Gmsh's messages if it makes no mesh, or a mesh
/// whose volume is not that of the surface.
TetMesh fill_with_gmsh(const TriangleSurface& surface, double size, double time_limit);

}  // namespace plica::app
