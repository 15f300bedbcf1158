// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/surface.hpp>
#include <plica/kernels/vectors.hpp>

namespace plica {

/// Where obstacles touch a surface between its points: on every triangle one site for each obstacle, where the triangle is deepest.
template <class B>
struct FaceSites {
  using Real = typename B::Real;
  int triangles = 0;           ///< 0: obstacles touch points alone, no arrays
  Real reach = 0;              ///< a triangle further than that outside an obstacle is not looked at [m]
  Indices<B> corner;           ///< [triangles * 3] points, counter-clockwise seen from outside
  Indices<B> first, triangle;  ///< [points + 1] into the triangles around each point
  Vectors<B> weight;           ///< [obstacles * triangles][3] of the corners, at the site

  KOKKOS_INLINE_FUNCTION int site(int obstacle, int t) const { return obstacle * triangles + t; }
  /// What a field has at a site.
  KOKKOS_INLINE_FUNCTION Vec3<Real> value(const EmbeddedSurface<B>& surface, const Vectors<B>& x, int obstacle,
                                          int t) const {
    Vec3<Real> sum;
    for (int c = 0; c < 3; ++c)
      sum += weight(site(obstacle, t), c) * value_at<B>(surface.embedding, x, corner(3 * t + c));
    return sum;
  }
  /// The part that point q, a corner of t, has of a site.
  KOKKOS_INLINE_FUNCTION Real weight_of(int obstacle, int t, int q) const {
    for (int c = 0; c < 3; ++c)
      if (corner(3 * t + c) == q) return weight(site(obstacle, t), c);
    return 0;
  }
};

}  // namespace plica
