// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/meshes/msh/parse_msh.hpp>
#include <plica/meshes/vtk/parse_vtk.hpp>
#include <plica/meshes/vtk/parse_vtu.hpp>

namespace plica {

/// A format of mesh files.
struct MeshFormat {
  const char* extension;    ///< lower case, without the dot
  const char* description;  ///< for help texts
  RawMesh (*parse)(const InputFile& file, MeshReport& report);
};

/// All of them. A new format is one file with a parser, and one line here.
inline constexpr MeshFormat mesh_formats[] = {
    {"msh", "Gmsh MSH 2.2 and 4.1, text and binary", parse_msh},
    {"vtk", "VTK legacy, an unstructured grid, text and binary", parse_vtk},
    {"vtu", "VTK XML, an unstructured grid in one piece, not compressed", parse_vtu},
};

}  // namespace plica
