// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <plica/core/mesh.hpp>
#include <plica/meshes/memory_file.hpp>
#include <plica/meshes/surface_report.hpp>

namespace plica {

/// Reads the triangles of a surface in the format its extension names (see list.hpp), in any case of letters.
/// @param path    of the file
/// @param report  takes what was mended and left out, and whether the surface is closed, when given
/// @throw InputError for an unknown extension, whatever the parser of the format refuses, and what sound_surface() does
TriangleSurface read_surface(const std::filesystem::path& path, SurfaceReport* report = nullptr);

/// The same of a file in memory.
TriangleSurface read_surface(const MemoryFile& file, SurfaceReport* report = nullptr);

}  // namespace plica
