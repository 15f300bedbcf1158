// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <plica/core/mesh.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/files/memory_file.hpp>
#include <plica/meshes/files/raw_mesh.hpp>
#include <plica/meshes/files/sound_mesh.hpp>
#include <plica/meshes/files/writing.hpp>
#include <string>
#include <variant>

namespace plica {

/// Reads a tetrahedral mesh in the format its extension names (see list.hpp), in any case of
/// letters.
/// @param path    of the file
/// @param report  takes what was repaired and left out, when given
/// @param flaws   kept: a mesh for repair_mesh(), whose tetrahedra may have no volume
/// @throw InputError for an unknown extension, whatever the parser of the format refuses, and what
/// sound_mesh() does
TetMesh read_mesh(const std::filesystem::path& path, MeshReport* report = nullptr,
                  Flaws flaws = Flaws::refused);

/// The same of a file in memory.
TetMesh read_mesh(const MemoryFile& file, MeshReport* report = nullptr,
                  Flaws flaws = Flaws::refused);

/// Reads the triangles of a surface in the format its extension names (see list.hpp), in any case
/// of letters.
/// @param path    of the file
/// @param report  takes what was repaired and left out, and whether the surface is closed, when
/// given
/// @throw InputError for an unknown extension, whatever the parser of the format refuses, and what
/// sound_surface() does
TriangleSurface read_surface(const std::filesystem::path& path, SurfaceReport* report = nullptr);

/// The same of a file in memory.
TriangleSurface read_surface(const MemoryFile& file, SurfaceReport* report = nullptr);

/// A mesh from a file.
struct ReadMesh {
  TetMesh mesh;       ///< sound
  MeshReport report;  ///< what was done to it
};
/// A surface from a file.
struct ReadSurface {
  TriangleSurface surface;  ///< sound
  SurfaceReport report;     ///< what was done to it
};

/// Reads what a file holds: a mesh, or, where it has triangles and no tetrahedron, a surface.
/// @throw InputError as read_mesh() and read_surface() do
std::variant<ReadMesh, ReadSurface> read_any(const std::filesystem::path& path);

/// What a file of a mesh holds, in the format that its extension names; coordinates keep every bit
/// where nothing else is said. TetGen's format is two files, whichever of them is named. Nothing is
/// written to disk.
/// @param path    names the format; the written files have its name
/// @param mesh    what to write
/// @param format  the name of a format of that extension (see list.hpp); empty: the first one
/// @param binary  the binary form of it
/// @param groups  how the mesh's file had its groups, or nothing
/// @throw InputError for an unknown extension or format, and what the format can in no way hold
WrittenMesh write_mesh(const std::filesystem::path& path, const TetMesh& mesh,
                       const std::string& format = "", bool binary = false,
                       const MeshGroups& groups = {});

/// The same of a surface.
WrittenMesh write_surface(const std::filesystem::path& path, const TriangleSurface& surface,
                          const std::string& format = "", bool binary = false);

}  // namespace plica
