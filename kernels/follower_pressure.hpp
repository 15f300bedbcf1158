// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/level.hpp>
#include <plica/core/small.hpp>
#include <plica/kernels/reduce.hpp>

namespace plica {

/// Where the vertices of a load are, up to its origin [m].
template <class B>
struct FollowerPlaces {
  using Real = typename B::Real;
  FollowerLoad<B> load;
  Vectors<B> u;
  KOKKOS_INLINE_FUNCTION Vec3<Real> operator()(int i) const {
    const int a = load.vertex(i);
    return {load.rest(i, 0) + u(a, 0), load.rest(i, 1) + u(a, 1), load.rest(i, 2) + u(a, 2)};
  }
};

/// A given pressure [Pa].
template <class Real>
struct GivenPressure {
  Real value;
  KOKKOS_INLINE_FUNCTION Real operator()() const { return value; }
};

/// That of the fluid in a cavity, see Cavity.
template <class B>
struct FluidPressure {
  Doubles<B> volume;
  double goal, stiffness;  ///< [m^3], [Pa/m^3]
  KOKKOS_INLINE_FUNCTION typename B::Real operator()() const {
    return static_cast<typename B::Real>(stiffness * (goal - volume(0)));
  }
};

/// Adds a pressure on triangles as they are now: each puts -p A n / 3 at its corners, A n = (x_1 - x_0) x (x_2 - x_0) / 2 with n
/// outwards. Per vertex, over its own triangles in a stored order.
template <class B, class Pressure>
struct AddFollowerPressure {
  using Real = typename B::Real;
  FollowerPlaces<B> place;
  Vectors<B> force;
  Pressure pressure;

  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    const FollowerLoad<B>& load = place.load;
    const Vec3<Real> own = place(i);
    Vec3<Real> area;
    for (int t = load.first(i); t < load.first(i + 1); ++t)
      area += cross(place(load.second(t)) - own, place(load.third(t)) - own);
    const Real p = pressure();
    for (int k = 0; k < 3; ++k) force(load.vertex(i), k) -= p / 6 * area[k];
  }
};

/// A vertex's part of the volume on the outer side of its triangles, a third of - x_0 . (x_1 x x_2) / 6 of each [m^3].
template <class B>
struct VolumeOfCorner {
  FollowerPlaces<B> place;
  KOKKOS_INLINE_FUNCTION Sums<1> operator()(int i) const {
    const FollowerLoad<B>& load = place.load;
    Sums<1> part;
    for (int t = load.first(i); t < load.first(i + 1); ++t)
      part[0] -= static_cast<double>(dot(place(i), cross(place(load.second(t)), place(load.third(t))))) / 18;
    return part;
  }
};

}  // namespace plica
