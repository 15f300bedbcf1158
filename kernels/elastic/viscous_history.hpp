// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/fields.hpp>
#include <plica/core/launch.hpp>
#include <plica/core/level_data.hpp>
#include <plica/core/small.hpp>

// Relaxation by Prony series, by the method of Simo (Simo & Hughes, Computational Inelasticity,
// 10.3). The stress that relaxes is the one of FEBio. With the isochoric second Piola stress S of
// an elastic law and terms alpha_i, tau_i,
//
//   P = P_elastic(F) - F sum_i alpha_i (S - H_i),  H_i' = S' - H_i / tau_i,  H_i = S at the start.
//
// S_n and H_i are known at the begin of a time t, over which S is linear: H_i = keep_i H_i + gain_i
// (S - S_n), keep = e^(-t/tau), gain = (1 - keep) tau/t. So
//
//   sum_i alpha_i (S - H_i) = share S + lost,
//   share = sum alpha_i (1 - gain_i),   lost = sum alpha_i (gain_i S_n - keep_i H_i):
//
// over a step the material is the elastic one with 1 - share of its energy of shape, less the
// relaxed stress `relaxed`, which does not depend on the state. Elastic kernels compute the elastic
// part with other constants; the kernels of relaxed_stress.hpp compute the relaxed stress.
namespace plica {

/// Loads numbers first to first + 5 of `count` as a symmetric matrix, of the slots in T's lanes.
template <class B, class T>
KOKKOS_INLINE_FUNCTION SymMat3<T> load_symmetric(const Scalars<B>& all, int slot, int first = 0,
                                                 int count = 6) {
  SymMat3<T> m;
  for (int k = 0; k < 6; ++k) {
    const typename B::Real* const at = &all(packed<B>(slot, first + k, count));
    for (int l = 0; l < LaneOf<T>::count; ++l) set_lane(m.a[k], l, at[l]);
  }
  return m;
}
template <class B, class T>
KOKKOS_INLINE_FUNCTION void store_symmetric(const SymMat3<T>& m, const Scalars<B>& all, int slot,
                                            int first, int count) {
  for (int k = 0; k < 6; ++k) {
    typename B::Real* const at = &all(packed<B>(slot, first + k, count));
    for (int l = 0; l < LaneOf<T>::count; ++l) at[l] = lane(m.a[k], l);
  }
}

/// Returns the true stress F S F^T / J of a second Piola stress.
template <class T>
KOKKOS_INLINE_FUNCTION Mat3<T> pushed_forward(const Mat3<T>& F, const SymMat3<T>& S) {
  return (T(1) / determinant(F)) * (F * matrix_of(S) * transpose(F));
}

/// Steps of the Prony series of each region over a time t, see viscous_history.hpp. A term of alpha
/// 0 has no effect.
template <class B>
struct RelaxationSteps {
  using Real = typename B::Real;
  int terms = 0;          ///< terms of the longest series
  Doubles<B> alpha, tau;  ///< [regions][terms] 1; s
  Changing<B, double> t;  ///< time of the step [s]
  bool backward_euler = false;
  Scalars<B> step;    ///< [regions][terms][2] keep and gain
  Scalars<B> weight;  ///< [regions][1 + terms] factors of S_n and of each -H_i in `relaxed`
  Scalars<B> share;   ///< [regions] part of the energy of shape that relaxes

  KOKKOS_INLINE_FUNCTION void operator()(int region) const {
    double shared = 0, elastic = 0;
    for (int i = 0; i < terms; ++i) {
      const int at = region * terms + i;
      const double x = *t / tau(at);
      const double gain = backward_euler ? 1 / (1 + x) : x > 0 ? -Kokkos::expm1(-x) / x : 1;
      const double keep = backward_euler ? gain : Kokkos::exp(-x);
      shared += alpha(at) * (1 - gain), elastic += alpha(at) * gain;
      step(2 * at) = static_cast<Real>(keep), step(2 * at + 1) = static_cast<Real>(gain);
      weight(region * (1 + terms) + 1 + i) = static_cast<Real>(alpha(at) * keep);
    }
    weight(region * (1 + terms)) = static_cast<Real>(elastic),
                         share(region) = static_cast<Real>(shared);
  }
};

}  // namespace plica
