// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Kokkos_Core.hpp>
#include <algorithm>
#include <cstddef>

namespace plica {

/// Returns the number of a vertex, an element or an entry as an index.
constexpr std::size_t index_of(int number) { return static_cast<std::size_t>(number); }

/// Returns the number of parts into which for_row_parts() cuts `count` rows.
inline std::size_t row_parts(std::size_t count) {
  return std::min(count,
                  8 * static_cast<std::size_t>(Kokkos::DefaultHostExecutionSpace().concurrency()));
}

/// Calls work(part, first, last) for parts of 0 ... count - 1, by all threads of the host. Together
/// the parts are all of it.
template <class Work>
void for_row_parts(std::size_t count, const Work& work) {
  using Exec = Kokkos::DefaultHostExecutionSpace;
  const std::size_t parts = row_parts(count);
  Kokkos::parallel_for("plica::row_ranges",
                       Kokkos::RangePolicy<Exec, Kokkos::Schedule<Kokkos::Dynamic>>(0, parts),
                       [&](std::size_t p) { work(p, p * count / parts, (p + 1) * count / parts); });
}

/// Calls work(first, last) for parts of 0 ... count - 1, by all threads of the host. Together the
/// parts are all of it.
template <class Work>
void for_row_ranges(std::size_t count, const Work& work) {
  for_row_parts(count,
                [&](std::size_t, std::size_t first, std::size_t last) { work(first, last); });
}

}  // namespace plica
