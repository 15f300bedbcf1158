// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/meshes/mesh_report.hpp>
#include <plica/meshes/raw_mesh.hpp>

namespace plica {

/// Takes points, lines, triangles, quadrangles and tetrahedra of a Gmsh MSH 2.2 or 4.1 file, text or binary in either
/// order of bytes (Gmsh reference manual, "MSH file format").
///
/// Physical groups of volumes become regions, in the order of their tags; a nameless one is "physical_TAG", and so is
/// what belongs to none (TAG 0), unless nothing belongs to any: then there is one nameless region. Physical groups of
/// surfaces, curves and points become vertex sets; two with the same name are one set. Coordinates are taken as metres.
/// Parametric coordinates (4.1) are left out; partitions count for nothing.
///
/// Strict: anything malformed, cut short, of another version or of elements we cannot take is an InputError with file,
/// line or byte, the value and what was expected. Sections Gmsh adds for other uses ($Periodic, $NodeData, ...) are
/// skipped.
RawMesh parse_msh(const MemoryFile& file, MeshReport& report);

}  // namespace plica
