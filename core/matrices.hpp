// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <plica/core/backend.hpp>

namespace plica {

/// A sparse matrix of numbers that acts on vectors, by rows in compressed form.
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

/// A square sparse matrix of 3x3 blocks, by rows in compressed form (block CSR). It is symmetric, but for columns of vertices whose motion
/// is given: their own rows are empty.
template <class B>
struct BlockMatrix {
  int rows = 0;
  Indices<B> first;     ///< [rows + 1] into the others
  Indices<B> column;    ///< of a block, ascending in a row
  Indices<B> diagonal;  ///< [rows] where a row's own block stands
  Blocks9<B>
      value;  ///< [blocks + 1][9] column by column; the last one only lets vectors of four numbers be read to the end

  int blocks() const { return static_cast<int>(column.extent(0)); }
};

/// Where the element matrices of Patches go in a block matrix: the pairs (i < j) of a patch's vertices that share a tetrahedron and
/// are not both of given motion.
///
/// * patch p: pairs [first_pair(p), first_pair(p+1)), those from first_shared(p) on in other patches too
/// * pair s: the blocks [first_slot(s), first_turned(s)) of `slot` as they are, then transposed those up to first_slot(s+1)
/// * `upper` and `lower`: the places of blocks (i, j) and (j, i) in the matrix, -1 where that row's motion is given; of a shared pair
///   `upper` is its place among the shares
/// * shared block b: the sum of shares [first_share(b), first_share(b+1)), for `shared_upper` and `shared_lower`
///
/// In a patch and among the shared ones or the others, pairs of equally many blocks follow each other.
template <class B>
struct PatchPairs {
  using Memory = typename B::Memory;
  int shares = 0;  ///< in all shared blocks
  Indices<B> first_pair, first_shared;
  Indices<B> first_slot;
  Indices<B> first_turned;
  Kokkos::View<std::uint16_t*, Memory> slot;  ///< offset of a block among the patch's element blocks
  Indices<B> upper, lower;
  Indices<B> first_share;
  Indices<B> shared_upper, shared_lower;
};

/// The blocks (I, J), I <= J, of P^T A P as constant sums over the blocks of A: block k = sum of weight * block `fine` of A over
/// [first(k), first(k+1)), to go to `upper` and, transposed, to `lower`.
template <class B>
struct GalerkinMap {
  Indices<B> first;
  Indices<B> fine;
  Scalars<B> weight;  ///< P_iI P_jJ
  Indices<B> upper, lower;

  int blocks() const { return static_cast<int>(upper.extent(0)); }
};

}  // namespace plica
