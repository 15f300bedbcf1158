// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/surface.hpp>
#include <plica/kernels/vectors.hpp>

namespace plica {

/// Which of a surface's triangles each of its points is near. A pair is a point and a triangle, of another body or far from the point
/// on its own.
template <class B>
struct PairedPoints {
  using Real = typename B::Real;
  int triangles = 0;           ///< 0: no pairs, no arrays
  Indices<B> corner;           ///< [triangles * 3] points, counter-clockwise seen from outside
  Indices<B> first, triangle;  ///< [points + 1] into the triangles around each point
  Indices<B> partner;          ///< [points] the triangle it is near; -1: none
  Vectors<B> weight;           ///< [points][3] of that one's corners, where it is nearest
  Indices<B> from, point;      ///< [triangles + 1] into the points near each triangle, ascending
  Vectors<B> sum;              ///< [points][3] all forces on each point, also of faces without pairs [N]

  /// Of a field, the triangle's value that point p is near.
  KOKKOS_INLINE_FUNCTION Vec3<Real> across(const EmbeddedSurface<B>& surface, const Vectors<B>& x, int p) const {
    Vec3<Real> value;
    for (int c = 0; c < 3; ++c) value += weight(p, c) * value_at<B>(surface.embedding, x, corner(3 * partner(p) + c));
    return value;
  }
  /// The part of p's pair that corner q of its triangle t has.
  KOKKOS_INLINE_FUNCTION Real weight_of(int p, int t, int q) const {
    for (int c = 0; c < 3; ++c)
      if (corner(3 * t + c) == q) return weight(p, c);
    return 0;
  }
};

}  // namespace plica
