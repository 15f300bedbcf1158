// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/small.hpp>
#include <plica/core/sparse_rows.hpp>

// A sparse matrix of numbers times vectors. Per entry 4 + s bytes of the row and 3 s of the vector it points at, which a cache
// holds; 6 flops.
namespace plica {

template <class B>
KOKKOS_INLINE_FUNCTION Vec3<typename B::Real> row_product(const SparseRows<B>& A, int row, const Vectors<B>& x) {
  Vec3<typename B::Real> sum;
  for (int s = A.first(row); s < A.first(row + 1); ++s) {
    const typename B::Real w = A.value(s);
    const int b = A.column(s);
    for (int k = 0; k < 3; ++k) sum[k] += w * x(b, k);
  }
  return sum;
}

/// y = A x
template <class B>
struct MultiplyRows {
  SparseRows<B> A;
  Vectors<B> x, y;
  KOKKOS_INLINE_FUNCTION void operator()(int row) const {
    const auto sum = row_product<B>(A, row, x);
    for (int k = 0; k < 3; ++k) y(row, k) = sum[k];
  }
};

}  // namespace plica
