// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/backend.hpp>

namespace plica {

/// Values at some points (a mesh's vertices, a surface's) as weighted sums of four vertices of another mesh. A target
/// without a row keeps its own value: constrained vertices, and those outside the other mesh where that is asked for.
template <class B>
struct Transfer {
  int rows = 0;
  Indices<B> target;  ///< [rows]
  Kokkos::View<int* [4], Kokkos::LayoutRight, typename B::Memory> source;
  Kokkos::View<typename B::Real* [4], Kokkos::LayoutRight, typename B::Memory> weight;  ///< each row sums to 1
};

}  // namespace plica
