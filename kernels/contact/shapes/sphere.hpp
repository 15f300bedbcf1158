// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/keys.hpp>
#include <plica/kernels/contact/gap.hpp>

namespace plica {

/// Options of a solid sphere.
struct SphereOptions {
  Point centre = Point::Zero();  ///< [m]
  double radius = 1;             ///< [m]
};

/// Describes the parameters of a sphere: name, kind, unit, range and meaning.
template <class V>
void describe(V& v, SphereOptions& o) {
  using namespace keys;
  v("centre", o.centre, Vector{length}, "centre");
  v.required("radius", o.radius, Quantity{length, positive}, "radius");
}

/// Solid sphere.
struct Sphere {
  static constexpr const char* name = "sphere";
  static constexpr const char* summary = "a solid sphere";
  static Point origin(const SphereOptions& o) { return o.centre; }
  static double radius(const SphereOptions& o) { return o.radius; }
  using Options = SphereOptions;
  template <class Real>
  struct Shape {
    static constexpr bool convex = true;
    Vec3<Real> centre;
    Real radius;
    KOKKOS_INLINE_FUNCTION Gap<Real> operator()(const Vec3<Real>& x) const {
      const Vec3<Real> d = x - centre;
      const Real r = sqrt(dot(d, d));
      if (!(r > 0)) return {-radius, {Real(0), Real(0), Real(1)}};
      return {r - radius, (Real(1) / r) * d};
    }
  };

  template <class Real>
  static Shape<Real> shape(const Options& o) {
    return {vec3<Real>(o.centre), static_cast<Real>(o.radius)};
  }
};

}  // namespace plica
