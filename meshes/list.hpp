// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/meshes/msh/parse_msh.hpp>
#include <plica/meshes/msh/write_msh.hpp>
#include <plica/meshes/surfaces/parse_obj.hpp>
#include <plica/meshes/surfaces/parse_stl.hpp>
#include <plica/meshes/surfaces/write_surfaces.hpp>
#include <plica/meshes/tetgen/parse_tetgen.hpp>
#include <plica/meshes/tetgen/write_tetgen.hpp>
#include <plica/meshes/vtk/parse_vtk.hpp>
#include <plica/meshes/vtk/parse_vtu.hpp>
#include <plica/meshes/vtk/write_vtk.hpp>

namespace plica {

/// A format of files with meshes or surfaces.
struct MeshFormat {
  const char* extension;    ///< lower case, without the dot
  const char* description;  ///< for help texts
  RawMesh (*parse)(const MemoryFile& file, MeshReport& report);
};

/// All that hold tetrahedra. A new format is one file with a parser, and one line here.
inline constexpr MeshFormat mesh_formats[] = {
    {"msh", "Gmsh MSH 2.2 and 4.1, text and binary", parse_msh},
    {"vtk", "VTK legacy, an unstructured grid, text and binary", parse_vtk},
    {"vtu", "VTK XML, an unstructured grid in one piece, not compressed", parse_vtu},
    {"ele", "TetGen, with the .node file beside it", parse_tetgen},
    {"node", "TetGen, with the .ele file beside it", parse_tetgen},
};

/// All that hold triangles.
inline constexpr MeshFormat surface_formats[] = {
    {"obj", "Wavefront OBJ, its polygons", parse_obj},
    {"stl", "STL, text and binary", parse_stl},
    {"msh", "Gmsh MSH 2.2 and 4.1, its triangles", parse_msh},
};

/// A format that meshes or surfaces are written in.
template <class Mesh>
struct Writer {
  const char* extension;
  const char* name;  ///< to choose among those of an extension
  bool binary;
  const char* description;
  WrittenMesh (*write)(const std::filesystem::path& path, const Mesh& mesh);
};

/// All of them; of one extension the first is written when nothing more is said.
inline constexpr Writer<TetMesh> mesh_writers[] = {
    {"msh", "msh41", false, "Gmsh MSH 4.1, text", write_msh41},
    {"msh", "msh41", true, "Gmsh MSH 4.1, binary", write_msh41_binary},
    {"msh", "msh22", false, "Gmsh MSH 2.2, text", write_msh22},
    {"msh", "msh22", true, "Gmsh MSH 2.2, binary", write_msh22_binary},
    {"vtk", "vtk", false, "VTK legacy 3.0, text", write_vtk},
    {"vtk", "vtk", true, "VTK legacy 3.0, binary", write_vtk_binary},
    {"vtu", "vtu", true, "VTK XML, raw appended arrays", write_vtu},
    {"ele", "tetgen", false, "TetGen, with the .node file beside it", write_tetgen},
    {"node", "tetgen", false, "TetGen, with the .ele file beside it", write_tetgen},
};
inline constexpr Writer<TriangleSurface> surface_writers[] = {
    {"obj", "obj", false, "Wavefront OBJ", write_obj},
    {"stl", "stl", false, "STL, text", write_stl},
    {"stl", "stl", true, "STL, binary", write_stl_binary},
};

}  // namespace plica
