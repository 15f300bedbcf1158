// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/backend.hpp>

namespace plica {

/// A sparse matrix of numbers that acts on vectors, by rows in compressed form.
template <class B>
struct SparseRows {
  int rows = 0;
  Indices<B> first;   ///< [rows + 1] into the others
  Indices<B> column;  ///< of an entry
  Scalars<B> value;
};

}  // namespace plica
