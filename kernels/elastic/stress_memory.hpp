// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/level.hpp>
#include <plica/core/small.hpp>

// Relaxation by Prony series, in Simo's way (Simo & Hughes, Computational Inelasticity, 10.3; the stress that relaxes is FEBio's): with the
// isochoric second Piola stress S of an elastic law and terms alpha_i, tau_i,
//
//   P = P_elastic(F) - F sum_i alpha_i (S - H_i),     H_i' = S' - H_i / tau_i,     H_i = S at the start.
//
// From a time where S_n and H_i are known, over t, with S linear in between: H_i = keep_i H_i + gain_i (S - S_n),
// keep = e^(-t/tau), gain = (1 - keep) tau/t. So
//
//   sum_i alpha_i (S - H_i) = share S + lost,   share = sum alpha_i (1 - gain_i),   lost = sum alpha_i (gain_i S_n - keep_i H_i):
//
// over a step the material is the elastic one with 1 - share of its energy of shape, less a stress `lost` that does not depend on the
// state. Elastic kernels do the former with other constants, those here the latter.
namespace plica {

/// Number k of `count` at a slot: the same numbers of a pack's elements stand side by side.
template <class B>
KOKKOS_INLINE_FUNCTION int packed(int slot, int k, int count) {
  return (slot / B::lanes * count + k) * B::lanes + slot % B::lanes;
}

/// Numbers first to first + 5 of `count` as a symmetric matrix, of the slots in T's lanes.
template <class B, class T>
KOKKOS_INLINE_FUNCTION SymMat3<T> load_symmetric(const Scalars<B>& all, int slot, int first = 0, int count = 6) {
  SymMat3<T> m;
  for (int k = 0; k < 6; ++k) {
    const typename B::Real* const at = &all(packed<B>(slot, first + k, count));
    for (int l = 0; l < LaneOf<T>::count; ++l) set_lane(m.a[k], l, at[l]);
  }
  return m;
}
template <class B, class T>
KOKKOS_INLINE_FUNCTION void store_symmetric(const SymMat3<T>& m, const Scalars<B>& all, int slot, int first,
                                            int count) {
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

}  // namespace plica
