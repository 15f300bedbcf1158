// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <memory>
#include <plica/core/mesh.hpp>
#include <vector>

namespace plica {

/// Weights of the four corners of a tetrahedron; they sum to 1.
using Weights = std::array<double, 4>;

/// The weights that make up `p`, negative on the far side of a face.
/// @param p        [m]
/// @param corners  of a tetrahedron with positive volume [m]
Weights barycentric(const Point& p, const std::array<Point, 4>& corners);
/// Whether x is in a tetrahedron, its faces included.
bool is_in_tetrahedron(const std::array<Point, 4>& corners, const Point& x);

/// The weights of the point of the tetrahedron that is nearest to `p`, none below zero; those of
/// `p` when it is inside. A triangle's nearest point after C. Ericson, Real-Time Collision
/// Detection (2005), section 5.1.5.
Weights nearest_inside(const Point& p, const std::array<Point, 4>& corners);

/// The point with these weights. [m]
Point weighted(const Weights& weights, const std::array<Point, 4>& corners);

/// The corners of one tetrahedron of a mesh. [m]
std::array<Point, 4> corners_of(const TetMesh& mesh, int tet);

/// Where a point is in a mesh.
struct Located {
  int tet = -1;           ///< that contains it, or the nearest one
  Weights weights = {};   ///< barycentric, unclamped: outside some are negative
  double distance = 0.0;  ///< to that tetrahedron, 0 inside [m]
};

/// Finds the tetrahedron that contains a point, or the nearest one, by a tree of bounding boxes
/// (Eigen's KdBVH).
///
/// A point counts as inside up to 1e-9 of an edge beyond a face. Of several nearest tetrahedra (a
/// point that faces an edge or a corner) it takes the one that is extrapolated least, then the
/// first: never a matter of the tree's order.
class TetLocator {
 public:
  /// Keeps a reference to `mesh`, which must have a tetrahedron (InputError) and outlive the
  /// locator.
  explicit TetLocator(const TetMesh& mesh);
  explicit TetLocator(TetMesh&&) = delete;
  ~TetLocator();
  TetLocator(TetLocator&&) noexcept;             ///< takes over the tree
  TetLocator& operator=(TetLocator&&) noexcept;  ///< likewise

  /// InputError for a point that is not finite, or beyond 1e100 m.
  Located locate(const Point& point) const;

  /// The mesh it was made for.
  const TetMesh& mesh() const { return *mesh_; }

 private:
  struct Tree;
  const TetMesh* mesh_;
  std::unique_ptr<Tree> tree_;
};

/// What becomes of a point outside every tetrahedron.
enum class Outside {
  clamp,        ///< it moves with the nearest point of the mesh: no weight below zero
  extrapolate,  ///< it continues the nearest tetrahedron, each weight held at -0.5 or above
  keep          ///< it has no counterpart: a row of zero weights, for the caller to leave out
};

/// Points embedded in a mesh: one row per point, value(point) = sum over k of weights[k] *
/// value(vertices[k]).
///
/// Rows sum to 1 (but kept ones), so translations are exact; linear fields are exact inside to
/// rounding and, unless a weight was held, where extrapolated.
struct Embedding {
  std::vector<std::array<int, 4>> vertices;  ///< of the tetrahedron, also in kept rows
  std::vector<Weights> weights;              ///< of these vertices
  std::vector<char> outside;                 ///< 1 for a miss
  int misses = 0;                            ///< points outside
  int held = 0;                              ///< misses whose weights were held back (extrapolate)
  /// of a miss to the mesh, over the mean edge of its tetrahedron
  double largest_distance_over_edge = 0.0;
};

/// @param points   finite [m]; InputError otherwise, with the point's index
/// @param locator  of the mesh; build it once when several sets of points are embedded in the same
/// mesh
/// @param outside  what becomes of points outside it
Embedding embed(const std::vector<Point>& points, const TetLocator& locator, Outside outside);

/// The same with a locator of its own.
Embedding embed(const std::vector<Point>& points, const TetMesh& mesh, Outside outside);

}  // namespace plica
