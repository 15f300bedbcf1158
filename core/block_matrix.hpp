// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/backend.hpp>

namespace plica {

/// A symmetric 3x3 block per row: the six numbers of a SymMat3.
template <class B>
using Blocks = Kokkos::View<typename B::Real* [6], Kokkos::LayoutRight, typename B::Memory>;
/// A 3x3 block per row.
template <class B>
using Blocks9 = Kokkos::View<typename B::Real* [9], Kokkos::LayoutRight, typename B::Memory>;

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

}  // namespace plica
