// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <limits>
#include <memory>
#include <plica/core/mesh.hpp>

namespace plica {

/// Exact signed distance to a closed surface. The nearest triangle is found in a tree of bounding
/// boxes (Eigen's KdBVH). The sign comes from the angle-weighted normal of the nearest face, edge
/// or vertex (Baerentzen & Aanaes, Signed distance computation using the angle weighted
/// pseudonormal, IEEE TVCG 11, 2005).
class SignedDistance {
 public:
  /// Keeps a reference to `surface`, which must outlive this. It is closed, and its triangles are
  /// counter-clockwise seen from outside.
  explicit SignedDistance(const TriangleSurface& surface);
  explicit SignedDistance(TriangleSurface&&) = delete;
  ~SignedDistance();

  /// Returns the signed distance of a point [m], below zero inside; NaN for a point that is not
  /// finite.
  /// @param bound  known upper bound of the unsigned distance, for a shorter search [m]
  double operator()(const Point& point,
                    double bound = std::numeric_limits<double>::infinity()) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace plica
