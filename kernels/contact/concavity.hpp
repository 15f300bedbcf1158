// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/functions.hpp>
#include <plica/core/small.hpp>
#include <plica/kernels/contact/gap.hpp>
#include <plica/kernels/contact/obstacle_pose.hpp>

namespace plica {

/// Returns G, by which an obstacle's normal n turns where a point moves by dx along a hollow: by -G
/// dx. -G is the Hessian of the distance, without its convex part. A bowl of radius R has G = (1 -
/// n n) / R [1/m], a convex solid 0. `x` and `n` are in the axes of the shape. G comes from
/// differences of n over `width` to either side [m].
template <class Real, class Shape>
KOKKOS_INLINE_FUNCTION SymMat3<Real> concavity(const Shape& shape, const ObstaclePose& place,
                                               const Vec3<Real>& x, const Vec3<Real>& n,
                                               Real width) {
  if constexpr (requires { shape.cell; }) width = Kokkos::max(width, shape.cell);
  Vec3<Real> across[2], change[2];
  across[0] = direction_across(n, {}, Real(0)), across[1] = cross(n, across[0]);
  for (int i = 0; i < 2; ++i)
    change[i] = shape(x - width * across[i]).normal - shape(x + width * across[i]).normal;
  const Real scale = 1 / (2 * width);
  Real xx = scale * dot(change[0], across[0]), yy = scale * dot(change[1], across[1]),
       xy = Real(0.5) * scale * (dot(change[0], across[1]) + dot(change[1], across[0]));
  const Real mean = Real(0.5) * (xx + yy), half = Real(0.5) * (xx - yy),
             spread = Kokkos::sqrt(half * half + xy * xy);
  const Real most = mean + spread, least = mean - spread;
  if (!(most > 0)) return {};
  if (least < 0) {  // the part along the direction that is concave
    const Real part = most / (most - least);
    xx = part * (xx - least), yy = part * (yy - least), xy = part * xy;
  }
  const Vec3<Real> a = place.to_world(across[0]), b = place.to_world(across[1]);
  const Vec3<Real> of_a = xx * a + xy * b, of_b = xy * a + yy * b;
  return six_of(outer(of_a, a) + outer(of_b, b));
}

}  // namespace plica
