// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Kokkos_Core.hpp>
#include <algorithm>
#include <cstddef>

namespace plica {

/// Calls work(first, last) for parts of 0 ... count - 1 that together are all of it, by all threads of the host.
template <class Work>
void for_row_ranges(std::size_t count, const Work& work) {
  using Exec = Kokkos::DefaultHostExecutionSpace;
  const std::size_t parts = std::min(count, 8 * static_cast<std::size_t>(Exec().concurrency()));
  Kokkos::parallel_for("plica::row_ranges", Kokkos::RangePolicy<Exec, Kokkos::Schedule<Kokkos::Dynamic>>(0, parts),
                       [&](std::size_t p) { work(p * count / parts, (p + 1) * count / parts); });
}

}  // namespace plica
