// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/error.hpp>
#include <plica/core/functions.hpp>
#include <plica/core/mesh.hpp>
#include <plica/core/small.hpp>

namespace plica {

/// Distance to a solid [m], positive outside, and the unit normal out of it. The normal is at the
/// nearest point of the solid's surface.
template <class Real>
struct Gap {
  Real distance;
  Vec3<Real> normal;
};

/// Returns a unit vector across `axis`, itself a unit vector. It has the direction of d where d has
/// one, any direction where d is on the axis. `length` is |d|.
template <class Real>
KOKKOS_INLINE_FUNCTION Vec3<Real> direction_across(const Vec3<Real>& axis, const Vec3<Real>& d,
                                                   Real length) {
  if (length > 0) return (Real(1) / length) * d;
  Vec3<Real> any;
  any[axis[0] * axis[0] < Real(0.5) ? 0 : 1] = Real(1);
  any -= dot(any, axis) * axis;
  return (Real(1) / sqrt(dot(any, any))) * any;
}

/// Converts a point of the host's geometry for a kernel.
template <class Real>
Vec3<Real> vec3(const Point& p) {
  return {static_cast<Real>(p[0]), static_cast<Real>(p[1]), static_cast<Real>(p[2])};
}

/// Throws InputError where the two points of a shape are one.
inline void check_apart(const std::string& path, const Point& from, const Point& to) {
  if (!((to - from).norm() > 0))
    throw InputError(path + ".to, as a distance from .from, is 0; expected a length (m) > 0");
}

// Contact of a fast point along its path in a step. Contact elsewhere looks along the normal at the
// nearest place, but a long path may lead to another place.

/// Returns the part of `path` after which a point that starts at p comes through the triangle a, b,
/// c from outside. Above 1: never. A path that passes a little beside the triangle's edges counts,
/// for neighbours do not move alike.
template <class Real>
KOKKOS_INLINE_FUNCTION Real time_of_crossing(const Vec3<Real>& p, const Vec3<Real>& path,
                                             const Vec3<Real>& a, const Vec3<Real>& b,
                                             const Vec3<Real>& c) {
  constexpr Real never = 2, beside = Real(1) / 16;
  const Vec3<Real> n = cross(b - a, c - a);
  const Real above = dot(p - a, n), change = dot(path, n);
  if (!(above >= 0 && above + change < 0)) return never;
  const Real when = above / -change, square = dot(n, n);
  const Vec3<Real> d = p + when * path - a;
  const Real v = dot(cross(d, c - a), n), w = dot(cross(b - a, d), n);  // times `square`
  const bool inside =
      v >= -beside * square && w >= -beside * square && v + w <= (1 + beside) * square;
  return inside ? when : never;
}

/// Returns the gap for a point at x and the `path` of its step. For a long path, it is the gap to
/// the plane that touches the shape where the path meets it. Where a long path meets nothing, there
/// is no gap. The search steps along the path by the distance from every place (sphere tracing: J.
/// C. Hart, The Visual Computer 12, 1996).
template <class Real, class Shape>
KOKKOS_INLINE_FUNCTION Gap<Real> gap_along(const Shape& shape, const Vec3<Real>& x,
                                           const Vec3<Real>& path, Real reach) {
  const Gap<Real> gap = shape(x);
  const Real length = Kokkos::sqrt(dot(path, path)), short_path = Real(0.25) * reach,
             close = Real(1e-3) * reach;
  if (!(length > short_path && gap.distance > close)) return gap;
  constexpr int most = 64;
  constexpr Real endless = Real(1e30);
  Real gone = 0;
  Gap<Real> there = gap;
  for (int i = 0; i < most && there.distance > close; ++i) {
    gone += there.distance;
    if (gone > length) return gap.distance > short_path ? Gap<Real>{endless, gap.normal} : gap;
    there = shape(x + (gone / length) * path);
  }
  return {there.distance - gone / length * dot(there.normal, path), there.normal};
}

}  // namespace plica
