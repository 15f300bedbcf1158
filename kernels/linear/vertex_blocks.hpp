// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/matrices.hpp>
#include <plica/kernels/vectors.hpp>

// Matrices of 3x3 blocks: the diagonal blocks of the vertices, products with vectors, and the
// matrix of the next coarser level.
namespace plica {

/// Copies the diagonal blocks of A.
template <class B>
struct TakeDiagonal {
  BlockMatrix<B> A;
  Blocks<B> diagonal;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    set_block<B>(diagonal, a, own_block<B>(A, a));
  }
};

/// Inverts the diagonal block of every row of a matrix. For one that is not positive definite, the
/// positive numbers on its diagonal are inverted alone; the inverse of an empty row is 0.
template <class B>
struct InvertDiagonal {
  using Real = typename B::Real;
  BlockMatrix<B> A;
  Blocks<B> inverse;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    const SymMat3<Real> block = own_block<B>(A, a);
    SymMat3<Real> answer;
    if (!invert_positive(block, answer))
      for (int k = 0; k < 3; ++k) answer[k] = block[k] > 0 ? 1 / block[k] : Real(0);
    set_block<B>(inverse, a, answer);
  }
};

/// Adds scale * symmetric vertex blocks to A.
template <class B>
struct AddToDiagonal {
  Blocks<B> block;
  BlockMatrix<B> A;
  typename B::Real scale;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    add_block<B>(A, A.diagonal(a), scale, block_at<B>(block, a));
  }
};

/// Sum of blocks times vectors. A CPU takes a column as four numbers, the last of which is not
/// used. It adds up the products of columns with a vector, number by number, and sums up the
/// numbers of a column at the end.
template <class Real>
struct BlockSum {
#if defined(__GNUC__) && !defined(__CUDACC__) && !defined(PLICA_LIKE_DEVICE)
  typedef Real Column
      __attribute__((vector_size(4 * sizeof(Real)), may_alias, aligned(alignof(Real))));
  Column straight[3] = {}, turned[3] = {};

  static const Column& four(const Real* at) { return *reinterpret_cast<const Column*>(at); }
  void add(const Real* block, const Real* x) {
    for (int k = 0; k < 3; ++k) straight[k] += four(block + 3 * k) * x[k];
  }
  /// Adds the transposed block times x; the number after x is read.
  void add_turned(const Real* block, const Real* x) {
    for (int k = 0; k < 3; ++k) turned[k] += four(block + 3 * k) * four(x);
  }
  Vec3<Real> sum() const {
    const Column y = straight[0] + straight[1] + straight[2];
    Vec3<Real> all;
    for (int k = 0; k < 3; ++k) all[k] = y[k] + (turned[k][0] + turned[k][1] + turned[k][2]);
    return all;
  }
#else
  Vec3<Real> y;
  KOKKOS_INLINE_FUNCTION void add(const Real* block, const Real* x) {
    for (int k = 0; k < 9; ++k) y[k % 3] += block[k] * x[k / 3];
  }
  KOKKOS_INLINE_FUNCTION void add_turned(const Real* block, const Real* x) {
    for (int k = 0; k < 9; ++k) y[k / 3] += block[k] * x[k % 3];
  }
  KOKKOS_INLINE_FUNCTION Vec3<Real> sum() const { return y; }
#endif
};

/// Returns row a of A x. Per stored block 9 s + 12 bytes, 36 flops, where the vectors of rows above
/// are still in a cache. For a large matrix, blocks of rows further down are prefetched: a
/// processor's own prefetching ends at the page in memory.
template <class B>
KOKKOS_INLINE_FUNCTION Vec3<typename B::Real> block_row_product(const BlockMatrix<B>& A, int a,
                                                                const Vectors<B>& x) {
  using Real = typename B::Real;
  const int own = A.diagonal(a), last = A.first(a + 1);
  const auto value = [&](int place) {
    return A.value.data() + 9 * static_cast<std::ptrdiff_t>(place);
  };
  const auto vector = [&](int s) {
    return x.data() + 3 * static_cast<std::ptrdiff_t>(A.column(s));
  };
  BlockSum<Real> sum;
  for (int s = A.first(a); s < own; ++s) sum.add_turned(value(A.place(s)), vector(s));
  const Real* block = value(A.place(own));
#if defined(__GNUC__) && !defined(__CUDACC__)
  constexpr std::ptrdiff_t ahead = 8192 / sizeof(Real), line = 64 / sizeof(Real);
  const bool large = A.stored() > (8 << 20) / static_cast<int>(9 * sizeof(Real));
#endif
  for (int s = own; s < last; ++s, block += 9) {
#if defined(__GNUC__) && !defined(__CUDACC__)
    if (large) __builtin_prefetch(block + ahead), __builtin_prefetch(block + ahead + line);
#endif
    sum.add(block, vector(s));
  }
  return sum.sum();
}

/// Computes y = A x.
template <class B>
struct BlockProduct {
  BlockMatrix<B> A;
  Vectors<B> x, y;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    set_vector<B>(y, a, block_row_product<B>(A, a, x));
  }
};

/// Computes y = A x and x.y.
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

/// Computes a block as a weighted sum of other blocks. Per term 8 + 9 s bytes, 18 flops.
template <class B>
struct SumOfBlocks {
  using Real = typename B::Real;
  BlockTerms<B> terms;
  Blocks9<B> from, to;

  KOKKOS_INLINE_FUNCTION void operator()(int block) const {
    Real sum[9] = {}, turned[9] = {};
    for (int s = terms.first(block); s < terms.first(block + 1); ++s) {
      const Real w = terms.weight(s);
      const int number = terms.block(s);
      if (number >= 0)
        for (int k = 0; k < 9; ++k) sum[k] += w * from(number, k);
      else
        for (int k = 0; k < 9; ++k) turned[k] += w * from(-1 - number, k);
    }
    for (int k = 0; k < 9; ++k) to(block, k) = sum[k] + turned[k % 3 * 3 + k / 3];
  }
};

/// Computes the matrix of the next coarser level, P^T A P (Galerkin). Its block (I, J) couples two
/// coarse vertices. It is the sum of the blocks (i, j) of A over all fine vertices i that hang on I
/// and j that hang on J, each times the two weights:
///
///   coarse   I --------- J          (P^T A P)_IJ = sum over i, j of P_iI A_ij P_jJ
///           / \\         |
///   fine   i   i' ------ j          here i, i' hang on I, and j on J
///
/// The terms depend on the meshes alone: GalerkinMap lists them once, block by block. With A P made
/// first there are a third as many terms as in the double sum.
template <class B>
void galerkin_product(const typename B::Exec& exec, const GalerkinMap<B>& map,
                      const BlockMatrix<B>& A, const BlockMatrix<B>& coarse) {
  update_vertices<B>(exec, "plica::galerkin", map.right.blocks(),
                     SumOfBlocks<B>{map.right, A.value, map.between});
  update_vertices<B>(exec, "plica::galerkin", map.left.blocks(),
                     SumOfBlocks<B>{map.left, map.between, coarse.value});
}

}  // namespace plica
