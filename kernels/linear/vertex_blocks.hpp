// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/matrices.hpp>
#include <plica/kernels/vectors.hpp>

// Matrices of 3x3 blocks: the vertices' own blocks, products with vectors, and the matrix of the next coarser level.
namespace plica {

/// diagonal = A's own blocks
template <class B>
struct TakeDiagonal {
  BlockMatrix<B> A;
  Blocks<B> diagonal;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const { set_block<B>(diagonal, a, block_at<B>(A, A.diagonal(a))); }
};

/// The inverse of a matrix's own block of every row. One that is not positive definite gives way to what is positive on its
/// diagonal; an empty row's is 0.
template <class B>
struct InvertDiagonal {
  using Real = typename B::Real;
  BlockMatrix<B> A;
  Blocks<B> inverse;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    const SymMat3<Real> block = block_at<B>(A, A.diagonal(a));
    SymMat3<Real> answer;
    if (!invert_positive(block, answer))
      for (int k = 0; k < 3; ++k) answer[k] = block[k] > 0 ? 1 / block[k] : Real(0);
    set_block<B>(inverse, a, answer);
  }
};

/// A += scale * symmetric vertex blocks
template <class B>
struct AddToDiagonal {
  Blocks<B> block;
  BlockMatrix<B> A;
  typename B::Real scale;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const { add_block<B>(A, A.diagonal(a), scale, block_at<B>(block, a)); }
};

/// A sum of columns of blocks, each times a number. A CPU takes a column as four numbers, the last of which is not used.
template <class Real>
struct BlockSum {
#if defined(__GNUC__) && !defined(__CUDACC__)
  typedef Real Column __attribute__((vector_size(4 * sizeof(Real)), may_alias, aligned(alignof(Real))));
  Column v = {};
  void add(const Real* column, Real x) { v += *reinterpret_cast<const Column*>(column) * x; }
  Real operator[](int i) const { return v[i]; }
#else
  Vec3<Real> v;
  KOKKOS_INLINE_FUNCTION void add(const Real* column, Real x) { v += x * Vec3<Real>{column[0], column[1], column[2]}; }
  KOKKOS_INLINE_FUNCTION Real operator[](int i) const { return v[i]; }
#endif
};

/// Row a of A x. Per block 9 s + 4 bytes, 18 flops. Of a large matrix, what rows further down need is asked for early: a processor foresees
/// no further than the page in memory.
template <class B>
KOKKOS_INLINE_FUNCTION Vec3<typename B::Real> block_row_product(const BlockMatrix<B>& A, int a, const Vectors<B>& x) {
  using Real = typename B::Real;
  const int first = A.first(a), last = A.first(a + 1);
#if defined(__GNUC__) && !defined(__CUDACC__)
  if constexpr (B::for_cpu) {
    BlockSum<Real> even[3], odd[3];  // two blocks at a time: sums need not wait for each other
    const Real* value = A.value.data() + 9 * static_cast<std::ptrdiff_t>(first);
    constexpr std::ptrdiff_t ahead = 8192 / sizeof(Real), line = 64 / sizeof(Real);
    const bool large = A.blocks() > (8 << 20) / static_cast<int>(9 * sizeof(Real));
    const auto add = [&](BlockSum<Real>(&sum)[3], int s, const Real* block) {
      const Real* const at = x.data() + 3 * static_cast<std::ptrdiff_t>(A.column(s));
      for (int k = 0; k < 3; ++k) sum[k].add(block + 3 * k, at[k]);
    };
    int s = first;
    for (; s + 1 < last; s += 2, value += 18) {
      if (large) __builtin_prefetch(value + ahead), __builtin_prefetch(value + ahead + line);
      add(even, s, value), add(odd, s + 1, value + 9);
    }
    if (s < last) add(even, s, value);
    const auto y = (even[0].v + even[1].v + even[2].v) + (odd[0].v + odd[1].v + odd[2].v);
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
  KOKKOS_INLINE_FUNCTION void operator()(int a) const { set_vector<B>(y, a, block_row_product<B>(A, a, x)); }
};

/// y = A x and x.y
template <class B>
struct BlockProductDot {
  BlockMatrix<B> A;
  Vectors<B> x, y;
  KOKKOS_INLINE_FUNCTION Sums<1> operator()(int a) const {
    const auto row = block_row_product<B>(A, a, x);
    set_vector<B>(y, a, row);
    return {{static_cast<double>(dot(vector_at<B>(x, a), row))}};
  }
};

/// The matrix of the next coarser level, P^T A P (Galerkin). Its block (I, J) couples two coarse vertices: it is the sum of the
/// blocks (i, j) of A over all fine vertices i that hang on I and j that hang on J, each times the two weights:
///
///   coarse   I --------- J          (P^T A P)_IJ = sum over i, j of P_iI A_ij P_jJ
///           / \\         |
///   fine   i   i' ------ j          here i, i' hang on I, and j on J
///
/// Which terms there are depends on the meshes alone: GalerkinMap lists them once, block by block, and a work item adds up one
/// block. A is symmetric, so that only I <= J is added up and (J, I) is its transpose. Per term 8 + 9 s bytes, 18 flops.
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

}  // namespace plica
