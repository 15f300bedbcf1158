// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/contact/gap.hpp>

namespace plica {

/// A block whose flat top is at height `rim` above the lowest point of a sphere hollowed out of it: inside a spherical shell
/// below the rim, the top's plane beside it, and the rim's edge seen from above.
struct Bowl {
  static constexpr const char* name = "bowl";
  static constexpr const char* summary =
      "the inside of a spherical shell up to its rim: centre, radius, rim (height above the lowest point)";
  template <class Real>
  struct Shape {
    Vec3<Real> centre;
    Real radius;
    Real top;  ///< of the rim's plane above the centre, rim - radius <= 0

    KOKKOS_INLINE_FUNCTION Gap<Real> operator()(const Vec3<Real>& x) const {
      const Vec3<Real> d = x - centre;
      const Real r = sqrt(dot(d, d)), inside = radius - r, above = d[2] - top;
      const Real opening = sqrt(max(radius * radius - top * top, Real(0))), across = sqrt(d[0] * d[0] + d[1] * d[1]);
      // nearest to the rim's circle: above the plane over the solid's side of the opening's cone
      if (above > 0 && across < opening && across * (-top) > -d[2] * opening) {
        const Real o = across - opening, l = sqrt(o * o + above * above);
        if (!(across > 0)) return {l, {o / l, Real(0), above / l}};  // on the axis, from any point of the circle
        const Real s = o / (across * l);
        return {l, {s * d[0], s * d[1], above / l}};
      }
      if (inside >= above && !(r > 0)) return {radius, {Real(0), Real(0), Real(1)}};  // the centre
      if (inside > above) return {inside, (Real(-1) / r) * d};
      return {above, {Real(0), Real(0), Real(1)}};
    }
  };
};

}  // namespace plica
