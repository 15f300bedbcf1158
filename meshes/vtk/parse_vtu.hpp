// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/meshes/mesh_report.hpp>
#include <plica/meshes/raw_mesh.hpp>

namespace plica {

/// Takes the cells of an unstructured grid of VTK's XML format ("VTK XML file formats" in its documentation) in one piece:
/// arrays as text, in base64, or appended, raw or in base64; in either order of bytes; not compressed.
///
/// Regions and numbers are as for parse_vtk(). Strict, as parse_msh().
RawMesh parse_vtu(const MemoryFile& file, MeshReport& report);

}  // namespace plica
