// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <limits>
#include <plica/core/error.hpp>
#include <plica/core/keys.hpp>
#include <plica/kernels/contact/gap.hpp>

namespace plica {

/// Options of a bowl: a block with flat top out of which a sphere is hollowed. It is the inside of
/// a spherical shell, up to its rim.
struct BowlOptions {
  Point centre = Point::Zero();  ///< centre of the sphere [m]
  double radius = 1;             ///< [m]
  /// Height of the flat top above the bowl's lowest point, at most the radius; 0: radius [m]
  double rim = 0;
};

/// Describes the parameters of a bowl: name, kind, unit, range and meaning.
template <class V>
void describe(V& v, BowlOptions& o) {
  using namespace keys;
  v("centre", o.centre, Vector{length}, "of the sphere");
  v.required("radius", o.radius, Quantity{length, positive}, "of the sphere");
  v("rim", o.rim, Quantity{length, not_negative},
    "height of the rim above the lowest point; 0: the radius");
}

/// Block whose flat top is at height `rim` above the lowest point of a sphere hollowed out of it.
/// The nearest point is on the spherical shell below the rim, on the top's plane beside it, or,
/// seen from above, on the rim's edge.
struct Bowl {
  /// Name of the shape in scenes
  static constexpr const char* name = "bowl";
  /// One line about the shape, for lists
  static constexpr const char* summary = "the inside of a spherical shell, up to a rim";
  /// Returns the centre of the sphere, about which torques on the obstacle are at t = 0 [m].
  static Point origin(const BowlOptions& o) { return o.centre; }
  /// Returns infinity: the block around the hollow has no end.
  static double radius(const BowlOptions&) { return std::numeric_limits<double>::infinity(); }
  using Options = BowlOptions;  ///< parameters of the shape

  /// Signed distance to the bowl, as kernels evaluate it.
  template <class Real>
  struct Shape {
    static constexpr bool convex = false;  ///< true where the solid is convex
    Vec3<Real> centre;                     ///< centre of the sphere [m]
    Real radius;                           ///< radius of the sphere [m]
    Real top;  ///< height of the rim's plane above the centre, rim - radius <= 0 [m]

    /// Returns distance and normal at a position in the axes of the shape [m].
    KOKKOS_INLINE_FUNCTION Gap<Real> operator()(const Vec3<Real>& x) const {
      const Vec3<Real> d = x - centre;
      const Real r = sqrt(dot(d, d)), inside = radius - r, above = d[2] - top;
      const Real opening = sqrt(max(radius * radius - top * top, Real(0))),
                 across = sqrt(d[0] * d[0] + d[1] * d[1]);
      // nearest to the rim's circle: above the plane over the solid's side of the opening's cone
      if (above > 0 && across < opening && across * (-top) > -d[2] * opening) {
        const Real o = across - opening, l = sqrt(o * o + above * above);
        // on the axis, from any point of the circle
        if (!(across > 0)) return {l, {o / l, Real(0), above / l}};
        const Real s = o / (across * l);
        return {l, {s * d[0], s * d[1], above / l}};
      }
      if (inside >= above && !(r > 0)) return {radius, {Real(0), Real(0), Real(1)}};  // the centre
      if (inside > above) return {inside, (Real(-1) / r) * d};
      return {above, {Real(0), Real(0), Real(1)}};
    }
  };

  /// Returns the options with a rim of 0 replaced by the radius.
  static Options complete(Options o) {
    if (!(o.rim > 0)) o.rim = o.radius;
    return o;
  }

  /// Throws InputError where the rim is higher than the radius.
  static void check(const std::string& path, const Options& o) {
    if (o.rim > o.radius)
      throw InputError(path + ".rim is " + keys::Quantity{keys::length}.to_text(o.rim) +
                       "; expected at most the radius, " +
                       keys::Quantity{keys::length}.to_text(o.radius));
  }

  /// Returns the shape with these options, for kernels.
  template <class Real>
  static Shape<Real> shape(const Options& o) {
    return {vec3<Real>(o.centre), static_cast<Real>(o.radius), static_cast<Real>(o.rim - o.radius)};
  }
};

}  // namespace plica
