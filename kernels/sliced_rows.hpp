// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/backend.hpp>
#include <plica/core/transposed.hpp>

// Rows of a sparse matrix that are stored in slices of `slice_height` rows side by side (sliced
// ELLPACK, Monakov, Lokhmotov & Avetisyan 2010). Each row has a lane of a register, or a thread.
// Slot = slice * height + row of the slice.
namespace plica {

/// Rows that one work item computes: `lanes` rows of a slice.
template <class B>
struct RowsAt {
  int slice, offset, slot;  ///< offset: place of the first row in the slice; slot: of the first row
  explicit KOKKOS_INLINE_FUNCTION RowsAt(int item)
      : slice(item * B::lanes / slice_height<B>),
        offset(item * B::lanes % slice_height<B>),
        slot(item * B::lanes) {}
};

template <class B>
using RowPack = typename PackOf<typename B::Real, B::lanes>::type;

template <class B>
KOKKOS_INLINE_FUNCTION RowPack<B> load_rows(const typename B::Real* from) {
  RowPack<B> r;
  for (int l = 0; l < B::lanes; ++l) set_lane(r, l, from[l]);
  return r;
}
template <class B>
KOKKOS_INLINE_FUNCTION void store_rows(const RowPack<B>& r, typename B::Real* to) {
  for (int l = 0; l < B::lanes; ++l) to[l] = lane(r, l);
}

}  // namespace plica
