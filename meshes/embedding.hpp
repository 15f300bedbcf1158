// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <memory>
#include <plica/core/mesh.hpp>
#include <vector>

namespace plica {

/// Weights of the four corners of a tetrahedron; they sum to 1.
using Weights = std::array<double, 4>;

/// Returns the barycentric weights of `p`, negative on the far side of a face.
/// @param p        [m]
/// @param corners  corners of a tetrahedron with positive volume [m]
Weights barycentric(const Point& p, const std::array<Point, 4>& corners);
/// Returns whether x is in a tetrahedron, its faces included.
bool is_in_tetrahedron(const std::array<Point, 4>& corners, const Point& x);

/// Returns the weights of the point of the tetrahedron that is nearest to `p`. They are those of
/// `p` if it is inside; none is below zero. Nearest point of a triangle: C. Ericson, Real-Time
/// Collision Detection (2005), section 5.1.5.
Weights nearest_inside(const Point& p, const std::array<Point, 4>& corners);

/// Returns the weights of the point of a triangle that is nearest to `p`.
std::array<double, 3> nearest_in_triangle(const Point& p, const Point& a, const Point& b,
                                          const Point& c);

/// Returns the point with these weights [m].
Point weighted(const Weights& weights, const std::array<Point, 4>& corners);

/// Returns the corners of one tetrahedron of a mesh [m].
std::array<Point, 4> corners_of(const TetMesh& mesh, int tet);

/// Location of a point in a mesh.
struct Located {
  int tet = -1;           ///< tetrahedron that contains the point, or the nearest one
  Weights weights = {};   ///< barycentric, unclamped: outside some are negative
  double distance = 0.0;  ///< distance to that tetrahedron, 0 inside [m]
};

/// Search for the tetrahedron that contains a point, or the nearest one, in a tree of bounding
/// boxes (Eigen's KdBVH).
///
/// A point counts as inside up to 1e-9 of an edge beyond a face. Several tetrahedra are nearest to
/// a point that faces an edge or a corner. Among them the one with the least extrapolation is
/// chosen, then the one with the lowest number. The choice thus never depends on the tree's order.
/// Where pieces of a mesh share room (TetMesh::piece), a point is in the finest of them.
class TetLocator {
 public:
  /// Keeps a reference to `mesh`, which must have a tetrahedron (InputError) and outlive the
  /// locator.
  explicit TetLocator(const TetMesh& mesh);
  explicit TetLocator(TetMesh&&) = delete;
  ~TetLocator();
  TetLocator(TetLocator&&) noexcept;             ///< moves the tree
  TetLocator& operator=(TetLocator&&) noexcept;  ///< moves the tree

  /// Returns the location of a point; throws an InputError if it is not finite or beyond 1e100 m.
  Located locate(const Point& point) const;

  /// Returns the tetrahedra whose bounding boxes meet a box, ascending.
  std::vector<int> tets_near(const Box& box) const;

  /// Returns the mesh that points are located in.
  const TetMesh& mesh() const { return *mesh_; }

 private:
  struct Tree;
  const TetMesh* mesh_;
  std::unique_ptr<Tree> tree_;
};

/// Treatment of a point outside every tetrahedron.
enum class Outside {
  clamp,        ///< the point moves with the nearest point of the mesh: no weight below zero
  extrapolate,  ///< extrapolation of the nearest tetrahedron, each weight limited to -0.5 or above
  keep          ///< the row has zero weights: the caller leaves the point out
};

/// Points embedded in a mesh: one row per point, value(point) = sum over k of weights[k] *
/// value(vertices[k]).
///
/// Rows sum to 1, except the zero rows of Outside::keep, so translations are exact. Linear fields
/// are exact to rounding inside, and outside where they are extrapolated without a limited weight.
struct Embedding {
  std::vector<std::array<int, 4>> vertices;  ///< vertices of the tetrahedron, also in zero rows
  std::vector<Weights> weights;              ///< weights of these vertices [1]
  std::vector<char> outside;                 ///< 1 for a point outside
  int misses = 0;                            ///< number of points outside
  int held = 0;  ///< number of points with limited weights (extrapolate)
  /// largest distance of a point outside, over the mean edge of its tetrahedron [1]
  double largest_distance_over_edge = 0.0;
};

/// Returns the vertex at the very place of each point; empty: a point is at none, or at several.
std::vector<int> vertices_at(const std::vector<Point>& points, const TetMesh& mesh);

/// Embeds points in the mesh of a locator.
/// @param points   finite [m]; InputError otherwise, with the point's index
/// @param locator  locator of the mesh; build it once when several sets of points are embedded in
/// the same mesh
/// @param outside  treatment of points outside the mesh
Embedding embed(const std::vector<Point>& points, const TetLocator& locator, Outside outside);

/// Embeds points in a mesh, with a locator that is built for this call.
Embedding embed(const std::vector<Point>& points, const TetMesh& mesh, Outside outside);

}  // namespace plica
