// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <cmath>
#include <plica/core/keys.hpp>
#include <plica/kernels/contact/gap.hpp>

namespace plica {

/// Options of a solid cone with flat ends, or with a tip for one of them.
struct ConeOptions {
  Point from = Point::Zero();  ///< centre of one end [m]
  Point to = Point::UnitZ();   ///< centre of the other end, another point [m]
  double radius = 1;           ///< at from [m]
  double to_radius = 0;        ///< at to, 0: a tip [m]
};

/// Describes the parameters of a cone: name, kind, unit, range and meaning.
template <class V>
void describe(V& v, ConeOptions& o) {
  using namespace keys;
  v.required("from", o.from, Vector{length}, "centre of one end");
  v.required("to", o.to, Vector{length}, "centre of the other end: its tip, where to_radius is 0");
  v.required("radius", o.radius, Quantity{length, positive}, "at from");
  v("to_radius", o.to_radius, Quantity{length, not_negative}, "at to; 0: a tip");
}

/// Cone with flat ends or a tip.
struct Cone {
  /// Name of the shape in scenes
  static constexpr const char* name = "cone";
  /// One line about the shape, for lists
  static constexpr const char* summary = "a cone with a tip or flat ends";
  /// Returns the middle of the axis, about which torques on the obstacle are at t = 0 [m].
  static Point origin(const ConeOptions& o) { return (o.from + o.to) / 2; }
  /// Returns the radius of the narrower end, or if smaller, half of the length [m]. It is 0 for a
  /// cone with a tip. The narrower end fits between points before the rest does.
  static double radius(const ConeOptions& o) {
    return std::min({o.radius, o.to_radius, (o.to - o.from).norm() / 2});
  }
  using Options = ConeOptions;  ///< parameters of the shape

  /// Signed distance to the cone, as kernels evaluate it.
  template <class Real>
  struct Shape {
    static constexpr bool convex = true;  ///< true where the solid is convex
    Vec3<Real> from;                      ///< centre of one end [m]
    Vec3<Real> axis;                      ///< unit vector from this end to the other one
    Real length;                          ///< distance between the ends [m]
    Real radius;                          ///< radius at `from` [m]
    Real to_radius;                       ///< radius at the other end [m]
    Real side;                            ///< length of the side, from rim to rim [m]
    Real widening;  ///< part across the axis of the unit vector along the side; < 0: narrows
    Real rising;    ///< part along the axis of the unit vector along the side

    /// Returns distance and normal at a position in the axes of the shape [m].
    KOKKOS_INLINE_FUNCTION Gap<Real> operator()(const Vec3<Real>& x) const {
      const Vec3<Real> d = x - from;
      const Real along = dot(d, axis);
      const Vec3<Real> across = d - along * axis;
      const Real r = sqrt(dot(across, across)), beside = r - radius;
      const Vec3<Real> outward = direction_across(axis, across, r);
      const bool upper = along > Real(0.5f) * length;  // which end is nearer
      const Real above = upper ? along - length : -along, end = upper ? to_radius : radius;
      const Real up_side = beside * widening + along * rising,
                 out = beside * rising - along * widening;
      if ((above > 0 && r <= end) || (above <= 0 && out <= above))
        return {above, (upper ? Real(1) : Real(-1)) * axis};
      if ((above <= 0 && out <= 0) || (up_side > 0 && up_side < side))
        return {out, rising * outward - widening * axis};
      const Real beyond = up_side > 0 ? r - to_radius : beside,
                 over = up_side > 0 ? along - length : along;
      const Real l = sqrt(beyond * beyond + over * over);  // from the rim or the tip
      return {l, (beyond / l) * outward + (over / l) * axis};
    }
  };

  /// Throws InputError where the two ends are at one place.
  static void check(const std::string& path, const Options& o) { check_apart(path, o.from, o.to); }

  /// Returns the shape with these options, for kernels.
  template <class Real>
  static Shape<Real> shape(const Options& o) {
    const Point along = o.to - o.from;
    const double length = along.norm(), side = std::hypot(length, o.to_radius - o.radius);
    const auto real = [](double value) { return static_cast<Real>(value); };
    return {vec3<Real>(o.from),
            vec3<Real>(along / length),
            real(length),
            real(o.radius),
            real(o.to_radius),
            real(side),
            real((o.to_radius - o.radius) / side),
            real(length / side)};
  }
};

}  // namespace plica
