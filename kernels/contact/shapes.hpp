// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/functions.hpp>
#include <plica/core/small.hpp>
#include <plica/core/type_list.hpp>

// Obstacles: pointwise signed distance functions [m], positive outside the solid, with the outward unit normal. Positions are
// relative to the obstacle, which may move.
namespace plica {

template <class Real>
struct Gap {
  Real distance;
  Vec3<Real> normal;
};

/// The solid below a plane through `point` with unit normal `normal`.
struct Plane {
  static constexpr const char* name = "plane";
  static constexpr const char* summary = "the half-space below a plane: point, normal";
  template <class Real>
  struct Shape {
    Vec3<Real> point, normal;
    KOKKOS_INLINE_FUNCTION Gap<Real> operator()(const Vec3<Real>& x) const { return {dot(normal, x - point), normal}; }
  };
};

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

/// A block whose flat top is at height `rim` above the lowest point of a sphere hollowed out of it: inside a spherical shell
/// below the rim, the top's plane beside it, and the rim's edge seen from above.
struct Bowl {
  static constexpr const char* name = "bowl";
  static constexpr const char* summary =
      "the inside of a spherical shell up to its rim: centre, radius, rim (height above the lowest point)";
  template <class Real>
  struct Shape {
    Vec3<Real> centre;
    Real radius;
    Real top;  ///< of the rim's plane above the centre, rim - radius <= 0

    KOKKOS_INLINE_FUNCTION Gap<Real> operator()(const Vec3<Real>& x) const {
      const Vec3<Real> d = x - centre;
      const Real r = sqrt(dot(d, d)), inside = radius - r, above = d[2] - top;
      const Real opening = sqrt(max(radius * radius - top * top, Real(0))), across = sqrt(d[0] * d[0] + d[1] * d[1]);
      // nearest to the rim's circle: above the plane over the solid's side of the opening's cone
      if (above > 0 && across < opening && across * (-top) > -d[2] * opening) {
        const Real o = across - opening, l = sqrt(o * o + above * above);
        if (!(across > 0)) return {l, {o / l, Real(0), above / l}};  // on the axis, from any point of the circle
        const Real s = o / (across * l);
        return {l, {s * d[0], s * d[1], above / l}};
      }
      if (inside >= above && !(r > 0)) return {radius, {Real(0), Real(0), Real(1)}};  // the centre
      if (inside > above) return {inside, (Real(-1) / r) * d};
      return {above, {Real(0), Real(0), Real(1)}};
    }
  };
};

/// Every obstacle shape there is. One more: its struct above, its name here.
using ObstacleShapes = TypeList<Plane, Sphere, Bowl>;

}  // namespace plica
