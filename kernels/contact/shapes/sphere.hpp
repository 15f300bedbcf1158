// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/contact/gap.hpp>

namespace plica {

/// A solid sphere.
struct Sphere {
  static constexpr const char* name = "sphere";
  static constexpr const char* summary = "a solid sphere: centre, radius";
  template <class Real>
  struct Shape {
    Vec3<Real> centre;
    Real radius;
    KOKKOS_INLINE_FUNCTION Gap<Real> operator()(const Vec3<Real>& x) const {
      const Vec3<Real> d = x - centre;
      const Real r = sqrt(dot(d, d));
      if (!(r > 0)) return {-radius, {Real(0), Real(0), Real(1)}};
      return {r - radius, (Real(1) / r) * d};
    }
  };
};

}  // namespace plica
