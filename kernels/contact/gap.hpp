// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/functions.hpp>
#include <plica/core/small.hpp>

namespace plica {

/// Distance to a solid [m], positive outside, and the unit normal out of it at the nearest point of its surface.
template <class Real>
struct Gap {
  Real distance;
  Vec3<Real> normal;
};

/// A unit vector across `axis`, itself a unit vector: the direction of d where it has one, any where d is on the axis.
template <class Real>
KOKKOS_INLINE_FUNCTION Vec3<Real> direction_across(const Vec3<Real>& axis, const Vec3<Real>& d, Real length) {
  if (length > 0) return (Real(1) / length) * d;
  Vec3<Real> any;
  any[axis[0] * axis[0] < Real(0.5) ? 0 : 1] = Real(1);
  any -= dot(any, axis) * axis;
  return (Real(1) / sqrt(dot(any, any))) * any;
}

}  // namespace plica
