// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/explicit/updates.hpp>

namespace plica {

/// Work that is left out where a count on the device is 0, without the host knowing; an empty count: always done.
template <class B, class Work>
struct WhereTouching {
  Kokkos::View<double*, typename B::Memory> count;
  Work work;
  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    if (count.extent(0) == 0 || count(0) > 0) work(i);
  }
};

template <class B, class Work>
void where_touching(const typename B::Exec& exec, const Kokkos::View<double*, typename B::Memory>& count,
                    const char* label, int n, const Work& work) {
  update_vertices<B>(exec, label, n, WhereTouching<B, Work>{count, work});
}

}  // namespace plica
