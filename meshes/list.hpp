// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <plica/meshes/read_msh.hpp>

namespace plica {

/// A format of mesh files.
struct MeshFormat {
  const char* extension;    ///< lower case, without the dot
  const char* description;  ///< for help texts
  TetMesh (*read)(const std::filesystem::path& path, MeshReport* report);
};

/// All of them. A new format is one file with a reader that ends in sound_mesh(), and one line here.
inline constexpr MeshFormat mesh_formats[] = {
    {"msh", "Gmsh MSH 2.2 ASCII", read_msh},
};

}  // namespace plica
