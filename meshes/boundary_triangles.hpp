// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <map>
#include <optional>
#include <plica/core/mesh.hpp>
#include <string>
#include <vector>

namespace plica {

/// Returns tetrahedra that overlap at a face, or an empty vector. They are the first three with a
/// face in common; where there are none, the first two on the same side of a common face.
/// @param mesh  every tetrahedron with positive volume
std::vector<std::size_t> overlap_at_a_face(const TetMesh& mesh);

/// Returns the faces that belong to one tetrahedron only, as vertex numbers of the mesh. They are
/// counter-clockwise seen from outside, in the order of the tetrahedra. TetMesh::inner_faces are
/// left out.
std::vector<std::array<int, 3>> boundary_triangles(const TetMesh& mesh);

/// Boundary of a mesh as a surface with vertex numbers of its own.
struct BoundarySurface {
  TriangleSurface surface;       ///< boundary triangles, and the vertices that they use
  std::vector<int> mesh_vertex;  ///< per surface vertex its number in the mesh, ascending
};
/// Returns the boundary triangles of a mesh as a surface, with the numbers of their vertices.
BoundarySurface boundary_surface(const TetMesh& mesh);

/// Returns the sum of the areas of the triangles [m^2].
double surface_area(const TriangleSurface& surface);

/// Returns each point's part of the area: a third of every triangle around it [m^2].
std::vector<double> areas_of_points(const TriangleSurface& surface);

/// Returns the unit normal at each point: the mean of the normals of the triangles around it,
/// weighted by their angles there. It looks outwards; it is 0 where all these triangles are flat.
/// Source: G. Thuermer, C. A. Wuethrich, Computing vertex normals from polygonal facets, Journal of
/// Graphics Tools 3(1), 43-46 (1998)
std::vector<Point> normals_of_points(const TriangleSurface& surface);

/// Returns the volume that a closed surface encloses [m^3]. It is above zero when the triangles
/// look outwards.
double enclosed_volume(const TriangleSurface& surface);

/// Report of a surface reader: what it found, repaired and left out.
struct SurfaceReport {
  std::string format;    ///< like "STL binary"
  int unreferenced = 0;  ///< vertices of no triangle, dropped
  int collapsed = 0;     ///< faces that have fewer than three different vertices, dropped
  /// triangles with the vertices of another one in the same orientation, dropped
  int repeated = 0;
  int left_out = 0;  ///< invalid faces, dropped: at most one in a hundred
  int welded = 0;    ///< vertices on open edges that became one with another, see weld_open_edges()
  std::vector<std::string> notes;  ///< choices of the reader that the user should know
  /// faces of higher order, of which only the corners were used: kind -> how many
  std::map<std::string, int> linearised;
  int open_edges = 0;          ///< edges of one triangle only
  int crowded_edges = 0;       ///< edges of three or more triangles: no manifold there
  int inconsistent_edges = 0;  ///< edges of two triangles that look to different sides
  int parts = 0;               ///< number of parts that share no vertex
  /// middle of the first edge that keeps the surface from being closed [m]
  Point open_at = Point::Zero();
  bool turned = false;  ///< true where a closed surface was inside out: all triangles were turned

  /// Returns whether the surface is closed: every edge has two triangles that look to one side.
  bool closed() const { return open_edges == 0 && crowded_edges == 0 && inconsistent_edges == 0; }
};

/// Counts the edges that keep a surface from being closed, and adds them to the report.
void count_edges(const TriangleSurface& surface, SurfaceReport& report);

}  // namespace plica
