// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <plica/meshes/files/parsed_mesh.hpp>
#include <plica/meshes/files/writing.hpp>

namespace plica {

// Mesh formats, each in a source file of its own (MSH in three).

/// Reads the elements of a Gmsh file (its reference manual, "MSH file format"): MSH 1, 2.0 to 2.2
/// and 4.1. Versions 2 and 4.1 may be text, or binary in either byte order. The treatment of
/// elements is in add_element(), for all formats.
///
/// Physical groups of volumes become regions, in the order of their tags. A nameless group is
/// "physical_TAG"; elements of no group have TAG 0. If no element belongs to a group, there is one
/// nameless region. Physical groups of surfaces, curves and points become vertex sets; two with one
/// name are one set. Coordinates are read as metres. Parametric coordinates (4.1) and partitions
/// are left out.
///
/// The parser is strict. It throws an InputError for anything malformed or cut short, another
/// version, and elements that are not supported. The error has the file, the line or byte, the
/// value and what was expected. In surfaces up to one bad face in a hundred is left out and
/// counted. Vectors with three components in $NodeData and $ElementData are read; other sections
/// ($Periodic, ...) are skipped.
ParsedMesh parse_msh(const FileBytes& file, MeshReport& report);

/// Writes Gmsh MSH files, text or binary. Regions become physical groups of volumes. Groups of
/// lower dimension keep their elements; other vertex sets become physical groups of points. Tags
/// are those of `groups`, else from 1. parse_msh() reads the mesh unchanged, except for sets
/// without a vertex.
WrittenMesh write_msh22(const std::filesystem::path& path, const TetMesh& mesh,
                        const MeshGroups& groups);
WrittenMesh write_msh41(const std::filesystem::path& path, const TetMesh& mesh,
                        const MeshGroups& groups);
WrittenMesh write_msh22_binary(const std::filesystem::path& path, const TetMesh& mesh,
                               const MeshGroups& groups);
WrittenMesh write_msh41_binary(const std::filesystem::path& path, const TetMesh& mesh,
                               const MeshGroups& groups);

/// Reads the cells of an unstructured grid, or of polygonal data, in VTK's legacy format. Versions
/// are 1.0 to 5.1, text or binary ("VTK file formats" in its documentation).
///
/// Regions are given by the cells' integer array "region", or else by the first array with one
/// integer per cell. Points and cells have the numbers they have in the file, from 0. Coordinates
/// are read as metres.
///
/// The parser is as strict as parse_msh(). The format has no end mark: a file that is cut between
/// two arrays looks complete.
ParsedMesh parse_vtk(const FileBytes& file, MeshReport& report);

/// Reads the cells of an unstructured grid, or of polygonal data, in VTK's XML format. The grid is
/// in one piece ("VTK XML file formats" in its documentation). Arrays are text, base64, or
/// appended, raw or in base64. They are in either byte order, and may be compressed by zlib or LZ4.
///
/// Regions and numbers are those of parse_vtk(). The parser is as strict as parse_msh().
ParsedMesh parse_vtu(const FileBytes& file, MeshReport& report);

/// Writes VTK's legacy format 3.0, text or binary, or its XML format with raw appended arrays.
/// Regions are numbers in the cells' array "region". Neither format has vertex sets.
WrittenMesh write_vtk(const std::filesystem::path& path, const TetMesh& mesh,
                      const MeshGroups& groups);
WrittenMesh write_vtk_binary(const std::filesystem::path& path, const TetMesh& mesh,
                             const MeshGroups& groups);
WrittenMesh write_vtu(const std::filesystem::path& path, const TetMesh& mesh,
                      const MeshGroups& groups);

/// Reads the elements of a Medit file in text (Frey, MEDIT: an interactive mesh visualization
/// software, INRIA RT-0253). Its references number regions, named like "reference_3", and groups.
/// Coordinates are read as metres. The parser is as strict as parse_msh().
ParsedMesh parse_medit(const FileBytes& file, MeshReport& report);

/// Writes Medit in text, with regions and groups as references; names are left out.
WrittenMesh write_medit(const std::filesystem::path& path, const TetMesh& mesh,
                        const MeshGroups& groups);

/// Reads the tetrahedra of a pair of files by TetGen (its manual, "File formats"): NAME.node and
/// NAME.ele, numbered from 0 or 1.
///
/// Tetrahedra with the first attribute 3 are the region "attribute_3". Where all attributes are 0,
/// or there is none, there is one nameless region. Vertices with the boundary marker 2 are the set
/// "marker_2"; 0 marks none. Coordinates are read as metres.
///
/// The parser is as strict as parse_msh(). The first line of each file gives its length; the end of
/// a file may be marked by a comment only.
ParsedMesh parse_tetgen(const FileBytes& elements, const FileBytes& nodes, MeshReport& report);

/// Reads a pair of TetGen files when one of them is given; the other one is loaded from its folder.
ParsedMesh parse_tetgen(const FileBytes& file, MeshReport& report);

/// Writes NAME.node and NAME.ele of TetGen, numbered from 1. Regions are the attribute of
/// tetrahedra. Vertex sets are boundary markers, of which a vertex has one at most.
WrittenMesh write_tetgen(const std::filesystem::path& path, const TetMesh& mesh,
                         const MeshGroups& groups);

/// Reads the mesh of an input file of Abaqus or CalculiX (their manuals, "Input syntax rules"):
/// *NODE, *ELEMENT, *NSET, *ELSET, *SURFACE and *SOLID SECTION, of one part and one instance. Sets
/// become regions and vertex sets as DeckGather says. Other keywords are left out, and named in a
/// note; those that make nodes and elements in other ways are refused. Coordinates are read as
/// metres. The parser is as strict as parse_msh().
ParsedMesh parse_inp(const FileBytes& file, MeshReport& report);

/// Reads the mesh of a FEBio file, version 2 to 4 (its manual, "Geometry section" and "Mesh
/// section"): nodes, elements, node sets, surfaces, edges and element sets. Each part of elements
/// is a set with a material, see DeckGather. Coordinates are read as metres. The parser is as
/// strict as parse_msh().
ParsedMesh parse_feb(const FileBytes& file, MeshReport& report);

/// Reads the vertices and faces of a Wavefront OBJ file. Vertices are numbered from 1, or backwards
/// from the last vertex with minus signs. Faces with more than three corners are cut into triangles
/// from one of their corners, so that all triangles look to one side. Textures, normals, groups,
/// materials, lines and points are left out; free-form geometry is refused. Coordinates are read as
/// metres.
///
/// The parser is as strict as parse_msh(). The format has no end mark: a file that is cut between
/// two faces looks complete.
ParsedMesh parse_obj(const FileBytes& file, MeshReport& report);

/// Reads the triangles of an STL file, text or binary. A file is binary if its size fits the number
/// of triangles, as the title of a binary file may begin like text. Corners with exactly equal
/// coordinates are one vertex. Normals are left out: the order of the corners defines them. Several
/// solids are one surface. Coordinates are read as metres.
///
/// The parser is as strict as parse_msh().
ParsedMesh parse_stl(const FileBytes& file, MeshReport& report);

/// Reads vertices and faces of a PLY file (Turk, The PLY polygon file format, 1994), text or
/// binary; other elements and properties are left out. Coordinates are read as metres. The parser
/// is as strict as parse_msh().
ParsedMesh parse_ply(const FileBytes& file, MeshReport& report);

/// Reads vertices and faces of an OFF file of Geomview in text. Variants such as COFF and NOFF are
/// supported; colours, normals and textures are left out. Coordinates are read as metres. The
/// parser is as strict as parse_msh().
ParsedMesh parse_off(const FileBytes& file, MeshReport& report);

/// Writes Wavefront OBJ, PLY in binary, OFF in text, or STL, text or binary. Binary STL keeps seven
/// digits of the coordinates.
WrittenMesh write_obj(const std::filesystem::path& path, const TriangleSurface& surface);
WrittenMesh write_ply(const std::filesystem::path& path, const TriangleSurface& surface);
WrittenMesh write_off(const std::filesystem::path& path, const TriangleSurface& surface);
WrittenMesh write_stl(const std::filesystem::path& path, const TriangleSurface& surface);
WrittenMesh write_stl_binary(const std::filesystem::path& path, const TriangleSurface& surface);

/// File format of meshes or surfaces that can be read.
struct MeshFormat {
  const char* extension;    ///< lower case, without the dot
  const char* description;  ///< text for help
  ParsedMesh (*parse)(const FileBytes& file, MeshReport& report);
};

/// All formats that hold tetrahedra. A new format is one source file. Its parser and writer are
/// declared in this header, and get a line in these lists.
inline constexpr MeshFormat mesh_formats[] = {
    {"msh", "Gmsh MSH 1, 2 and 4.1, text and binary", parse_msh},
    {"mesh", "Medit, text", parse_medit},
    {"vtk", "VTK legacy, an unstructured grid, text and binary", parse_vtk},
    {"vtu", "VTK XML, an unstructured grid in one piece", parse_vtu},
    {"ele", "TetGen, with the .node file beside it", parse_tetgen},
    {"node", "TetGen, with the .ele file beside it", parse_tetgen},
    {"inp", "Abaqus and CalculiX, the mesh of one part", parse_inp},
    {"feb", "FEBio 2 to 4, its mesh", parse_feb},
};

/// All formats that hold triangles.
inline constexpr MeshFormat surface_formats[] = {
    {"obj", "Wavefront OBJ, its polygons", parse_obj},
    {"stl", "STL, text and binary", parse_stl},
    {"ply", "PLY, text and binary", parse_ply},
    {"off", "OFF, text", parse_off},
    {"vtp", "VTK XML, polygonal data in one piece", parse_vtu},
    {"vtk", "VTK legacy, polygonal data, or the faces of a grid", parse_vtk},
    {"vtu", "VTK XML, the faces of an unstructured grid", parse_vtu},
    {"msh", "Gmsh MSH, its faces", parse_msh},
    {"mesh", "Medit, its faces", parse_medit},
    {"inp", "Abaqus and CalculiX, shells and rigid faces", parse_inp},
    {"feb", "FEBio, its shells", parse_feb},
};

/// File format of meshes or surfaces that can be written.
template <class Mesh, class... Groups>
struct Writer {
  const char* extension;
  const char* name;  ///< name to choose a format where an extension has several
  bool binary;
  const char* description;
  WrittenMesh (*write)(const std::filesystem::path& path, const Mesh& mesh,
                       const Groups&... groups);
};
using MeshWriter = Writer<TetMesh, MeshGroups>;
using SurfaceWriter = Writer<TriangleSurface>;

/// All formats that are written. Without a name, the first format of an extension is written.
inline constexpr MeshWriter mesh_writers[] = {
    {"msh", "msh41", false, "Gmsh MSH 4.1, text", write_msh41},
    {"msh", "msh41", true, "Gmsh MSH 4.1, binary", write_msh41_binary},
    {"msh", "msh22", false, "Gmsh MSH 2.2, text", write_msh22},
    {"msh", "msh22", true, "Gmsh MSH 2.2, binary", write_msh22_binary},
    {"mesh", "medit", false, "Medit, text", write_medit},
    {"vtk", "vtk", false, "VTK legacy 3.0, text", write_vtk},
    {"vtk", "vtk", true, "VTK legacy 3.0, binary", write_vtk_binary},
    {"vtu", "vtu", true, "VTK XML, raw appended arrays", write_vtu},
    {"ele", "tetgen", false, "TetGen, with the .node file beside it", write_tetgen},
    {"node", "tetgen", false, "TetGen, with the .ele file beside it", write_tetgen},
};
inline constexpr SurfaceWriter surface_writers[] = {
    {"obj", "obj", false, "Wavefront OBJ", write_obj},
    {"ply", "ply", true, "PLY, binary", write_ply},
    {"off", "off", false, "OFF, text", write_off},
    {"stl", "stl", false, "STL, text", write_stl},
    {"stl", "stl", true, "STL, binary", write_stl_binary},
};

}  // namespace plica
