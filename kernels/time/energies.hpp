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

/// Component x of a field of the patches' vertices, for sums over it.
template <class B>
struct FirstComponent {
  Vectors<B> field;
  KOKKOS_INLINE_FUNCTION Sums<1> operator()(int i) const {
    return {{static_cast<double>(field(i, 0))}};
  }
};

}  // namespace plica
