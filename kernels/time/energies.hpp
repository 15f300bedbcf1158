// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/vectors.hpp>

namespace plica {

/// Sums over the vertices of a moving body, in one pass: kinetic energy, gravity's potential energy
/// [J], zero at rest, momentum [kg m/s], and the largest (v - drift)^2 over the squared local edge
/// [1/s^2]. Sums are not finite where u or v is not.
using MotionSums = Sums<6, 1>;

template <class B>
struct MotionEnergies {
  using Real = typename B::Real;
  Scalars<B> mass;
  State<B> state;
  Vec3<Real> gravity;
  Scalars<B> inverse_edge;  ///< [vertices] 1/m
  Vec3<double> drift;       ///< velocity of the whole body [m/s]

  KOKKOS_INLINE_FUNCTION MotionSums operator()(int a) const {
    const double m = static_cast<double>(mass(a)), per_edge = static_cast<double>(inverse_edge(a));
    double speed2 = 0, along = 0, relative2 = 0;
    MotionSums sums;
    for (int k = 0; k < 3; ++k) {
      const double v = static_cast<double>(state.v(a, k));
      speed2 += v * v, relative2 += (v - drift[k]) * (v - drift[k]);
      sums[2 + k] = m * v;
      along += static_cast<double>(gravity[k]) * static_cast<double>(state.u(a, k));
    }
    sums[0] = 0.5 * m * speed2, sums[1] = -m * along, sums[5] = relative2 * per_edge * per_edge;
    return sums;
  }
};

/// Energy of a vertex: component x of its shares in a field of the element kernels, for sums over
/// the vertices.
template <class B>
struct EnergyOfShares {
  VertexShares<B> shares;
  Vectors<B> partial;
  KOKKOS_INLINE_FUNCTION Sums<1> operator()(int a) const {
    double sum = 0;
    const bool weighted = shares.weight.extent(0) > 0;
    for (int s = shares.first(a); s < shares.first(a + 1); ++s) {
      const auto energy = static_cast<double>(partial(shares.row(s), 0));
      sum += weighted ? static_cast<double>(shares.weight(s)) * energy : energy;
    }
    return {{sum}};
  }
};

}  // namespace plica
