// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/contact/point_laws.hpp>

namespace plica {

/// Surface points that obstacles hold: each by a spring and a damper to where it was, relative to the obstacle, when that closed. A
/// record for every obstacle and point, numbered as those of contact.
template <class B>
struct HeldPoints {
  using Real = typename B::Real;
  static constexpr int numbers = 4;  ///< of a record: that place [m], and 1 where the point is held

  int records = 0;    ///< 0: no obstacle can hold anything, no arrays
  Doubles<B> memory;  ///< of the obstacles; these numbers begin with its number `first`
  int first = 0;
  Indices<B> left_out;  ///< [records] 1: of a point that its obstacle never holds; empty: none
  PointLaws<B> law;     ///< stiffness and damping, in all directions

  KOKKOS_INLINE_FUNCTION int at(int r) const { return first + numbers * r; }
  KOKKOS_INLINE_FUNCTION bool holds(int r) const { return r < records && memory(at(r) + 3) > 0; }
  KOKKOS_INLINE_FUNCTION bool may_hold(int r) const { return left_out.extent(0) == 0 || left_out(r) == 0; }
  KOKKOS_INLINE_FUNCTION void hold(int r, const Vec3<Real>& x, const Vec3<double>& moved) const {
    for (int k = 0; k < 3; ++k) memory(at(r) + k) = static_cast<double>(x[k]) - moved[k];
    memory(at(r) + 3) = 1;
  }
  KOKKOS_INLINE_FUNCTION void release(int r) const { memory(at(r) + 3) = 0; }
  /// How far a point at x is from where an obstacle that has moved so holds it [m].
  KOKKOS_INLINE_FUNCTION Vec3<Real> stretch(int r, const Vec3<Real>& x, const Vec3<double>& moved) const {
    Vec3<Real> s;
    for (int k = 0; k < 3; ++k) s[k] = static_cast<Real>(static_cast<double>(x[k]) - moved[k] - memory(at(r) + k));
    return s;
  }
};

}  // namespace plica
