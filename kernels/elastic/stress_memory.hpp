// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/fields.hpp>
#include <plica/core/launch.hpp>
#include <plica/core/level.hpp>
#include <plica/core/small.hpp>

// Relaxation by Prony series, in Simo's way (Simo & Hughes, Computational Inelasticity, 10.3; the
// stress that relaxes is FEBio's): with the isochoric second Piola stress S of an elastic law and
// terms alpha_i, tau_i,
//
//   P = P_elastic(F) - F sum_i alpha_i (S - H_i),     H_i' = S' - H_i / tau_i,     H_i = S at the start.
//
// From a time where S_n and H_i are known, over t, with S linear in between: H_i = keep_i H_i +
// gain_i (S - S_n), keep = e^(-t/tau), gain = (1 - keep) tau/t. So
//
//   sum_i alpha_i (S - H_i) = share S + lost,   share = sum alpha_i (1 - gain_i),   lost = sum alpha_i (gain_i S_n - keep_i H_i):
//
// over a step the material is the elastic one with 1 - share of its energy of shape, less a stress
// `lost` that does not depend on the state. Elastic kernels do the former with other constants,
// those here the latter.
namespace plica {

/// Numbers first to first + 5 of `count` as a symmetric matrix, of the slots in T's lanes.
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

/// The true stress F S F^T / J of a second Piola stress.
template <class T>
KOKKOS_INLINE_FUNCTION Mat3<T> pushed_forward(const Mat3<T>& F, const SymMat3<T>& S) {
  return (T(1) / determinant(F)) * (F * matrix_of(S) * transpose(F));
}

/// What the Prony series of each region makes of a time t, see stress_memory.hpp; a term of alpha 0
/// is none.
template <class B>
struct RelaxationSteps {
  using Real = typename B::Real;
  int terms = 0;          ///< of the longest series
  Doubles<B> alpha, tau;  ///< [regions][terms]; s
  Changing<B, double> t;  ///< [s]
  bool backward_euler = false;
  Scalars<B> step;    ///< [regions][terms][2] keep and gain
  Scalars<B> weight;  ///< [regions][1 + terms] of S_n and of each -H_i in what is lost
  Scalars<B> share;   ///< [regions] of the energy of shape that is lost

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
