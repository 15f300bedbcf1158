// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <plica/meshes/files/raw_mesh.hpp>
#include <plica/meshes/files/writing.hpp>

namespace plica {

// The formats, each in a source file of its own (MSH in three).

/// Takes the elements of a Gmsh file (its reference manual, "MSH file format"): MSH 1, 2.0 to 2.2
/// and 4.1, the last two text or binary in either order of bytes. What all formats make of elements
/// is in add_element().
///
/// Physical groups of volumes become regions, in the order of their tags; a nameless one is
/// "physical_TAG", and so is what belongs to none (TAG 0), unless nothing belongs to any: then
/// there is one nameless region. Physical groups of surfaces, curves and points become vertex sets;
/// two with the same name are one set. Coordinates are taken as metres. Parametric coordinates
/// (4.1) are left out; partitions count for nothing.
///
/// Strict: anything malformed, cut short, of another version or of elements that we cannot take is
/// an InputError with file, line or byte, the value and what was expected; but one bad face in a
/// hundred of a surface is left out and counted. Sections Gmsh adds for other uses ($Periodic,
/// $NodeData, ...) are skipped.
RawMesh parse_msh(const MemoryFile& file, MeshReport& report);

/// Gmsh MSH files, text and binary. Regions become physical groups of volumes and the groups of
/// lower dimension stay what they are; other vertex sets become physical groups of points. Tags are
/// those of `groups`, else from 1. What parse_msh() makes of them is the same mesh, but for sets
/// without a vertex.
WrittenMesh write_msh22(const std::filesystem::path& path, const TetMesh& mesh,
                        const MeshGroups& groups);
WrittenMesh write_msh41(const std::filesystem::path& path, const TetMesh& mesh,
                        const MeshGroups& groups);
WrittenMesh write_msh22_binary(const std::filesystem::path& path, const TetMesh& mesh,
                               const MeshGroups& groups);
WrittenMesh write_msh41_binary(const std::filesystem::path& path, const TetMesh& mesh,
                               const MeshGroups& groups);

/// Takes the cells of an unstructured grid, or of polygonal data, of VTK's legacy format ("VTK file
/// formats" in its documentation), versions 1.0 to 5.1, text or binary.
///
/// Regions are told by the cells' array of integers named "region", or else by the first one with
/// an integer per cell. Points and cells have the numbers they have in the file, from 0.
/// Coordinates are taken as metres.
///
/// Strict, as parse_msh(). The format has no end mark: a file that is cut between two arrays looks
/// whole.
RawMesh parse_vtk(const MemoryFile& file, MeshReport& report);

/// Takes the cells of an unstructured grid, or of polygonal data, of VTK's XML format ("VTK XML
/// file formats" in its documentation) in one piece: arrays as text, in base64, or appended, raw or
/// in base64; in either order of bytes; compressed by zlib or LZ4, or not.
///
/// Regions and numbers are as for parse_vtk(). Strict, as parse_msh().
RawMesh parse_vtu(const MemoryFile& file, MeshReport& report);

/// VTK's legacy format 3.0, text and binary, and its XML format with raw appended arrays. Regions
/// are numbers in the cells' array "region"; neither has vertex sets.
WrittenMesh write_vtk(const std::filesystem::path& path, const TetMesh& mesh,
                      const MeshGroups& groups);
WrittenMesh write_vtk_binary(const std::filesystem::path& path, const TetMesh& mesh,
                             const MeshGroups& groups);
WrittenMesh write_vtu(const std::filesystem::path& path, const TetMesh& mesh,
                      const MeshGroups& groups);

/// Takes the elements of a Medit file in text (Frey, MEDIT: an interactive mesh visualization
/// software, INRIA RT-0253): its references number regions, "reference_3", and groups. Coordinates
/// are taken as metres. Strict, as parse_msh().
RawMesh parse_medit(const MemoryFile& file, MeshReport& report);

/// Medit in text, with regions and groups as references; names are left out.
WrittenMesh write_medit(const std::filesystem::path& path, const TetMesh& mesh,
                        const MeshGroups& groups);

/// Takes the tetrahedra of a pair of files by TetGen (its manual, "File formats"): NAME.node and
/// NAME.ele, numbered from 0 or 1.
///
/// Region 3 is what has 3 as its first attribute, and named "attribute_3"; where all are 0 or there
/// is none, there is one nameless region. Vertices with the boundary marker 2 are the set
/// "marker_2"; 0 marks none. Coordinates are taken as metres.
///
/// Strict, as parse_msh(). Neither file has an end mark, but a comment: their first line tells how
/// long they are.
RawMesh parse_tetgen(const MemoryFile& elements, const MemoryFile& nodes, MeshReport& report);

/// The same with one of the two; the other one lies beside it.
RawMesh parse_tetgen(const MemoryFile& file, MeshReport& report);

/// NAME.node and NAME.ele, numbered from 1. Regions are the attribute of tetrahedra; vertex sets
/// are boundary markers, of which a vertex has one at most.
WrittenMesh write_tetgen(const std::filesystem::path& path, const TetMesh& mesh,
                         const MeshGroups& groups);

/// Takes the vertices and faces of a Wavefront OBJ file, numbered from 1 or backwards from the last
/// vertex with minus signs. Faces with more than three corners are cut into triangles from one of
/// their corners, which must not turn any of these over. Textures, normals, groups, materials,
/// lines and points are left out; free-form geometry is refused. Coordinates are taken as metres.
///
/// Strict, as parse_msh(). The format has no end mark: a file that is cut between two faces looks
/// whole.
RawMesh parse_obj(const MemoryFile& file, MeshReport& report);

/// Takes the triangles of an STL file, text or binary (it is binary when its size fits the
/// number of triangles: the title of a binary file may begin like text). Corners at exactly the
/// same place are one vertex. Normals are left out: the order of the corners says the same. Several
/// solids are one surface. Coordinates are taken as metres.
///
/// Strict, as parse_msh().
RawMesh parse_stl(const MemoryFile& file, MeshReport& report);

/// Takes vertices and faces of a PLY file (Turk, The PLY polygon file format, 1994), text or
/// binary; other elements and properties are left out. Coordinates are taken as metres. Strict, as
/// parse_msh().
RawMesh parse_ply(const MemoryFile& file, MeshReport& report);

/// Takes vertices and faces of an OFF file of Geomview in text, OFF, COFF, NOFF and their like:
/// colours and normals are left out. Coordinates are taken as metres. Strict, as parse_msh().
RawMesh parse_off(const MemoryFile& file, MeshReport& report);

/// Wavefront OBJ, PLY in binary, OFF in text; and STL, text and binary: the binary one keeps seven
/// digits of the coordinates.
WrittenMesh write_obj(const std::filesystem::path& path, const TriangleSurface& surface);
WrittenMesh write_ply(const std::filesystem::path& path, const TriangleSurface& surface);
WrittenMesh write_off(const std::filesystem::path& path, const TriangleSurface& surface);
WrittenMesh write_stl(const std::filesystem::path& path, const TriangleSurface& surface);
WrittenMesh write_stl_binary(const std::filesystem::path& path, const TriangleSurface& surface);

/// A format of files with meshes or surfaces.
struct MeshFormat {
  const char* extension;    ///< lower case, without the dot
  const char* description;  ///< for help texts
  RawMesh (*parse)(const MemoryFile& file, MeshReport& report);
};

/// All that hold tetrahedra. A new format is one source file: its parser and writer are declared
/// above, and get a line here.
inline constexpr MeshFormat mesh_formats[] = {
    {"msh", "Gmsh MSH 1, 2 and 4.1, text and binary", parse_msh},
    {"mesh", "Medit, text", parse_medit},
    {"vtk", "VTK legacy, an unstructured grid, text and binary", parse_vtk},
    {"vtu", "VTK XML, an unstructured grid in one piece", parse_vtu},
    {"ele", "TetGen, with the .node file beside it", parse_tetgen},
    {"node", "TetGen, with the .ele file beside it", parse_tetgen},
};

/// All that hold triangles.
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
};

/// A format that meshes or surfaces are written in.
template <class Mesh, class... Groups>
struct Writer {
  const char* extension;
  const char* name;  ///< to choose among those of an extension
  bool binary;
  const char* description;
  WrittenMesh (*write)(const std::filesystem::path& path, const Mesh& mesh,
                       const Groups&... groups);
};
using MeshWriter = Writer<TetMesh, MeshGroups>;
using SurfaceWriter = Writer<TriangleSurface>;

/// All of them; of one extension the first is written when nothing more is said.
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
