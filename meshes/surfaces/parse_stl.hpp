// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/meshes/mesh_report.hpp>
#include <plica/meshes/raw_mesh.hpp>

namespace plica {

/// Takes the triangles of an STL file, text or binary (it is binary when its size fits the
/// number of triangles: the title of a binary file may begin like text). Corners at exactly the same place are one vertex. Normals are left out:
/// the order of the corners says the same. Several solids are one surface. Coordinates are taken as metres.
///
/// Strict, as parse_msh().
RawMesh parse_stl(const MemoryFile& file, MeshReport& report);

}  // namespace plica
