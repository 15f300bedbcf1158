// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/matrices.hpp>
#include <plica/kernels/vectors.hpp>

// A symmetric matrix of 3x3 blocks in 16 bits a number, for what preconditions: reading it is most of the work there, and 2^-16 of the
// vertices' own stiffness is less than a smoother notices. With scales t of the vertices,
//
//   A_ab = t_a t_b 2^16 q_ab,   |q_ab| < 2^15,   t_a^2 2^16 (2^15 - 1) = the largest number on the diagonal of A_aa
//
// because no number of a positive definite matrix is above the root of its two diagonal ones. Products take the scaled vector t x, so that
// scales cost nothing in the sum. Blocks of a row come in pairs: number k of both in one word, the first in its upper half. Either half,
// with zeros below it, is 2^16 q as an integer. The ninth numbers stand alone, so that the others fill a register.
namespace plica {

struct PackedPair {
  int column[2];
  float ninth[2];  ///< 2^16 q
  int word[8];
};

template <class B>
struct PackedRows {
  Indices<B> first;                                                         ///< [rows + 1] pairs
  Kokkos::View<PackedPair*, Kokkos::LayoutRight, typename B::Memory> pair;  ///< an odd row's last block is 0
  Scalars<B> scale;                                                         ///< t
};

/// t of a vertex; 1 where its own block is not positive.
template <class B>
struct ScaleOfVertex {
  BlockMatrix<B> A;
  Scalars<B> scale;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    const auto own = block_at<B>(A, A.diagonal(a));
    const auto most = Kokkos::max(own[0], Kokkos::max(own[1], own[2]));
    scale(a) = most > 0 ? Kokkos::sqrt(most / (0x1p16F * 32767)) : 1;
  }
};

/// A row of blocks, packed; numbers that are too large are cut: A is not positive definite, or multiplies a vertex whose motion is given.
template <class B>
struct PackRow {
  BlockMatrix<B> A;
  PackedRows<B> rows;

  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    int s = A.first(a);
    for (int i = rows.first(a); i < rows.first(a + 1); ++i, s += 2) {
      PackedPair& pair = rows.pair(i);
      const bool two = s + 1 < A.first(a + 1);
      pair.column[0] = A.column(s), pair.column[1] = two ? A.column(s + 1) : a;
      for (int k = 0; k < 8; ++k)
        pair.word[k] = static_cast<int>(static_cast<unsigned>(number(a, s, k)) << 16 |
                                        (two ? static_cast<unsigned>(number(a, s + 1, k)) & 0xffffU : 0U));
      pair.ninth[0] = static_cast<float>(number(a, s, 8)) * 0x1p16F;
      pair.ninth[1] = two ? static_cast<float>(number(a, s + 1, 8)) * 0x1p16F : 0;
    }
  }
  KOKKOS_INLINE_FUNCTION int number(int a, int s, int k) const {
    const float q = A.value(s, k) / (rows.scale(a) * rows.scale(A.column(s))) * 0x1p-16F;
    return static_cast<int>(Kokkos::round(Kokkos::fmin(Kokkos::fmax(q, -32767.0F), 32767.0F)));
  }
};

/// Row a of A x over t_a, from t x, which has a row more than A, that is not used. Per pair 48 bytes and 36 flops.
template <class B>
KOKKOS_INLINE_FUNCTION Vec3<float> packed_row_product(const PackedRows<B>& A, int a, const Vectors<B>& scaled) {
  const PackedPair *pair = A.pair.data() + A.first(a), *const end = A.pair.data() + A.first(a + 1);
  const auto at = [&](int b) { return scaled.data() + 3 * static_cast<std::ptrdiff_t>(b); };
  float ninth[2] = {};
#if (defined(__clang__) || __GNUC__ >= 12) && !defined(__CUDACC__)
  if constexpr (B::on_host) {
    typedef int Word __attribute__((vector_size(32)));
    typedef int Words __attribute__((vector_size(32), may_alias, aligned(alignof(int))));
    typedef float Eight __attribute__((vector_size(32)));
    typedef float Four __attribute__((vector_size(16), may_alias, aligned(alignof(float))));
    Eight upper = {}, lower = {};
    for (; pair < end; ++pair) {
      const float *const x = at(pair->column[0]), *const y = at(pair->column[1]);
      const Four u = *reinterpret_cast<const Four*>(x), v = *reinterpret_cast<const Four*>(y);
      const Word word = *reinterpret_cast<const Words*>(pair->word);
      upper += __builtin_convertvector(word & static_cast<int>(0xffff0000), Eight) *
               __builtin_shufflevector(u, u, 0, 0, 0, 1, 1, 1, 2, 2);
      lower += __builtin_convertvector(word << 16, Eight) * __builtin_shufflevector(v, v, 0, 0, 0, 1, 1, 1, 2, 2);
      ninth[0] += pair->ninth[0] * x[2], ninth[1] += pair->ninth[1] * y[2];
    }
    const Eight y = upper + lower;
    return {y[0] + y[3] + y[6], y[1] + y[4] + y[7], y[2] + y[5] + (ninth[0] + ninth[1])};
  }
#endif
  Vec3<float> y;
  for (; pair < end; ++pair)
    for (int i = 0; i < 2; ++i) {
      const float* const x = at(pair->column[i]);
      for (int k = 0; k < 8; ++k) {
        const unsigned word = static_cast<unsigned>(pair->word[k]);
        y[k % 3] += static_cast<float>(static_cast<int>(i == 0 ? word & 0xffff0000U : word << 16)) * x[k / 3];
      }
      ninth[i] += pair->ninth[i] * x[2];
    }
  y[2] += ninth[0] + ninth[1];
  return y;
}

}  // namespace plica
