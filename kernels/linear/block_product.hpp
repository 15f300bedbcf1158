// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/block_matrix.hpp>
#include <plica/core/small.hpp>

namespace plica {

/// Row a of A x. Per block 9 s + 4 bytes, 18 flops; a block's columns are taken four numbers at a time, the last of which is not used.
template <class B>
KOKKOS_INLINE_FUNCTION Vec3<typename B::Real> block_row_product(const BlockMatrix<B>& A, int a, const Vectors<B>& x) {
  using Real = typename B::Real;
  const int first = A.first(a), last = A.first(a + 1);
#if defined(__GNUC__) && !defined(__CUDACC__)
  if constexpr (B::on_host) {
    typedef Real Four __attribute__((vector_size(4 * sizeof(Real)), may_alias, aligned(alignof(Real))));
    Four even[3] = {}, odd[3] = {};  // two blocks at a time: sums need not wait for each other
    const Real* value = A.value.data() + 9 * static_cast<std::ptrdiff_t>(first);
    const auto add = [&](Four(&sum)[3], int s, const Real* block) {
      const Real* const at = x.data() + 3 * static_cast<std::ptrdiff_t>(A.column(s));
      for (int k = 0; k < 3; ++k) sum[k] += *reinterpret_cast<const Four*>(block + 3 * k) * at[k];
    };
    int s = first;
    for (; s + 1 < last; s += 2, value += 18) add(even, s, value), add(odd, s + 1, value + 9);
    if (s < last) add(even, s, value);
    const Four y = (even[0] + even[1] + even[2]) + (odd[0] + odd[1] + odd[2]);
    return {y[0], y[1], y[2]};
  }
#endif
  Vec3<Real> y;
  for (int s = first; s < last; ++s)
    for (int k = 0; k < 3; ++k) {
      const Real w = x(A.column(s), k);
      for (int i = 0; i < 3; ++i) y[i] += A.value(s, 3 * k + i) * w;
    }
  return y;
}

/// y = A x
template <class B>
struct BlockProduct {
  BlockMatrix<B> A;
  Vectors<B> x, y;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    const auto sum = block_row_product<B>(A, a, x);
    for (int k = 0; k < 3; ++k) y(a, k) = sum[k];
  }
};

}  // namespace plica
