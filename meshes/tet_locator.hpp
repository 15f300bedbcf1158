// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <memory>
#include <plica/core/mesh.hpp>
#include <plica/meshes/barycentric.hpp>

namespace plica {

/// Where a point is in a mesh.
struct Located {
  int tet = -1;           ///< that contains it, or the nearest one
  Weights weights = {};   ///< barycentric, unclamped: outside some are negative
  double distance = 0.0;  ///< to that tetrahedron, 0 inside [m]
};

/// Finds the tetrahedron that contains a point, or the nearest one, by a tree of bounding boxes (Eigen's KdBVH).
///
/// A point counts as inside up to 1e-9 of an edge beyond a face. Of several nearest tetrahedra (a point that faces an
/// edge or a corner) it takes the one that is extrapolated least, then the first: never a matter of the tree's order.
class TetLocator {
 public:
  /// Keeps a reference to `mesh`, which must have a tetrahedron (InputError) and outlive the locator.
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

}  // namespace plica
