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
  /// Name of the shape in scenes
  static constexpr const char* name = "capsule";
  /// One line about the shape, for lists
  static constexpr const char* summary = "a cylinder with round ends";
  /// Returns the middle, about which torques on the obstacle are at t = 0 [m].
  static Point origin(const CapsuleOptions& o) { return (o.from + o.to) / 2; }
  /// Returns the radius of the largest ball in the capsule [m].
  static double radius(const CapsuleOptions& o) { return o.radius; }
  using Options = CapsuleOptions;  ///< parameters of the shape

  /// Signed distance to the capsule, as kernels evaluate it.
  template <class Real>
  struct Shape {
    static constexpr bool convex = true;  ///< true where the solid is convex
    Vec3<Real> from;                      ///< end of the middle line at which `axis` begins [m]
    Vec3<Real> axis;                      ///< unit vector from this end to the other one
    Real length;                          ///< length of the middle line [m]
    Real radius;                          ///< [m]

    /// Returns distance and normal at a position in the axes of the shape [m].
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

  /// Throws InputError where the two ends are at one place.
  static void check(const std::string& path, const Options& o) { check_apart(path, o.from, o.to); }

  /// Returns the shape with these options, for kernels.
  template <class Real>
  static Shape<Real> shape(const Options& o) {
    const Point along = o.to - o.from;
    return {vec3<Real>(o.from), vec3<Real>(along.normalized()), static_cast<Real>(along.norm()),
            static_cast<Real>(o.radius)};
  }
};

}  // namespace plica
