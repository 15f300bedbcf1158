// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/files/raw_mesh.hpp>
#include <vector>

namespace plica {

/// What becomes of tetrahedra that cannot be simulated.
enum class Flaws { refused, kept };

/// The one way from a file to a mesh. Turns tetrahedra that are inside out, drops vertices of no
/// tetrahedron (also from the sets), and writes both and the original numbers into `report`.
///
/// InputError with the place and the numbers in the file: no tetrahedron; a coordinate that is not
/// finite; a vertex defined twice, or not at all; a tetrahedron that names a vertex twice, repeats
/// another, or has no volume (six times the volume is at most 1e-9 of the longest edge cubed). The
/// pieces of one cell must not be inside out in part.
///
/// @param flaws  kept: tetrahedra without volume are kept, those that repeat another or name a
/// vertex twice are dropped and counted,
///               for repair_mesh() to go on with
TetMesh sound_mesh(const RawMesh& raw, MeshReport& report, Flaws flaws = Flaws::refused);

/// The one way from a file to a surface: its triangles, whatever else it holds. Open surfaces and
/// those that are no manifold are taken and counted: whether they will do is for the caller to say.
///
/// @param found  what the parser found
/// @throw InputError with the place: no triangle; quadrangles besides; a coordinate that is not
/// finite; a vertex defined
///        twice, or not at all; a triangle without area (twice the area is at most 1e-12 of the longest edge squared)
TriangleSurface sound_surface(const RawMesh& raw, const MeshReport& found, SurfaceReport& report);

/// A mesh whose duplicate vertices were merged.
struct MergedMesh {
  TetMesh mesh;                      ///< glued together
  int merged = 0;                    ///< vertices that became one with another
  std::vector<int> original_vertex;  ///< per vertex of the mesh its number before
  std::vector<int> vertex;           ///< per vertex before its number in the mesh
};

/// Glues a mesh together where vertices lie within `tolerance` [m], from zero, of another one: each
/// becomes one with such a vertex of a lower number, and so on along chains. Tetrahedra keep their
/// order.
/// @throw InputError when a tetrahedron would lose its volume, or two would become the same: the
/// tolerance is too large,
///        or two bodies lie in each other
MergedMesh merge_duplicates(const TetMesh& mesh, double tolerance);

}  // namespace plica
