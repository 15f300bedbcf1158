// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstring>
#include <plica/core/matrices.hpp>
#include <plica/kernels/sliced_rows.hpp>
#include <plica/kernels/vectors.hpp>

// Symmetric matrix of 3x3 blocks in 16 bits a number, for preconditioners: an error of 2^-16 of the
// vertices' own stiffness does not affect a smoother. With scales t of the vertices,
//
//   A_ab = t_a t_b 2^16 q_ab,   |q_ab| < 2^15,
//   t_a^2 2^16 (2^15 - 1) = the largest number on the diagonal of A_aa
//
// because no number of a positive definite matrix is above the root of the product of its two
// diagonal numbers. Products take the scaled vector t x, so that scales cost nothing in the sum.
// Blocks of a row come in pairs: number k of both in one word, the first in its upper half. Either
// half, with zeros below it, is 2^16 q as an integer.
//
// Rows are stored in slices, a row per lane (kernels/sliced_rows.hpp), and so are the vectors that
// a smoother works on. Only vectors that other rows gather are stored vertex by vertex, with four
// numbers each, the last of which is 0. For float on AVX-512, which has 16 lanes:
//
//   entry e of a slice     column of 16 rows, twice    word 0 of 16 rows  ...  word 8 of 16 rows
//   a vector by slots      x of 16 rows    y of 16 rows    z of 16 rows
//   a gathered vector      x y z 0   x y z 0   x y z 0   ...
namespace plica {

template <class B>
struct PackedRows {
  static constexpr int height = slice_height<B>;
  template <class T>
  using Array = Kokkos::View<T, Kokkos::LayoutRight, typename B::Memory>;

  int slices = 0;
  Indices<B> first;                ///< [slices + 1] pairs of blocks
  Indices<B> vertex;               ///< [slots] -1: none
  Array<int* [2][height]> column;  ///< slots; entries that fill up a row point to the row itself
  Array<int* [9][height]> word;
  Scalars<B> scale;  ///< [slots] t

  int slots() const { return slices * height; }
  int items() const { return slots() / B::lanes; }  ///< work items of RowsAt
};

/// Vectors by slots, component by component: [slices][3][rows of a slice].
template <class B>
using SlotVectors =
    Kokkos::View<typename B::Real* [3][slice_height<B>], Kokkos::LayoutRight, typename B::Memory>;
/// Symmetric blocks by slots, component by component: [slices][6][rows of a slice].
template <class B>
using SlotBlocks =
    Kokkos::View<typename B::Real* [6][slice_height<B>], Kokkos::LayoutRight, typename B::Memory>;

template <class B>
KOKKOS_INLINE_FUNCTION Vec3<RowPack<B>> vectors_at(const SlotVectors<B>& x, const RowsAt<B>& at) {
  const typename B::Real* const from = &x(at.slice, 0, at.offset);
  return {load_rows<B>(from), load_rows<B>(from + slice_height<B>),
          load_rows<B>(from + 2 * slice_height<B>)};
}
template <class B>
KOKKOS_INLINE_FUNCTION void set_vectors(const SlotVectors<B>& x, const RowsAt<B>& at,
                                        const Vec3<RowPack<B>>& value) {
  for (int k = 0; k < 3; ++k) store_rows<B>(value[k], &x(at.slice, k, at.offset));
}
template <class B>
KOKKOS_INLINE_FUNCTION SymMat3<RowPack<B>> blocks_at(const SlotBlocks<B>& d, const RowsAt<B>& at) {
  SymMat3<RowPack<B>> block;
  for (int k = 0; k < 6; ++k) block[k] = load_rows<B>(&d(at.slice, k, at.offset));
  return block;
}
template <class B>
KOKKOS_INLINE_FUNCTION Vec3<RowPack<B>> fours_at(const Fours<B>& x, const RowsAt<B>& at) {
  const typename B::Real* const from = &x(at.slot, 0);
  Vec3<RowPack<B>> value;
  load_vectors([=](int l) { return from + 4 * l; }, value);
  return value;
}
template <class B>
KOKKOS_INLINE_FUNCTION void set_fours(const Fours<B>& x, const RowsAt<B>& at,
                                      const Vec3<RowPack<B>>& value) {
  typename B::Real* const to = &x(at.slot, 0);
  const RowPack<B> four[4] = {value[0], value[1], value[2], RowPack<B>(0)};
  store_fours(four, [=](int l) { return to + 4 * l; });
}
/// Sets the vector of one slot.
template <class B>
KOKKOS_INLINE_FUNCTION void set_vector(const SlotVectors<B>& x, int slot,
                                       const Vec3<typename B::Real>& value) {
  for (int k = 0; k < 3; ++k) x(slot / slice_height<B>, k, slot % slice_height<B>) = value[k];
}

/// Computes the scale t of a vertex; 1 where its own block is not positive.
template <class B>
struct ScaleOfVertex {
  BlockMatrix<B> A;
  PackedRows<B> rows;
  KOKKOS_INLINE_FUNCTION void operator()(int slot) const {
    const int a = rows.vertex(slot);
    const auto own = a >= 0 ? own_block<B>(A, a) : SymMat3<float>{};
    const auto most = Kokkos::max(own[0], Kokkos::max(own[1], own[2]));
    rows.scale(slot) = most > 0 ? Kokkos::sqrt(most / (0x1p16F * 32767)) : 1;
  }
};

/// Packs a row of blocks. Numbers that are too large are cut: there A is not positive definite, or
/// the number multiplies a vertex whose motion is given.
template <class B>
struct PackRow {
  BlockMatrix<B> A;
  PackedRows<B> rows;

  KOKKOS_INLINE_FUNCTION void operator()(int slot) const {
    const int a = rows.vertex(slot), q = slot / rows.height, l = slot % rows.height;
    if (a < 0) return;
    const int last = A.first(a + 1);
    for (int e = rows.first(q), s = A.first(a); s < last; ++e, s += 2) {
      const float t = rows.scale(slot), upper = t * rows.scale(rows.column(e, 0, l)),
                  lower = t * rows.scale(rows.column(e, 1, l));
      for (int k = 0; k < 9; ++k)
        rows.word(e, k, l) =
            static_cast<int>(number(a, s, k, upper) << 16 |
                             (s + 1 < last ? number(a, s + 1, k, lower) & 0xffffU : 0U));
    }
  }
  KOKKOS_INLINE_FUNCTION unsigned number(int a, int s, int k, float scale) const {
    const float q = A.number(a, s, k) / scale * 0x1p-16F;
    return static_cast<unsigned>(
        static_cast<int>(Kokkos::round(Kokkos::fmin(Kokkos::fmax(q, -32767.0F), 32767.0F))));
  }
};

/// Unpacks both halves of a word, times 2^16.
template <class T>
KOKKOS_INLINE_FUNCTION void unpack(const int* word, T& upper, T& lower) {
#if (defined(__clang__) || __GNUC__ >= 12) && !defined(__CUDACC__)
  if constexpr (LaneOf<T>::count > 1) {
    typename Pack<int, LaneOf<T>::count>::Lanes both;
    std::memcpy(&both, word, sizeof both);
    upper.v = __builtin_convertvector(both & static_cast<int>(0xffff0000), typename T::Lanes);
    lower.v = __builtin_convertvector(both << 16, typename T::Lanes);
    return;
  }
#endif
  for (int l = 0; l < LaneOf<T>::count; ++l) {
    const unsigned both = static_cast<unsigned>(word[l]);
    set_lane(upper, l, static_cast<float>(static_cast<int>(both & 0xffff0000U)));
    set_lane(lower, l, static_cast<float>(static_cast<int>(both << 16)));
  }
}

/// Returns rows of A x divided by their t, from t x. Per pair of blocks 44 bytes and 36 flops.
template <class B>
KOKKOS_INLINE_FUNCTION Vec3<RowPack<B>> packed_product(const PackedRows<B>& A, const RowsAt<B>& at,
                                                       const Fours<B>& scaled) {
  constexpr int height = PackedRows<B>::height;
  const typename B::Real* const base = scaled.data();
  Vec3<RowPack<B>> even, odd;
  for (int e = A.first(at.slice); e < A.first(at.slice + 1); ++e) {
    const int *const column = &A.column(e, 0, at.offset), *const word = &A.word(e, 0, at.offset);
    Vec3<RowPack<B>> x, y;
    load_vectors([=](int l) { return base + 4 * static_cast<std::ptrdiff_t>(column[l]); }, x);
    load_vectors([=](int l) { return base + 4 * static_cast<std::ptrdiff_t>(column[height + l]); },
                 y);
    for (int k = 0; k < 9; ++k) {
      RowPack<B> upper, lower;
      unpack(word + k * height, upper, lower);
      even[k % 3] += upper * x[k / 3], odd[k % 3] += lower * y[k / 3];
    }
  }
  return even + odd;
}

}  // namespace plica
