// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/fields.hpp>

namespace plica {

/// The first inverted element of each patch since the last clear, where none is allowed. A patch is worked
/// on by one team at a time and its own record only, so that what is kept does not depend on the number of threads.
template <class B>
struct ElementFlags {
  Kokkos::View<int, typename B::Memory> raised;  ///< 0: none anywhere
  Indices<B> evaluation;                         ///< [patches] of the force, counted from 1; 0: none
  Indices<B> element;                            ///< [patches] slot (pack * lanes + lane)
  Scalars<B> J;                                  ///< [patches] its volume ratio

  KOKKOS_INLINE_FUNCTION void raise(int patch, int now, int slot, typename B::Real ratio) const {
    Kokkos::atomic_store(&raised(), 1);
    // on a GPU several threads of the team may come here in one evaluation: the smallest slot stays
    if (evaluation(patch) == 0 || (evaluation(patch) == now && slot < element(patch)))
      evaluation(patch) = now, element(patch) = slot, J(patch) = ratio;
  }

  void clear(const typename B::Exec& exec) const {
    if (evaluation.extent(0) == 0) return;
    fill(exec, raised, 0);
    fill(exec, evaluation, 0);
  }
};

template <class B>
ElementFlags<B> make_element_flags(int patches) {
  return {Kokkos::View<int, typename B::Memory>("plica::flags.raised"),
          zeros<Indices<B>>("plica::flags.evaluation", patches), zeros<Indices<B>>("plica::flags.element", patches),
          zeros<Scalars<B>>("plica::flags.J", patches)};
}

}  // namespace plica
