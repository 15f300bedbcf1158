// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/contact/gap.hpp>

namespace plica {

/// All points within `radius` of a straight line with two ends.
struct Capsule {
  static constexpr const char* name = "capsule";
  static constexpr const char* summary = "a cylinder with round ends: from, to, radius";
  template <class Real>
  struct Shape {
    Vec3<Real> from, axis;  ///< axis: a unit vector
    Real length, radius;

    KOKKOS_INLINE_FUNCTION Gap<Real> operator()(const Vec3<Real>& x) const {
      const Vec3<Real> d = x - from;
      const Real along = dot(d, axis), on_line = along < 0 ? Real(0) : along > length ? length : along;
      const Vec3<Real> across = d - on_line * axis;
      const Real r = sqrt(dot(across, across));
      return {r - radius, direction_across(axis, across, r)};
    }
  };
};

}  // namespace plica
