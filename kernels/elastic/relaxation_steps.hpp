// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/fields.hpp>

namespace plica {

/// What the Prony series of each region makes of a time t, see stress_memory.hpp; a term of alpha 0 is none.
template <class B>
struct RelaxationSteps {
  using Real = typename B::Real;
  int terms = 0;          ///< of the longest series
  Doubles<B> alpha, tau;  ///< [regions][terms]; s
  double t = 0;           ///< [s]
  bool backward_euler = false;
  Scalars<B> step;    ///< [regions][terms][2] keep and gain
  Scalars<B> weight;  ///< [regions][1 + terms] of S_n and of each -H_i in what is lost
  Scalars<B> share;   ///< [regions] of the energy of shape that is lost

  KOKKOS_INLINE_FUNCTION void operator()(int region) const {
    double shared = 0, elastic = 0;
    for (int i = 0; i < terms; ++i) {
      const int at = region * terms + i;
      const double x = t / tau(at);
      const double gain = backward_euler ? 1 / (1 + x) : x > 0 ? -Kokkos::expm1(-x) / x : 1;
      const double keep = backward_euler ? gain : Kokkos::exp(-x);
      shared += alpha(at) * (1 - gain), elastic += alpha(at) * gain;
      step(2 * at) = static_cast<Real>(keep), step(2 * at + 1) = static_cast<Real>(gain);
      weight(region * (1 + terms) + 1 + i) = static_cast<Real>(alpha(at) * keep);
    }
    weight(region * (1 + terms)) = static_cast<Real>(elastic), share(region) = static_cast<Real>(shared);
  }
};

}  // namespace plica
