// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <plica/core/mesh.hpp>
#include <string>
#include <vector>

namespace plica {

/// Returns the edges of a mesh, each once, lower vertex first, ascending.
std::vector<std::array<int, 2>> mesh_edges(const TetMesh& mesh);
/// Returns the edges of a surface, each once, lower vertex first, ascending.
std::vector<std::array<int, 2>> mesh_edges(const TriangleSurface& surface);

/// Returns per vertex the mean length of the edges that meet there [m]; 0 for a vertex of no
/// tetrahedron.
std::vector<double> local_edge_lengths(const TetMesh& mesh);

/// Returns the mean length of all edges [m]; 0 without any.
double mean_edge_length(const TetMesh& mesh);

/// Returns the mean length of the six edges of one tetrahedron [m].
double mean_edge_length(const TetMesh& mesh, int tet);

/// Returns per vertex the lowest vertex of its part. Parts are connected, and share no vertex.
std::vector<int> parts_of(const TetMesh& mesh);

/// Returns the number of parts of a mesh that share no vertex; vertices of no tetrahedron do not
/// count.
int count_parts(const TetMesh& mesh);
/// Returns the number of parts of a surface that share no vertex; vertices of no triangle do not
/// count.
int count_parts(const TriangleSurface& surface);

/// Returns per point one with a lower number within `tolerance` [m], which is 0 or more; -1: there
/// is none.
std::vector<int> lower_twins(const std::vector<Point>& points, double tolerance);

/// Returns the number of vertices within `tolerance` [m] of one with a lower number. It is above
/// zero for two meshes that were joined without merging their common vertices: such meshes come
/// apart when simulated.
int count_duplicate_vertices(const TetMesh& mesh, double tolerance);

/// Counts of values in the intervals [bounds[i], bounds[i + 1]); the last one includes its end.
struct Histogram {
  std::vector<double> bounds;  ///< ascending, one more than counts
  std::vector<int> counts;     ///< one per interval

  /// Sets all counts to zero.
  explicit Histogram(std::vector<double> interval_bounds);
  /// Counts a value; one beyond the ends counts in the first or last interval.
  void add(double value);
};

/// Smallest, mean and largest of some values; zero for none.
struct Range {
  double min = 0.0;   ///< the smallest
  double mean = 0.0;  ///< the arithmetic mean
  double max = 0.0;   ///< the largest
};

/// Shape of a tetrahedron. The height ratio is the longest edge over the smallest height: at best
/// sqrt(3/2) = 1.22 (regular). The smallest height limits an explicit time step.
struct TetShape {
  int tet = -1;                    ///< number of the tetrahedron
  double volume = 0.0;             ///< [m^3]
  double height_ratio = 0.0;       ///< longest edge over smallest height [1]
  double smallest_angle = 0.0;     ///< smallest angle between two faces [degree]
  double largest_angle = 0.0;      ///< largest angle between two faces [degree]
  Point centroid = Point::Zero();  ///< [m]
};

/// Size of a region.
struct RegionSize {
  std::string name;     ///< empty when the mesh has one nameless region
  int tets = 0;         ///< number of tetrahedra
  double volume = 0.0;  ///< [m^3]
};

/// Sizes and element shapes of a mesh, known before it is simulated.
struct MeshQuality {
  int vertices = 0;            ///< number of vertices
  int tets = 0;                ///< number of tetrahedra
  int boundary_triangles = 0;  ///< number of boundary triangles
  int parts = 0;               ///< number of parts that share no vertex
  int duplicate_vertices = 0;  ///< vertices within 1e-9 of the mean edge of an earlier one
  double volume = 0.0;         ///< [m^3]
  double boundary_area = 0.0;  ///< [m^2]
  Box box;                     ///< bounding box [m]
  Range edges;                 ///< edge lengths [m]
  Range height_ratios;         ///< [1]
  Range dihedral_angles;       ///< angles between faces [degree]
  /// Histogram of height ratios [1]
  Histogram height_ratio_counts{{1, 1.5, 2, 3, 4, 6, 10, 20, 50, 100}};
  /// Histogram of angles between faces [degree]
  Histogram dihedral_angle_counts{
      {0, 10, 20, 30, 40, 50, 60, 70, 80, 90, 100, 110, 120, 130, 140, 150, 160, 170, 180}};
  std::vector<TetShape> worst;      ///< the ten largest height ratios, worst first
  std::vector<RegionSize> regions;  ///< in the mesh's order
};

/// Computes the shape of one tetrahedron.
TetShape tet_shape(const TetMesh& mesh, int tet);

/// Measures sizes and element shapes of a mesh.
MeshQuality mesh_quality(const TetMesh& mesh);

/// Returns the range of the edge lengths of a mesh, each edge counted once [m].
Range edge_range(const TetMesh& mesh);
/// Returns the range of the edge lengths of a surface, each edge counted once [m].
Range edge_range(const TriangleSurface& surface);

}  // namespace plica
