// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <cstdint>
#include <plica/core/mesh.hpp>
#include <plica/meshes/embedding.hpp>
#include <vector>

// Cuts along faces. Tetrahedra keep their shapes, numbers and masses; the faces between the two
// sides of a blade open. A vertex becomes several where the tetrahedra around it are no longer
// joined by faces. So no volume is lost, and the cut ends in whole edges: the vertices at its front
// stay single.
namespace plica {

/// Numbers of faces inside a mesh, ascending: 4 times the lower of the face's two tetrahedra, plus
/// the corner of that tetrahedron that is across.
using Faces = std::vector<std::int64_t>;

/// Triangles that a blade sweeps, by their corners [m].
using Blade = std::vector<std::array<Point, 3>>;

/// Returns the faces that a blade opens: those between two tetrahedra whose centroids are joined by
/// a line through one of its triangles. Triangles without area open nothing.
/// @param tets       tetrahedra of the mesh
/// @param positions  where the vertices are, in the room in which the blade moves [m]
/// @param blade      what the blade sweeps
Faces faces_across(const std::vector<std::array<int, 4>>& tets, const std::vector<Point>& positions,
                   const Blade& blade);

/// A mesh after faces were opened.
struct CutMesh {
  TetMesh mesh;           ///< tetrahedra keep their numbers, and vertices theirs
  std::vector<int> twin;  ///< former vertex of each new one; these are the last vertices
};

/// Opens faces of a mesh. At each vertex, the tetrahedra that faces still join keep one vertex
/// together. The group with the lowest tetrahedron keeps the number; the others get new ones, in
/// the order of vertices and of their lowest tetrahedra. Named sets get the new vertices of their
/// own, named triangles both sides.
/// @param mesh  mesh without open faces
/// @param open  all faces that are open, also those of earlier cuts; a face that opens alone,
/// without a vertex that splits, opens together with later ones
CutMesh open_faces(const TetMesh& mesh, const Faces& open);

/// Returns the number of pieces of a mesh that share no vertex.
int count_pieces(const TetMesh& mesh);

/// Returns per point of a surface the vertex at its place, where the surface is the boundary of the
/// mesh: it has as many triangles, and each point is at a vertex of the boundary. Else empty, as
/// where two of these vertices are at one place.
std::vector<int> boundary_vertices_of(const TriangleSurface& surface, const TetMesh& mesh);

/// Replaces a surface, which was the boundary of a mesh, by the boundary of the mesh after a cut.
/// Points keep their numbers; new ones come at the end. Textures are left out.
/// @param mesh     mesh after the cut
/// @param surface  surface to replace
/// @param vertex   vertex of the mesh at each point; new points are added to it
void follow_cut(const TetMesh& mesh, TriangleSurface& surface, std::vector<int>& vertex);

/// Returns the embedding of points that are vertices of the mesh, by their numbers.
Embedding embed_at_vertices(const TetMesh& mesh, const std::vector<int>& vertex);

}  // namespace plica
