// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <plica/core/mesh.hpp>
#include <plica/meshes/mesh_report.hpp>

namespace plica {

/// Reads the tetrahedra of a Gmsh MSH 2.2 ASCII file (Gmsh reference manual, "MSH file format version 2").
///
/// Physical groups of volumes become regions, in the order of their tags; a nameless one is "physical_TAG", and so is
/// what belongs to none (TAG 0), unless nothing belongs to any: then there is one nameless region. Physical groups of
/// surfaces, curves and points become vertex sets; two with the same name are one set. Coordinates are taken as metres.
///
/// Strict: anything malformed, cut short, of another version or of elements we cannot take is an InputError with file,
/// line, the value and what was expected. Sections Gmsh adds for other uses ($Periodic, $NodeData, ...) are skipped.
TetMesh read_msh(const std::filesystem::path& path, MeshReport* report = nullptr);

}  // namespace plica
