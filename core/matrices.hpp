// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <plica/core/backend.hpp>

namespace plica {

/// A sparse matrix of numbers that acts on vectors, by rows in compressed form. Zeros fill a row up
/// to a multiple of four entries, because four are read together. The zeros come first and never
/// have the last column. Without columns rows are empty.
template <class B, class Value = typename B::Real>
struct SparseRows {
  int rows = 0;
  Indices<B> first;   ///< [rows + 1] into column and value
  Indices<B> column;  ///< column of each entry, ascending in a row
  Kokkos::View<Value*, Kokkos::LayoutRight, typename B::Memory> value;
};

/// A symmetric 3x3 block per row: the six numbers of a SymMat3.
template <class B>
using Blocks = Kokkos::View<typename B::Real* [6], Kokkos::LayoutRight, typename B::Memory>;
/// A 3x3 block per row.
template <class B>
using Blocks9 = Kokkos::View<typename B::Real* [9], Kokkos::LayoutRight, typename B::Memory>;

/// A vector per row, x y z 0. Rows that gather it read four numbers at once.
template <class B>
using Fours = Kokkos::View<typename B::Real* [4], Kokkos::LayoutRight, typename B::Memory>;

/// A square sparse matrix of 3x3 blocks, by rows in compressed form (block CSR). It is symmetric,
/// except in the columns of vertices whose row has its own block alone: their motion is given, or
/// another rank owns them.
///
/// Other vertices a < b have two blocks, (a, b) and (b, a) = (a, b)^T. Only (a, b) is stored, in
/// row a. The stored blocks of a row follow each other. First come the transposes of the blocks
/// left of its own in columns of vertices without a row, then its own block, then the blocks right
/// of it.
///
///   row a    (a, 3)  (a, 7)  (a, a)  (a, b)    value   ... | (a, a) (a, b) | ...
///            turned  turned   own              place   of (a, 3): where (3, a) is stored
///                                                      of (a, 7): where (7, a) is stored
template <class B>
struct BlockMatrix {
  int rows = 0;
  Indices<B> first;   ///< [rows + 1] into column and place
  Indices<B> column;  ///< column of each block, ascending in a row
  /// [rows] index of a row's own block in column and place
  Indices<B> diagonal;
  /// Place of each block in `value`; left of the own one it is stored transposed
  Indices<B> place;
  /// [stored + 1][9] blocks, column by column. The last one is a reserve: vectors of four numbers
  /// are read beyond the last number of a block
  Blocks9<B> value;

  int blocks() const { return static_cast<int>(column.extent(0)); }
  int stored() const { return static_cast<int>(value.extent(0)) - 1; }
  /// Returns number k of block s of row a.
  KOKKOS_INLINE_FUNCTION typename B::Real number(int a, int s, int k) const {
    return value(place(s), s < diagonal(a) ? k % 3 * 3 + k / 3 : k);
  }
  /// Returns true where block s is stored in row a, and not in the row of its column.
  KOKKOS_INLINE_FUNCTION bool is_stored(int a, int s) const {
    return s >= diagonal(a) || first(column(s) + 1) - first(column(s)) == 1;
  }
};

/// Map from the element matrices of Patches to a block matrix. It has the pairs (i < j) of a
/// patch's vertices that share a tetrahedron and are not both of given motion.
///
/// * patch p: pairs [first_pair(p), first_pair(p+1)); other patches have those from
///   first_shared(p) on, too
/// * pair s: blocks [first_slot(s), first_turned(s)) of `slot` as they are, then those up to
///   first_slot(s+1) transposed
/// * `place`: of block (i, j) in the matrix; of a shared pair among the shares
/// * shared block b: the sum of shares [first_share(b), first_share(b+1)), for `shared_place`
///
/// In each patch the pairs of it alone come first, then the shared ones. Within both, pairs of
/// equally many blocks follow each other.
template <class B>
struct PatchPairs {
  using Memory = typename B::Memory;
  int shares = 0;  ///< number of shares of all shared blocks
  Indices<B> first_pair, first_shared;
  Indices<B> first_slot;
  Indices<B> first_turned;
  /// Offset of a block among the patch's element blocks
  Kokkos::View<std::uint16_t*, Memory> slot;
  Indices<B> place;
  Indices<B> first_share;
  Indices<B> shared_place;
};

/// Blocks as constant sums over other blocks. Block k is the sum of weight * block n, over
/// [first(k), first(k+1)), with n = `block`. For n < 0 it is block -1 - n, transposed.
template <class B>
struct BlockTerms {
  Indices<B> first;
  Indices<B> block;
  Scalars<B> weight;

  int blocks() const { return static_cast<int>(first.extent(0)) - 1; }
};

/// Map from A to P^T A P. `right` makes the blocks of A P from the stored blocks of A. `left` makes
/// the stored blocks of P^T A P from those of A P.
template <class B>
struct GalerkinMap {
  BlockTerms<B> right, left;
  Blocks9<B> between;  ///< A P: the blocks that `left` asks for
};

}  // namespace plica
