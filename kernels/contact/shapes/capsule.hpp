// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/keys.hpp>
#include <plica/kernels/contact/gap.hpp>

namespace plica {

/// Options of a capsule: all points within the radius of the straight line between two points, its
/// ends round.
struct CapsuleOptions {
  Point from = Point::Zero();  ///< [m]
  Point to = Point::UnitZ();   ///< another point [m]
  double radius = 1;           ///< [m]
};

/// Describes the parameters of a capsule: name, kind, unit, range and meaning.
template <class V>
void describe(V& v, CapsuleOptions& o) {
  using namespace keys;
  v.required("from", o.from, Vector{length}, "one end of its middle line");
  v.required("to", o.to, Vector{length}, "the other end");
  v.required("radius", o.radius, Quantity{length, positive}, "around the line and its ends");
}

/// Capsule: all points within `radius` of a straight line with two ends.
struct Capsule {
  static constexpr const char* name = "capsule";
  static constexpr const char* summary = "a cylinder with round ends";
  static Point origin(const CapsuleOptions& o) { return (o.from + o.to) / 2; }
  static double radius(const CapsuleOptions& o) { return o.radius; }
  using Options = CapsuleOptions;
  template <class Real>
  struct Shape {
    static constexpr bool convex = true;
    Vec3<Real> from, axis;  ///< axis: a unit vector
    Real length, radius;

    KOKKOS_INLINE_FUNCTION Gap<Real> operator()(const Vec3<Real>& x) const {
      const Vec3<Real> d = x - from;
      const Real along = dot(d, axis), on_line = along < 0        ? Real(0)
                                                 : along > length ? length
                                                                  : along;
      const Vec3<Real> across = d - on_line * axis;
      const Real r = sqrt(dot(across, across));
      return {r - radius, direction_across(axis, across, r)};
    }
  };

  static void check(const std::string& path, const Options& o) { check_apart(path, o.from, o.to); }

  template <class Real>
  static Shape<Real> shape(const Options& o) {
    const Point along = o.to - o.from;
    return {vec3<Real>(o.from), vec3<Real>(along.normalized()), static_cast<Real>(along.norm()),
            static_cast<Real>(o.radius)};
  }
};

}  // namespace plica
