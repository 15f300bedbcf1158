// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <plica/meshes/written_mesh.hpp>
#include <string>

namespace plica {

/// What a file of a mesh holds, in the format that its extension names; coordinates keep every bit where nothing else is
/// said. TetGen's format is two files, whichever of them is named. Nothing is written to disk.
/// @param path    names the format; the written files have its name
/// @param mesh    what to write
/// @param format  the name of a format of that extension (see list.hpp); empty: the first one
/// @param binary  the binary form of it
/// @throw InputError for an unknown extension or format, and what the format can in no way hold
WrittenMesh write_mesh(const std::filesystem::path& path, const TetMesh& mesh, const std::string& format = "",
                       bool binary = false);

/// The same of a surface.
WrittenMesh write_surface(const std::filesystem::path& path, const TriangleSurface& surface,
                          const std::string& format = "", bool binary = false);

}  // namespace plica
