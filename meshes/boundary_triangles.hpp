// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <map>
#include <optional>
#include <plica/core/mesh.hpp>
#include <string>
#include <vector>

namespace plica {

/// Three tetrahedra with a face in common, if there are any, else two on the same side of one: some
/// of them overlap. Else none. Of tetrahedra with positive volumes.
std::vector<std::size_t> overlap_at_a_face(const TetMesh& mesh);

/// The faces that belong to one tetrahedron only, counter-clockwise seen from outside; mesh vertex
/// numbers, in the order of the tetrahedra.
std::vector<std::array<int, 3>> boundary_triangles(const TetMesh& mesh);

/// The boundary as a surface of its own.
struct BoundarySurface {
  TriangleSurface surface;       ///< its triangles, and their vertices only
  std::vector<int> mesh_vertex;  ///< per surface vertex its number in the mesh, ascending
};
/// Of a mesh.
BoundarySurface boundary_surface(const TetMesh& mesh);

/// The sum of the areas of the triangles. [m^2]
double surface_area(const TriangleSurface& surface);

/// The volume a closed surface encloses, above zero when its triangles look outwards. [m^3]
double enclosed_volume(const TriangleSurface& surface);

/// What a reader of surfaces found, repaired and left out.
struct SurfaceReport {
  std::string format;    ///< like "STL binary"
  int unreferenced = 0;  ///< vertices of no triangle, dropped
  int collapsed = 0;     ///< triangles with a vertex twice, dropped
  /// triangles with the vertices of another one in the same turn, dropped
  int repeated = 0;
  int left_out = 0;  ///< faces that are none, at most one of a hundred
  /// faces of higher order, of which the corners were taken: kind -> how many
  std::map<std::string, int> linearised;
  int open_edges = 0;          ///< of one triangle only
  int crowded_edges = 0;       ///< of more than two: the surface is no manifold there
  int inconsistent_edges = 0;  ///< of two triangles that look to different sides
  int parts = 0;               ///< that share no vertex
  /// the middle of the first edge that keeps it from being closed [m]
  Point open_at = Point::Zero();
  bool turned = false;  ///< closed, but inside out: all triangles were turned

  /// Whether it has an inside.
  bool closed() const { return open_edges == 0 && crowded_edges == 0 && inconsistent_edges == 0; }
};

/// Adds its edges that keep a surface from having an inside to the report.
void count_edges(const TriangleSurface& surface, SurfaceReport& report);

}  // namespace plica
