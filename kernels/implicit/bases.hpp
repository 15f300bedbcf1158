// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/vectors.hpp>

// What the stages of the implicit integrators start from, (u~, v~) of ImplicitWeights, h the step [s]. The acceleration a is
// (f - c m v)/m, 0 where motion is given.
namespace plica {

/// a
template <class B>
struct Accelerations {
  Model<B> model;
  Vectors<B> f, v, a;
  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    const typename B::Real w = model.inverse_mass(i), c = w > 0 ? model.damping(i) : typename B::Real(0);
    for (int k = 0; k < 3; ++k) a(i, k) = w * f(i, k) - c * v(i, k);
  }
};

/// u~ = u + h1 v + h2 a, v~ = v + h3 a
template <class B>
struct ExtrapolateState {
  using Real = typename B::Real;
  State<B> start;
  Vectors<B> a;
  State<B> base;
  Real h1, h2, h3;
  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    for (int k = 0; k < 3; ++k) {
      base.u(i, k) = start.u(i, k) + h1 * start.v(i, k) + h2 * a(i, k);
      base.v(i, k) = start.v(i, k) + h3 * a(i, k);
    }
  }
};

/// From the stage of the generalised alpha method to the step's end; a_n becomes a_{n+1}.
template <class B>
struct GeneralizedAlphaEnd {
  using Real = typename B::Real;
  State<B> start, base, state;
  Vectors<B> a;
  Real h, cv, mass, beta, gamma;  ///< of v = base + cv (mass a_n + (1 - mass) a_{n+1})
  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    for (int k = 0; k < 3; ++k) {
      const Real a0 = a(i, k), a1 = ((state.v(i, k) - base.v(i, k)) / cv - mass * a0) / (1 - mass);
      state.u(i, k) = start.u(i, k) + h * start.v(i, k) + h * h * ((Real(0.5) - beta) * a0 + beta * a1);
      state.v(i, k) = start.v(i, k) + h * ((1 - gamma) * a0 + gamma * a1);
      a(i, k) = a1;
    }
  }
};

}  // namespace plica
