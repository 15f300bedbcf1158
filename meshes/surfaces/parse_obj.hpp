// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/meshes/mesh_report.hpp>
#include <plica/meshes/raw_mesh.hpp>

namespace plica {

/// Takes the vertices and faces of a Wavefront OBJ file, numbered from 1 or backwards from the last vertex with minus
/// signs. Faces with more than three corners are cut into triangles from their first corner, which must not turn any of
/// these over. Textures, normals, groups, materials, lines and points are left out; free-form geometry is refused.
/// Coordinates are taken as metres.
///
/// Strict, as parse_msh(). The format has no end mark: a file that is cut between two faces looks whole.
RawMesh parse_obj(const MemoryFile& file, MeshReport& report);

}  // namespace plica
