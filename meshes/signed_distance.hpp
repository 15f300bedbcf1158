// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <limits>
#include <memory>
#include <plica/core/mesh.hpp>

namespace plica {

/// The signed distance to a closed surface, exact: to the nearest triangle found in a tree of
/// bounding boxes (Eigen's KdBVH), with the sign of the angle-weighted normal of its nearest face,
/// edge or vertex (Baerentzen & Aanaes, Signed distance computation using the angle weighted
/// pseudonormal, IEEE TVCG 11, 2005).
class SignedDistance {
 public:
  /// Keeps a reference to `surface`: closed, counter-clockwise seen from outside, outliving this.
  explicit SignedDistance(const TriangleSurface& surface);
  explicit SignedDistance(TriangleSurface&&) = delete;
  ~SignedDistance();

  /// [m], below zero inside. `bound`: a distance the point is known to be within, to search less.
  double operator()(const Point& point,
                    double bound = std::numeric_limits<double>::infinity()) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace plica
