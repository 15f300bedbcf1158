// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/level_data.hpp>
#include <plica/core/small.hpp>
#include <plica/kernels/reduce.hpp>
#include <plica/kernels/vectors.hpp>

namespace plica {

/// Positions of the vertices of a load, relative to its origin [m].
template <class B>
struct FollowerPlaces {
  using Real = typename B::Real;
  FollowerLoad<B> load;
  Vectors<B> u;
  KOKKOS_INLINE_FUNCTION Vec3<Real> operator()(int i) const {
    const int a = load.vertex(i);
    return {load.rest(i, 0) + u(a, 0), load.rest(i, 1) + u(a, 1), load.rest(i, 2) + u(a, 2)};
  }
  /// Returns a third of the area vectors A n of a vertex' triangles, n outwards [m^2]. A n = (x_1 -
  /// x_0) x (x_2 - x_0) / 2. The sum is over the vertex' own triangles in a stored order.
  KOKKOS_INLINE_FUNCTION Vec3<Real> area(int i) const {
    const Vec3<Real> own = (*this)(i);
    Vec3<Real> twice;
    for (int t = load.first(i); t < load.first(i + 1); ++t)
      twice += cross((*this)(load.second(t)) - own, (*this)(load.third(t)) - own);
    return Real(1) / 6 * twice;
  }
};

/// A given pressure [Pa].
template <class B>
struct GivenPressure {
  Changing<B, typename B::Real> value;
  KOKKOS_INLINE_FUNCTION typename B::Real operator()() const { return *value; }
};

/// Pressure of the fluid in a cavity, see Cavity [Pa].
template <class B>
struct FluidPressure {
  Doubles<B> volume;
  Changing<B, double> goal;  ///< volume at which the pressure is 0 [m^3]
  double stiffness;          ///< [Pa/m^3]
  KOKKOS_INLINE_FUNCTION typename B::Real operator()() const {
    return static_cast<typename B::Real>(stiffness * (*goal - volume(0)));
  }
};

/// Adds a pressure p on the deformed triangles: each puts -p A n / 3 at its corners.
template <class B, class Pressure>
struct AddFollowerPressure {
  using Real = typename B::Real;
  FollowerPlaces<B> place;
  Vectors<B> force;
  Pressure pressure;

  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    const Vec3<Real> push = pressure() * place.area(i);
    for (int k = 0; k < 3; ++k) force(place.load.vertex(i), k) -= push[k];
  }
};

/// Adds scale K d to q, with K the symmetric part of minus the derivative of the pressure forces at
/// a given p. A triangle's area vector changes by half the sum over its corners of d_j x e_j, e_j =
/// x_{j+1} - x_{j-1} its side opposite j. So its corners' blocks are K_ij = -p/6 [e_j]x. Their
/// symmetric parts are -p/12 [e_j - e_i]x, 0 for i = j. Where the triangles close a surface, or end
/// in rims that do not move, the sum over them is symmetric: the forces are p times the derivative
/// of a volume there (Bufler 1984, ZAMM 64:287).
template <class B, class Pressure>
struct AddFollowerProduct {
  using Real = typename B::Real;
  FollowerPlaces<B> place;
  Vectors<B> d, q;
  Pressure pressure;
  Real scale;

  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    const FollowerLoad<B>& load = place.load;
    const Vec3<Real> own = place(i);
    Vec3<Real> sum;
    for (int t = load.first(i); t < load.first(i + 1); ++t) {
      const Vec3<Real> second = place(load.second(t)), third = place(load.third(t));
      sum += cross(vector_at<B>(d, load.vertex(load.second(t))), third - own + third - second) +
             cross(vector_at<B>(d, load.vertex(load.third(t))), own - second + third - second);
    }
    const int a = load.vertex(i);
    set_vector<B>(q, a, vector_at<B>(q, a) + scale * pressure() / 12 * sum);
  }
};

/// Part of a vertex in minus the rate at which the volume changes with d [m^2 x d].
template <class B>
struct VolumeRateOfCorner {
  FollowerPlaces<B> place;
  Vectors<B> d;
  KOKKOS_INLINE_FUNCTION Sums<1> operator()(int i) const {
    return {static_cast<double>(dot(place.area(i), vector_at<B>(d, place.load.vertex(i))))};
  }
};

/// Adds scale k g (g . d) to q, g the derivative of the volume: the pressure of a fluid falls where
/// the volume grows.
template <class B>
struct AddFluidProduct {
  using Real = typename B::Real;
  FollowerPlaces<B> place;
  Vectors<B> q;
  Doubles<B> rate;  ///< [1] -g . d
  double stiffness, scale;

  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    const int a = place.load.vertex(i);
    set_vector<B>(
        q, a, vector_at<B>(q, a) + static_cast<Real>(scale * stiffness * rate(0)) * place.area(i));
  }
};

/// Part of a vertex in the volume on the outer side of its triangles [m^3]: a third of -x_0 . (x_1
/// x x_2) / 6 of each triangle.
template <class B>
struct VolumeOfCorner {
  FollowerPlaces<B> place;
  KOKKOS_INLINE_FUNCTION Sums<1> operator()(int i) const {
    const FollowerLoad<B>& load = place.load;
    Sums<1> part;
    for (int t = load.first(i); t < load.first(i + 1); ++t)
      part[0] -=
          static_cast<double>(dot(place(i), cross(place(load.second(t)), place(load.third(t))))) /
          18;
    return part;
  }
};

}  // namespace plica
