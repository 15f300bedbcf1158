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
  Indices<B> from, part;       ///< [points + 1] into the parts of pairs that each point has as a corner, ascending
  Vectors<B> sum;              ///< [points][3] all forces on each point, also of faces without pairs [N]

  /// Of a field, the triangle's value that point p is near.
  KOKKOS_INLINE_FUNCTION Vec3<Real> across(const EmbeddedSurface<B>& surface, const Vectors<B>& x, int p) const {
    Vec3<Real> value;
    for (int c = 0; c < 3; ++c) value += weight(p, c) * value_at<B>(surface.embedding, x, corner(3 * partner(p) + c));
    return value;
  }
  /// The c-th corner of the triangle that p is near, where it has a weight; else -1.
  KOKKOS_INLINE_FUNCTION int corner_of(int p, int c) const {
    return partner(p) >= 0 && weight(p, c) != 0 ? corner(3 * partner(p) + c) : -1;
  }
  /// use(point, weight) for all pairs in whose triangle point q has a weight, always in the same order.
  template <class Use>
  KOKKOS_INLINE_FUNCTION void each_pair_at(int q, const Use& use) const {
    for (int i = from(q); i < from(q + 1); ++i) use(part(i) / 3, weight(part(i) / 3, part(i) % 3));
  }
};

}  // namespace plica
