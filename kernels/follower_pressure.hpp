// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/level.hpp>
#include <plica/core/small.hpp>

namespace plica {

/// Adds a pressure [Pa] on triangles as they are now: each puts -p A n / 3 at its corners, A n = (x_1 - x_0) x (x_2 - x_0) / 2 with n
/// outwards. Per vertex, over its own triangles in a stored order.
template <class B>
struct AddFollowerPressure {
  using Real = typename B::Real;
  FollowerLoad<B> load;
  Vectors<B> u, force;
  Real pressure;

  KOKKOS_INLINE_FUNCTION Vec3<Real> place(int i) const {
    const int a = load.vertex(i);
    return {load.rest(i, 0) + u(a, 0), load.rest(i, 1) + u(a, 1), load.rest(i, 2) + u(a, 2)};
  }
  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    const Vec3<Real> own = place(i);
    Vec3<Real> area;
    for (int t = load.first(i); t < load.first(i + 1); ++t)
      area += cross(place(load.second(t)) - own, place(load.third(t)) - own);
    for (int k = 0; k < 3; ++k) force(load.vertex(i), k) -= pressure / 6 * area[k];
  }
};

}  // namespace plica
