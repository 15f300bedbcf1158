// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>

namespace plica::app {

/// Whether the outside program Gmsh is installed: it is on PATH.
bool has_gmsh();

/// A mesh of a closed surface's inside that fits it, with edges of about `size` [m]. Gmsh runs as a
/// process of its own, in a folder for temporary files, at most for `time_limit` [s]. InputError
/// with Gmsh's own words where it makes none, or one of another volume.
TetMesh fill_with_gmsh(const TriangleSurface& surface, double size, double time_limit);

}  // namespace plica::app
