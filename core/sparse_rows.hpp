// SPDX-License-Identifier: BSD-3-Clause
#pragma once
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

}  // namespace plica
