// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <plica/core/keys.hpp>
#include <plica/kernels/contact/gap.hpp>

namespace plica {

/// Options of a solid cylinder with flat ends.
struct CylinderOptions {
  Point from = Point::Zero();  ///< centre of one end [m]
  Point to = Point::UnitZ();   ///< centre of the other end, another point [m]
  double radius = 1;           ///< [m]
};

/// Describes the parameters of a cylinder: name, kind, unit, range and meaning.
template <class V>
void describe(V& v, CylinderOptions& o) {
  using namespace keys;
  v.required("from", o.from, Vector{length}, "centre of one end");
  v.required("to", o.to, Vector{length}, "centre of the other end");
  v.required("radius", o.radius, Quantity{length, positive}, "radius");
}

/// Cylinder with flat ends.
struct Cylinder {
  /// Name of the shape in scenes
  static constexpr const char* name = "cylinder";
  /// One line about the shape, for lists
  static constexpr const char* summary = "a cylinder with flat ends";
  /// Returns the centre, about which torques on the obstacle are at t = 0 [m].
  static Point origin(const CylinderOptions& o) { return (o.from + o.to) / 2; }
  /// Returns the radius of the largest ball in the cylinder [m].
  static double radius(const CylinderOptions& o) {
    return std::min(o.radius, (o.to - o.from).norm() / 2);
  }
  using Options = CylinderOptions;  ///< parameters of the shape

  /// Signed distance to the cylinder, as kernels evaluate it.
  template <class Real>
  struct Shape {
    static constexpr bool convex = true;  ///< true where the solid is convex
    Vec3<Real> centre;                    ///< [m]
    Vec3<Real> axis;                      ///< unit vector from one end to the other
    Real half;                            ///< half of the length [m]
    Real radius;                          ///< [m]

    /// Returns distance and normal at a position in the axes of the shape [m].
    KOKKOS_INLINE_FUNCTION Gap<Real> operator()(const Vec3<Real>& x) const {
      const Vec3<Real> d = x - centre;
      const Real along = dot(d, axis);
      const Vec3<Real> across = d - along * axis;
      const Real r = sqrt(dot(across, across));
      const Vec3<Real> outward = direction_across(axis, across, r),
                       up = (along < 0 ? Real(-1) : Real(1)) * axis;
      const Real beside = r - radius, above = (along < 0 ? -along : along) - half;
      if (beside > 0 && above > 0) {  // nearest to the rim
        const Real l = sqrt(beside * beside + above * above);
        return {l, (beside / l) * outward + (above / l) * up};
      }
      if (beside > above) return {beside, outward};
      return {above, up};
    }
  };

  /// Throws InputError where the two ends are at one place.
  static void check(const std::string& path, const Options& o) { check_apart(path, o.from, o.to); }

  /// Returns the shape with these options, for kernels.
  template <class Real>
  static Shape<Real> shape(const Options& o) {
    const Point along = o.to - o.from;
    return {vec3<Real>((o.from + o.to) / 2), vec3<Real>(along.normalized()),
            static_cast<Real>(along.norm() / 2), static_cast<Real>(o.radius)};
  }
};

}  // namespace plica
