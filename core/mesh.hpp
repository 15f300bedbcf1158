// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Geometry>  // cross()
#include <array>
#include <map>
#include <string>
#include <vector>

namespace plica {

using Point = Eigen::Vector3d;  ///< a point or vector of set-up geometry, always double [m]

/// An axis-aligned box, both ends included.
struct Box {
  Point min = Point::Zero();  ///< lowest corner [m]
  Point max = Point::Zero();  ///< highest corner [m]
};

/// Vertices that follow tetrahedra of the same mesh, at the border between a finer piece and a
/// coarser one. Each is where its masters put it: x = sum_k weight_k x_of_k. It has no motion of
/// its own. No master follows another vertex.
struct Followers {
  std::vector<int> vertex;             ///< vertices that follow, ascending
  std::vector<std::array<int, 4>> of;  ///< masters: the free vertices of a tetrahedron
  /// Barycentric weights in that tetrahedron at rest, with the sum 1; below 0 outside it
  std::vector<std::array<double, 4>> weight;
};

/// Losses of a piece of a mesh to finer pieces.
struct PieceCover {
  int dropped = 0;    ///< tetrahedra that are left out
  double volume = 0;  ///< volume that finer pieces have in common with it [m^3]
};

/// A tetrahedral mesh at rest, on the host. Sound by construction: readers and generators deliver
/// every tetrahedron with positive volume (vertex 3 on the side that (1-0)x(2-0) points to) and
/// every vertex used.
struct TetMesh {
  std::vector<Point> vertices;           ///< [m]
  std::vector<std::array<int, 4>> tets;  ///< vertex indices
  /// Index into region_names for each tet; empty: one nameless region
  std::vector<int> region;
  std::vector<std::string> region_names;  ///< unique names
  /// Named vertices (surface, line and point groups), ascending
  std::map<std::string, std::vector<int>> vertex_sets;
  /// Part of each tet that is body, in (0, 1]; empty: all of each
  std::vector<double> filled = {};
  /// Named vectors, one per tet, such as directions of fibres
  std::map<std::string, std::vector<Point>> tet_vectors = {};
  /// Named triangles by their vertices, in any orientation; the set of vertices of that name has
  /// at least those of the triangles
  std::map<std::string, std::vector<std::array<int, 3>>> triangle_sets = {};
  /// Number of the piece of each tet, 0 the finest; empty: one piece. Pieces have no vertex in
  /// common and share room where a tet is filled in part, see compose()
  std::vector<int> piece = {};
  /// Losses of each piece to finer ones, by its number; empty: not known
  std::vector<PieceCover> covered = {};
  /// Vertices of borders between pieces, which follow the coarser one
  Followers followers = {};
  /// Faces of one tetrahedron that are no boundary of the body, as at borders between pieces: each
  /// by its ascending vertices, all ascending
  std::vector<std::array<int, 3>> inner_faces = {};
  /// Faces that cuts have opened, of both sides: each by its ascending vertices, all ascending
  std::vector<std::array<int, 3>> opened = {};

  /// Returns the part of a tetrahedron that is body. Its mass, stiffness and energy are this part
  /// of what its volume would have.
  double part(std::size_t tet) const { return filled.empty() ? 1 : filled[tet]; }
};

/// Texture coordinates u and v at the corners of a triangle.
using CornerTexture = std::array<std::array<double, 2>, 3>;

/// A triangulated surface, on the host.
struct TriangleSurface {
  std::vector<Point> vertices;                ///< [m]
  std::vector<std::array<int, 3>> triangles;  ///< counter-clockwise seen from outside
  /// Texture coordinates of each triangle's corners; empty: none. At a seam of the texture, corners
  /// at one vertex differ.
  std::vector<CornerTexture> texture = {};
};

/// Returns a sixth of the determinant of the edges from vertex `a`: the volume [m^3].
inline double tet_volume(const Point& a, const Point& b, const Point& c, const Point& d) {
  return (b - a).cross(c - a).dot(d - a) / 6.0;
}

/// Returns the smallest box around the points; both ends are zero without points.
Box bounding_box(const std::vector<Point>& points);

}  // namespace plica
