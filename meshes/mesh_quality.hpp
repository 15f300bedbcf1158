// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <plica/core/mesh.hpp>
#include <string>
#include <vector>

namespace plica {

/// The edges of a mesh, each once, lower vertex first, ascending.
std::vector<std::array<int, 2>> mesh_edges(const TetMesh& mesh);
/// the same of a surface
std::vector<std::array<int, 2>> mesh_edges(const TriangleSurface& surface);

/// Per vertex the mean length of the edges that meet there [m]; 0 for a vertex of no tetrahedron.
std::vector<double> local_edge_lengths(const TetMesh& mesh);

/// The mean over all edges [m]; 0 without any.
double mean_edge_length(const TetMesh& mesh);

/// The mean over the six edges of one tetrahedron. [m]
double mean_edge_length(const TetMesh& mesh, int tet);

/// Per vertex the lowest vertex of its part: parts share no vertex.
std::vector<int> parts_of(const TetMesh& mesh);

/// The number of parts of a mesh that share no vertex; vertices of no tetrahedron do not count.
int count_parts(const TetMesh& mesh);
int count_parts(const TriangleSurface& surface);  ///< the same of a surface

/// Per point one with a lower number within `tolerance` [m], from zero; -1: there is none.
std::vector<int> lower_twins(const std::vector<Point>& points, double tolerance);

/// The number of vertices within `tolerance` [m] of one with a lower number. Two meshes glued
/// together without merging their common vertices show up here: they come apart when simulated.
int count_duplicate_vertices(const TetMesh& mesh, double tolerance);

/// How many values lie in each interval [bounds[i], bounds[i + 1]); the last one takes its end as
/// well.
struct Histogram {
  std::vector<double> bounds;  ///< ascending, one more than counts
  std::vector<int> counts;     ///< one per interval

  /// All counts zero.
  explicit Histogram(std::vector<double> interval_bounds);
  /// Values beyond the ends count at the ends.
  void add(double value);
};

/// The smallest, mean and largest of some values; zero for none.
struct Range {
  double min = 0.0;   ///< the smallest
  double mean = 0.0;  ///< the arithmetic mean
  double max = 0.0;   ///< the largest
};

/// A tetrahedron with its shape. The height ratio is the longest edge over the smallest height,
/// sqrt(3/2) = 1.22 at best (regular); an explicit step is about as short as the smallest height
/// allows.
struct TetShape {
  int tet = -1;                    ///< its number
  double volume = 0.0;             ///< [m^3]
  double height_ratio = 0.0;       ///< 1
  double smallest_angle = 0.0;     ///< between two faces [degree]
  double largest_angle = 0.0;      ///< between two faces [degree]
  Point centroid = Point::Zero();  ///< [m]
};

/// A region and what it holds.
struct RegionSize {
  std::string name;     ///< empty when the mesh has one nameless region
  int tets = 0;         ///< tetrahedra
  double volume = 0.0;  ///< [m^3]
};

/// What is known of a mesh before it is simulated.
struct MeshQuality {
  int vertices = 0;            ///< their number
  int tets = 0;                ///< likewise
  int boundary_triangles = 0;  ///< likewise
  int parts = 0;               ///< that share no vertex
  int duplicate_vertices = 0;  ///< at the place of an earlier one, up to 1e-9 of the mean edge
  double volume = 0.0;         ///< [m^3]
  double boundary_area = 0.0;  ///< [m^2]
  Box box;                     ///< [m]
  Range edges;                 ///< lengths [m]
  Range height_ratios;         ///< 1
  Range dihedral_angles;       ///< [degree]
  /// Of height ratios.
  Histogram height_ratio_counts{{1, 1.5, 2, 3, 4, 6, 10, 20, 50, 100}};
  /// Of angles between faces [degree].
  Histogram dihedral_angle_counts{
      {0, 10, 20, 30, 40, 50, 60, 70, 80, 90, 100, 110, 120, 130, 140, 150, 160, 170, 180}};
  std::vector<TetShape> worst;      ///< the ten largest height ratios, worst first
  std::vector<RegionSize> regions;  ///< in the mesh's order
};

/// The shape of one tetrahedron, after its vertices.
TetShape tet_shape(const TetMesh& mesh, int tet);

/// Looks at all of a mesh.
MeshQuality mesh_quality(const TetMesh& mesh);

/// Lengths of the edges, each once. [m]
Range edge_range(const TetMesh& mesh);
Range edge_range(const TriangleSurface& surface);  ///< the same of a surface

}  // namespace plica
