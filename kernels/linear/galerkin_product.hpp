// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/block_matrix.hpp>
#include <plica/core/galerkin_map.hpp>

namespace plica {

/// P^T A P from A. Per term 8 + 9 s bytes, 18 flops.
template <class B>
struct GalerkinProduct {
  using Real = typename B::Real;
  GalerkinMap<B> map;
  BlockMatrix<B> fine, coarse;

  KOKKOS_INLINE_FUNCTION void operator()(int block) const {
    Real sum[9] = {};
    for (int s = map.first(block); s < map.first(block + 1); ++s) {
      const Real w = map.weight(s);
      const Real* const from = &fine.value(map.fine(s), 0);
      for (int k = 0; k < 9; ++k) sum[k] += w * from[k];
    }
    Real* const upper = &coarse.value(map.upper(block), 0);
    Real* const lower = &coarse.value(map.lower(block), 0);
    for (int k = 0; k < 9; ++k) upper[k] = sum[k], lower[k % 3 * 3 + k / 3] = sum[k];
  }
};

/// The same values in another precision.
template <class To, class From>
struct ConvertBlocks {
  Blocks9<From> from;
  Blocks9<To> to;
  KOKKOS_INLINE_FUNCTION void operator()(int s) const {
    for (int k = 0; k < 9; ++k) to(s, k) = static_cast<typename To::Real>(from(s, k));
  }
};

template <class To, class From>
struct ConvertVectors {
  Vectors<From> from;
  Vectors<To> to;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    for (int k = 0; k < 3; ++k) to(a, k) = static_cast<typename To::Real>(from(a, k));
  }
};

}  // namespace plica
