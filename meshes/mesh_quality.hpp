// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>
#include <string>
#include <vector>

namespace plica {

/// How many values lie in each interval [bounds[i], bounds[i + 1]); the last one takes its end as well.
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

/// A tetrahedron with its shape. The height ratio is the longest edge over the smallest height, sqrt(3/2) = 1.22 at
/// best (regular); an explicit step is about as short as the smallest height allows.
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

/// All that can be told of a mesh before it is simulated.
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
  Histogram dihedral_angle_counts{{0, 10, 20, 30, 40, 50, 60, 70, 80, 90, 100, 110, 120, 130, 140, 150, 160, 170, 180}};
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
