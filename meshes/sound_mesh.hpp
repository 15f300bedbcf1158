// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>
#include <plica/meshes/mesh_report.hpp>
#include <plica/meshes/raw_mesh.hpp>

namespace plica {

/// The one way from a file to a mesh. Turns tetrahedra that are inside out, drops vertices of no tetrahedron (also from
/// the sets), and writes both and the original numbers into `report`.
///
/// InputError with the place and the numbers in the file: no tetrahedron; a coordinate that is not finite; a vertex
/// defined twice, or not at all; a tetrahedron that names a vertex twice, repeats another, or has no volume (six times
/// the volume is at most 1e-9 of the longest edge cubed).
TetMesh sound_mesh(const RawMesh& raw, MeshReport& report);

}  // namespace plica
