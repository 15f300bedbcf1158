// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <plica/core/backend.hpp>

namespace plica {

/// A sparse matrix of numbers that acts on vectors, by rows in compressed form. A row is filled up
/// to four entries or a multiple by zeros, which come first and never have the last column: four
/// are read together. Without columns rows are empty.
template <class B, class Value = typename B::Real>
struct SparseRows {
  int rows = 0;
  Indices<B> first;   ///< [rows + 1] into the others
  Indices<B> column;  ///< of an entry, ascending in a row
  Kokkos::View<Value*, Kokkos::LayoutRight, typename B::Memory> value;
};

/// A symmetric 3x3 block per row: the six numbers of a SymMat3.
template <class B>
using Blocks = Kokkos::View<typename B::Real* [6], Kokkos::LayoutRight, typename B::Memory>;
/// A 3x3 block per row.
template <class B>
using Blocks9 = Kokkos::View<typename B::Real* [9], Kokkos::LayoutRight, typename B::Memory>;

/// A vector per row, x y z 0: rows that gather it read four numbers at once.
template <class B>
using Fours = Kokkos::View<typename B::Real* [4], Kokkos::LayoutRight, typename B::Memory>;

/// A square sparse matrix of 3x3 blocks, by rows in compressed form (block CSR). It is symmetric,
/// but for columns of vertices whose motion is given: their own rows have their own block alone.
///
/// Of the two blocks (a, b) and (b, a) = (a, b)^T of free vertices a < b one is stored, in row a. A
/// row's numbers follow each other: the transposes of blocks left of its own whose column is of a
/// given motion; its own; those right of it.
///
///   row a    (a, 3)  (a, 7)  (a, a)  (a, b)         place      of (a, 3): where (3, a) is stored; so of (a, 7)
///            turned  turned   own                   value      ... | (a, a) (a, b) | ...
template <class B>
struct BlockMatrix {
  int rows = 0;
  Indices<B> first;     ///< [rows + 1] into column and place
  Indices<B> column;    ///< of a block, ascending in a row
  Indices<B> diagonal;  ///< [rows] where a row's own block stands among them
  Indices<B> place;     ///< of a block in `value`; left of the own one it is stored transposed
  Blocks9<B> value;  ///< [stored + 1][9] column by column; the last one only lets vectors of four
                     ///< numbers be read to the end

  int blocks() const { return static_cast<int>(column.extent(0)); }
  int stored() const { return static_cast<int>(value.extent(0)) - 1; }
  /// Number k of block s of row a.
  KOKKOS_INLINE_FUNCTION typename B::Real number(int a, int s, int k) const {
    return value(place(s), s < diagonal(a) ? k % 3 * 3 + k / 3 : k);
  }
  /// Whether block s is stored in row a, and not in that of its column.
  KOKKOS_INLINE_FUNCTION bool is_stored(int a, int s) const {
    return s >= diagonal(a) || first(column(s) + 1) - first(column(s)) == 1;
  }
};

/// Where the element matrices of Patches go in a block matrix: the pairs (i < j) of a patch's
/// vertices that share a tetrahedron and are not both of given motion.
///
/// * patch p: pairs [first_pair(p), first_pair(p+1)), those from first_shared(p) on in other
/// patches too
/// * pair s: the blocks [first_slot(s), first_turned(s)) of `slot` as they are, then transposed
/// those up to first_slot(s+1)
/// * `place`: of block (i, j) in the matrix; of a shared pair among the shares
/// * shared block b: the sum of shares [first_share(b), first_share(b+1)), for `shared_place`
///
/// In a patch and among the shared ones or the others, pairs of equally many blocks follow each
/// other.
template <class B>
struct PatchPairs {
  using Memory = typename B::Memory;
  int shares = 0;  ///< in all shared blocks
  Indices<B> first_pair, first_shared;
  Indices<B> first_slot;
  Indices<B> first_turned;
  /// offset of a block among the patch's element blocks
  Kokkos::View<std::uint16_t*, Memory> slot;
  Indices<B> place;
  Indices<B> first_share;
  Indices<B> shared_place;
};

/// Blocks as constant sums over others: number k is the sum of weight * `block`, or of -1 - `block`
/// transposed, over [first(k), first(k+1)).
template <class B>
struct BlockTerms {
  Indices<B> first;
  Indices<B> block;
  Scalars<B> weight;

  int blocks() const { return static_cast<int>(first.extent(0)) - 1; }
};

/// How P^T A P follows from A: the blocks of A P from the stored ones of A, and what is stored of
/// P^T A P from these.
template <class B>
struct GalerkinMap {
  BlockTerms<B> right, left;
  Blocks9<B> between;  ///< A P: the blocks that `left` asks for
};

}  // namespace plica
