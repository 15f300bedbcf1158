// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/matrices.hpp>
#include <plica/drivers/linear/host_pattern.hpp>
#include <plica/drivers/spaces/transfer_matrix.hpp>
#include <plica/kernels/linear/packed_rows.hpp>
#include <vector>

// Matrices of a V-cycle: of the next coarser level, and packed by slots.
namespace plica {

template <class B>
struct CoarseMatrix {
  HostPattern pattern;
  BlockMatrix<B> matrix;  ///< P^T A P, with all values 0
  GalerkinMap<B> map;
};

/// Order of the vertices in the slots of packed rows.
struct SlotOrder {
  std::vector<int> vertex;  ///< [slots] vertex of each slot; -1: none
  std::vector<int> slot;    ///< [vertices] slot of each vertex
};
/// Returns an order that within windows of slices puts the longest rows first.
/// Rows of a slice then have similar lengths, and few entries are filled up.
SlotOrder slot_order(const HostPattern& A, int height);
/// Returns the order in which every vertex has the slot of its own number.
SlotOrder plain_order(int vertices);

/// Allocates packed rows for a matrix of a pattern, in the order slot_order(A, height); for float.
template <class B>
PackedRows<B> packed_rows(const HostPattern& A, const SlotOrder& order);
/// Returns a matrix with its rows and columns numbered by slots.
RowMatrix by_slots(const RowMatrix& P, const SlotOrder& rows, const SlotOrder& columns);

/// Returns the pattern of P^T A P, and the map by which its blocks follow from those of A.
/// Each row has its own block in any case.
template <class B>
CoarseMatrix<B> coarse_matrix(const HostPattern& A, const RowMatrix& P);

}  // namespace plica
