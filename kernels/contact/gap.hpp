// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/error.hpp>
#include <plica/core/functions.hpp>
#include <plica/core/mesh.hpp>
#include <plica/core/small.hpp>

namespace plica {

/// Distance to a solid [m], positive outside, and the unit normal out of it at the nearest point of its surface.
template <class Real>
struct Gap {
  Real distance;
  Vec3<Real> normal;
};

/// A unit vector across `axis`, itself a unit vector: the direction of d where it has one, any where d is on the axis.
template <class Real>
KOKKOS_INLINE_FUNCTION Vec3<Real> direction_across(const Vec3<Real>& axis, const Vec3<Real>& d, Real length) {
  if (length > 0) return (Real(1) / length) * d;
  Vec3<Real> any;
  any[axis[0] * axis[0] < Real(0.5) ? 0 : 1] = Real(1);
  any -= dot(any, axis) * axis;
  return (Real(1) / sqrt(dot(any, any))) * any;
}

/// A point of the host's geometry for a kernel.
template <class Real>
Vec3<Real> vec3(const Point& p) {
  return {static_cast<Real>(p[0]), static_cast<Real>(p[1]), static_cast<Real>(p[2])};
}

/// Of shapes between two points: InputError where these are one.
inline void check_apart(const std::string& path, const Point& from, const Point& to) {
  if (!((to - from).norm() > 0))
    throw InputError(path + ".to, as a distance from .from, is 0; expected a length (m) > 0");
}

}  // namespace plica
