// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/small.hpp>

namespace plica {

/// Returns the weights of the corners a, b, c at the triangle's point that is nearest to p. They
/// are exactly 0 for corners that the nearest face, edge or vertex does not have. After C. Ericson,
/// Real-Time Collision Detection (2005), section 5.1.5.
template <class Real>
KOKKOS_INLINE_FUNCTION Vec3<Real> nearest_on_triangle(const Vec3<Real>& p, const Vec3<Real>& a,
                                                      const Vec3<Real>& b, const Vec3<Real>& c) {
  const Vec3<Real> ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const Real d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return {Real(1), Real(0), Real(0)};
  const Real d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return {Real(0), Real(1), Real(0)};
  const Real vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) {
    const Real v = d1 / (d1 - d3);
    return {1 - v, v, Real(0)};
  }
  const Real d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return {Real(0), Real(0), Real(1)};
  const Real vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) {
    const Real w = d2 / (d2 - d6);
    return {1 - w, Real(0), w};
  }
  const Real va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const Real w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {Real(0), 1 - w, w};
  }
  const Real all = 1 / (va + vb + vc), v = vb * all, w = vc * all;
  return {1 - v - w, v, w};
}

/// Cuts of a golden section that finds a place to 1/1000, and to the rounding of double.
constexpr int rough_cuts = 14, precise_cuts = 36;

/// Returns the place in [0, 1] where a convex function is least, by golden section.
template <class Real, int cuts, class F>
KOKKOS_INLINE_FUNCTION Real least_on_unit(const F& f) {
  constexpr Real part = Real(0.6180339887498949);
  Real low = 0, high = 1, left = 1 - part, right = part, at_left = f(left), at_right = f(right);
  for (int n = 0; n < cuts; ++n) {
    if (at_left <= at_right) {
      high = right, right = left, at_right = at_left;
      left = high - part * (high - low), at_left = f(left);
    } else {
      low = left, left = right, at_left = at_right;
      right = low + part * (high - low), at_right = f(right);
    }
  }
  return at_left <= at_right ? left : right;
}

/// Returns the weights of a triangle's corners where it is deepest in a convex solid, by nested
/// golden sections. The distance to such a solid is convex, if not smooth. Where the distance is
/// constant, the place is the triangle's middle. After Macklin, Erleben, Mueller, Chentanez,
/// Jeschke, Corse: Local optimization for robust signed distance field collision (2020). The number
/// of distances is fixed: 288 for rough_cuts. `size` of the triangle [m].
template <int cuts = rough_cuts, class Real, class Shape>
KOKKOS_INLINE_FUNCTION Vec3<Real> deepest_on_triangle(const Shape& shape, const Vec3<Real>& a,
                                                      const Vec3<Real>& b, const Vec3<Real>& c,
                                                      Real size) {
  constexpr Real lean = Real(1e-3);  // weight that leans to the middle
  const Vec3<Real> middle = Real(1) / 3 * (a + b + c);
  const auto at = [&](Real s, Real q) {
    const Vec3<Real> x = a + s * ((b - a) + q * (c - b)), d = x - middle;
    return shape(x).distance + lean / size * dot(d, d);
  };
  const auto across = [&](Real s) {
    return least_on_unit<Real, cuts>([&](Real q) { return at(s, q); });
  };
  const Real s = least_on_unit<Real, cuts>([&](Real t) { return at(t, across(t)); }), q = across(s);
  return {1 - s, s * (1 - q), s * q};
}

}  // namespace plica
