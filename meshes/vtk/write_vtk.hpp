// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <plica/meshes/written_mesh.hpp>

namespace plica {

/// VTK's legacy format 3.0, text and binary, and its XML format with raw appended arrays. Regions are numbers in the cells' array
/// "region"; neither has vertex sets.
WrittenMesh write_vtk(const std::filesystem::path& path, const TetMesh& mesh);
WrittenMesh write_vtk_binary(const std::filesystem::path& path, const TetMesh& mesh);
WrittenMesh write_vtu(const std::filesystem::path& path, const TetMesh& mesh);

}  // namespace plica
