// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <plica/core/mesh.hpp>
#include <plica/meshes/memory_file.hpp>
#include <plica/meshes/mesh_report.hpp>

namespace plica {

/// Reads a tetrahedral mesh in the format its extension names (see list.hpp), in any case of letters.
/// @param path    of the file
/// @param report  takes what was mended and left out, when given
/// @throw InputError for an unknown extension, whatever the parser of the format refuses, and what sound_mesh() does
TetMesh read_mesh(const std::filesystem::path& path, MeshReport* report = nullptr);

/// The same of a file in memory.
TetMesh read_mesh(const MemoryFile& file, MeshReport* report = nullptr);

}  // namespace plica
