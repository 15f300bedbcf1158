// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/files/parsed_mesh.hpp>
#include <plica/meshes/files/read_options.hpp>
#include <vector>

namespace plica {

/// Checks the content of a file and makes it a mesh; all readers use this function. Turns
/// tetrahedra that are inside out, and drops vertices of no tetrahedron, also from the sets. Writes
/// the counts of both and the original numbers into `report`. Before that, regions are chosen and
/// left out, and second-order tetrahedra are split in eight, see the functions of these names.
///
/// @param options  with Flaws::kept tetrahedra without volume, and overlapping ones, are kept for
/// repair_mesh(); those that repeat another or name a vertex twice are dropped and counted
/// @throw InputError with the place and the numbers in the file: no tetrahedron; a coordinate that
/// is not finite; a vertex defined twice, or not at all; a cell of which only some of the pieces
/// are inside out. With Flaws::refused also: a tetrahedron that names a vertex twice, repeats
/// another, overlaps another at a face, or has no volume (six times the volume is at most 1e-9 of
/// the longest edge cubed)
TetMesh validated_mesh(ParsedMesh raw, MeshReport& report, const ReadOptions& options = {});

/// Checks the content of a file and makes its faces a surface; all readers use this function.
/// Other elements are left out. Surfaces that are open or no manifold are accepted and reported:
/// the caller decides whether they are suitable.
///
/// @param found  report of the parser
/// @param weld  distance up to which points on open edges become one, see weld_open_edges(), as a
/// part of the diagonal of the box; 0: they stay
/// @throw InputError with the place: no triangle; a coordinate that is not finite; a vertex defined
/// twice; more than one invalid face in a hundred. A face is invalid if it names a vertex that is
/// not defined, if it cannot be cut into triangles, or if a triangle has no area (twice the area is
/// at most 1e-12 of the longest edge squared)
TriangleSurface validated_surface(const ParsedMesh& raw, const MeshReport& found,
                                  SurfaceReport& report, double weld = weld_distance);

/// Mesh whose duplicate vertices were merged.
struct MergedMesh {
  TetMesh mesh;                      ///< merged mesh
  int merged = 0;                    ///< vertices that were merged with another one
  std::vector<int> original_vertex;  ///< per vertex of the merged mesh its original number
  std::vector<int> vertex;           ///< per original vertex its number in the merged mesh
};

/// Merges vertices within `tolerance` [m], which is 0 or more, of another one. Each is merged with
/// such a vertex of a lower number, and so on along chains. Tetrahedra keep their order.
/// @throw InputError if a tetrahedron would lose its volume, or two would become equal: the
/// tolerance is too large, or two bodies overlap
MergedMesh merge_duplicates(const TetMesh& mesh, double tolerance);

}  // namespace plica
