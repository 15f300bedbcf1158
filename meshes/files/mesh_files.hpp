// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <plica/core/mesh.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/files/file_bytes.hpp>
#include <plica/meshes/files/parsed_mesh.hpp>
#include <plica/meshes/files/validated_mesh.hpp>
#include <plica/meshes/files/writing.hpp>
#include <string>
#include <variant>

namespace plica {

/// Reads a tetrahedral mesh. Its format is what the first bytes of the file say; formats without
/// such bytes (OBJ, TetGen) are told by the extension, in any case of letters. A note in the report
/// says where the two differ.
/// @param path     path of the file
/// @param report   if given, gets what was repaired and left out
/// @param options  regions that are taken and left out; flaws for repair_mesh(); second order
/// @throw InputError for an unknown extension, and as the parser of the format and validated_mesh()
/// do
TetMesh read_mesh(const std::filesystem::path& path, MeshReport* report = nullptr,
                  const ReadOptions& options = {});

/// Reads a tetrahedral mesh from a file in memory.
TetMesh read_mesh(const FileBytes& file, MeshReport* report = nullptr,
                  const ReadOptions& options = {});

/// Reads the triangles of a surface, in a format that is told as that of a mesh.
/// @param path    path of the file
/// @param report  if given, gets what was repaired and left out, and whether the surface is closed
/// @param weld    distance up to which points on open edges become one, as a part of the diagonal
/// of the box; 0: they stay
/// @throw InputError for an unknown extension, and as the parser of the format and
/// validated_surface() do
TriangleSurface read_surface(const std::filesystem::path& path, SurfaceReport* report = nullptr,
                             double weld = weld_distance);

/// Reads the triangles of a surface from a file in memory.
TriangleSurface read_surface(const FileBytes& file, SurfaceReport* report = nullptr,
                             double weld = weld_distance);

/// Mesh that was read from a file.
struct ReadMesh {
  TetMesh mesh;       ///< mesh that passed validated_mesh()
  MeshReport report;  ///< report of what was repaired and left out
};
/// Surface that was read from a file.
struct ReadSurface {
  TriangleSurface surface;  ///< surface that passed validated_surface()
  SurfaceReport report;     ///< report of what was repaired and left out
};

/// Reads a mesh, or a surface if the file has triangles and no tetrahedron.
/// @throw InputError as read_mesh() and read_surface() do
std::variant<ReadMesh, ReadSurface> read_any(const std::filesystem::path& path,
                                             const ReadOptions& options = {});

/// Returns the bytes of a mesh file in the format that its extension names. Nothing is written to
/// disk. Coordinates keep every bit unless a format says otherwise. TetGen's format is two files,
/// for the path of either.
/// @param path    names the format; the written files have its name
/// @param mesh    mesh to write
/// @param format  name of a format of that extension (see list.hpp); empty: the first one
/// @param binary  true for the binary form of the format
/// @param groups  groups as the mesh's file has them, or empty
/// @throw InputError for an unknown extension or format, for what the format cannot hold, and for
/// corners and regions that the mesh does not have
WrittenMesh write_mesh(const std::filesystem::path& path, const TetMesh& mesh,
                       const std::string& format = "", bool binary = false,
                       const MeshGroups& groups = {});

/// Returns the bytes of a surface file in the format that its extension names. Nothing is written
/// to disk.
/// @throw InputError for an unknown extension or format, and for what the format cannot hold
WrittenMesh write_surface(const std::filesystem::path& path, const TriangleSurface& surface,
                          const std::string& format = "", bool binary = false);

}  // namespace plica
