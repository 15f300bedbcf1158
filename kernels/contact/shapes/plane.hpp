// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <limits>
#include <plica/core/keys.hpp>
#include <plica/kernels/contact/gap.hpp>

namespace plica {

/// Options of a plane: the half-space below it is solid.
struct PlaneOptions {
  Point point = Point::Zero();    ///< point on the plane [m]
  Point normal = Point::UnitZ();  ///< out of the solid; its length does not matter
};

/// Describes the parameters of a plane: name, kind, unit, range and meaning.
template <class V>
void describe(V& v, PlaneOptions& o) {
  using namespace keys;
  v("point", o.point, Vector{length}, "on the plane");
  v("normal", o.normal, Direction{}, "out of the solid; its length does not matter");
}

/// Solid half-space below a plane through `point` with unit normal `normal`.
struct Plane {
  /// Name of the shape in scenes
  static constexpr const char* name = "plane";
  /// One line about the shape, for lists
  static constexpr const char* summary = "the half-space below a plane";
  /// Returns the point on the plane, about which torques on the obstacle are at t = 0 [m].
  static Point origin(const PlaneOptions& o) { return o.point; }
  /// Returns infinity: the half-space has no end.
  static double radius(const PlaneOptions&) { return std::numeric_limits<double>::infinity(); }
  using Options = PlaneOptions;  ///< parameters of the shape

  /// Signed distance to the half-space, as kernels evaluate it.
  template <class Real>
  struct Shape {
    static constexpr bool convex = true;  ///< true where the solid is convex
    Vec3<Real> point;                     ///< point on the plane [m]
    Vec3<Real> normal;                    ///< unit normal out of the solid

    /// Returns distance and normal at a position in the axes of the shape [m].
    KOKKOS_INLINE_FUNCTION Gap<Real> operator()(const Vec3<Real>& x) const {
      return {dot(normal, x - point), normal};
    }
  };

  /// Returns the shape with these options, for kernels.
  template <class Real>
  static Shape<Real> shape(const Options& o) {
    return {vec3<Real>(o.point), vec3<Real>(o.normal.normalized())};
  }
};

}  // namespace plica
