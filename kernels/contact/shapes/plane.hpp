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
  static constexpr const char* name = "plane";
  static constexpr const char* summary = "the half-space below a plane";
  static Point origin(const PlaneOptions& o) { return o.point; }
  static double radius(const PlaneOptions&) { return std::numeric_limits<double>::infinity(); }
  using Options = PlaneOptions;
  template <class Real>
  struct Shape {
    static constexpr bool convex = true;
    Vec3<Real> point, normal;
    KOKKOS_INLINE_FUNCTION Gap<Real> operator()(const Vec3<Real>& x) const {
      return {dot(normal, x - point), normal};
    }
  };

  template <class Real>
  static Shape<Real> shape(const Options& o) {
    return {vec3<Real>(o.point), vec3<Real>(o.normal.normalized())};
  }
};

}  // namespace plica
