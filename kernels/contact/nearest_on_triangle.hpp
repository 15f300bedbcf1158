// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/small.hpp>

namespace plica {

/// The weights of the corners a, b, c at the triangle's point that is nearest to p: exactly 0 for corners that the nearest face, edge
/// or vertex does not have. After C. Ericson, Real-Time Collision Detection (2005), section 5.1.5.
template <class Real>
KOKKOS_INLINE_FUNCTION Vec3<Real> nearest_on_triangle(const Vec3<Real>& p, const Vec3<Real>& a, const Vec3<Real>& b,
                                                      const Vec3<Real>& c) {
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

}  // namespace plica
