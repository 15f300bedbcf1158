// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/contact/gap.hpp>

namespace plica {

/// A cylinder with flat ends.
struct Cylinder {
  static constexpr const char* name = "cylinder";
  static constexpr const char* summary = "a cylinder with flat ends: from, to, radius";
  template <class Real>
  struct Shape {
    Vec3<Real> centre, axis;  ///< axis: a unit vector
    Real half, radius;        ///< half: of the length

    KOKKOS_INLINE_FUNCTION Gap<Real> operator()(const Vec3<Real>& x) const {
      const Vec3<Real> d = x - centre;
      const Real along = dot(d, axis);
      const Vec3<Real> across = d - along * axis;
      const Real r = sqrt(dot(across, across));
      const Vec3<Real> outward = direction_across(axis, across, r), up = (along < 0 ? Real(-1) : Real(1)) * axis;
      const Real beside = r - radius, above = (along < 0 ? -along : along) - half;
      if (beside > 0 && above > 0) {  // nearest to the rim
        const Real l = sqrt(beside * beside + above * above);
        return {l, (beside / l) * outward + (above / l) * up};
      }
      if (beside > above) return {beside, outward};
      return {above, up};
    }
  };
};

}  // namespace plica
