// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/small.hpp>

namespace plica {

/// Where in [0, 1] a convex function is least, to 1/1000: golden section.
template <class Real, class F>
KOKKOS_INLINE_FUNCTION Real least_on_unit(const F& f) {
  constexpr Real part = Real(0.6180339887498949);
  constexpr int cuts = 14;
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

/// The weights of a triangle's corners where it is deepest in a convex solid, by golden sections of golden sections: the distance to
/// such a solid is convex, if not smooth. Where it is the same all over, that is in the triangle's middle. After Macklin, Erleben,
/// Mueller, Chentanez, Jeschke, Corse: Local optimization for robust signed distance field collision (2020). A fixed number of
/// distances, 256 of them. `size` of the triangle [m].
template <class Real, class Shape>
KOKKOS_INLINE_FUNCTION Vec3<Real> deepest_on_triangle(const Shape& shape, const Vec3<Real>& a, const Vec3<Real>& b,
                                                      const Vec3<Real>& c, Real size) {
  constexpr Real lean = Real(1e-3);  // to the middle
  const Vec3<Real> middle = Real(1) / 3 * (a + b + c);
  const auto at = [&](Real s, Real q) {
    const Vec3<Real> x = a + s * ((b - a) + q * (c - b)), d = x - middle;
    return shape(x).distance + lean / size * dot(d, d);
  };
  const auto across = [&](Real s) { return least_on_unit<Real>([&](Real q) { return at(s, q); }); };
  const Real s = least_on_unit<Real>([&](Real t) { return at(t, across(t)); }), q = across(s);
  return {1 - s, s * (1 - q), s * q};
}

}  // namespace plica
