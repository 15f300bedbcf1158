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
  /// Name of the shape in scenes
  static constexpr const char* name = "sphere";
  /// One line about the shape, for lists
  static constexpr const char* summary = "a solid sphere";
  /// Returns the centre, about which torques on the obstacle are at t = 0 [m].
  static Point origin(const SphereOptions& o) { return o.centre; }
  /// Returns the radius [m].
  static double radius(const SphereOptions& o) { return o.radius; }
  using Options = SphereOptions;  ///< parameters of the shape

  /// Signed distance to the sphere, as kernels evaluate it.
  template <class Real>
  struct Shape {
    static constexpr bool convex = true;  ///< true where the solid is convex
    Vec3<Real> centre;                    ///< [m]
    Real radius;                          ///< [m]

    /// Returns distance and normal at a position in the axes of the shape [m].
    KOKKOS_INLINE_FUNCTION Gap<Real> operator()(const Vec3<Real>& x) const {
      const Vec3<Real> d = x - centre;
      const Real r = sqrt(dot(d, d));
      if (!(r > 0)) return {-radius, {Real(0), Real(0), Real(1)}};
      return {r - radius, (Real(1) / r) * d};
    }
  };

  /// Returns the shape with these options, for kernels.
  template <class Real>
  static Shape<Real> shape(const Options& o) {
    return {vec3<Real>(o.centre), static_cast<Real>(o.radius)};
  }
};

}  // namespace plica
