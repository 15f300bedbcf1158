// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/sparse_rows.hpp>
#include <plica/drivers/solver/set_up/to_device.hpp>
#include <plica/drivers/solver/spaces/smoothing.hpp>

namespace plica {

/// A sparse matrix on the device.
template <class B>
SparseRows<B> sparse_rows(const std::string& name, const RowMatrix& A) {
  std::vector<int> first{0}, column;
  std::vector<typename B::Real> value;
  for (Eigen::Index a = 0; a < A.rows(); ++a) {
    for (RowMatrix::InnerIterator entry(A, a); entry; ++entry) {
      column.push_back(static_cast<int>(entry.col()));
      value.push_back(static_cast<typename B::Real>(entry.value()));
    }
    first.push_back(static_cast<int>(column.size()));
  }
  return {static_cast<int>(A.rows()), to_device<Indices<B>>(name + ".first", first),
          to_device<Indices<B>>(name + ".column", column), to_device<Scalars<B>>(name + ".value", value)};
}

template <class... Views>
std::size_t bytes_of_views(const Views&... views) {
  return (0 + ... + (views.span() * sizeof(typename Views::value_type)));
}

template <class B>
std::size_t bytes_of_rows(const SparseRows<B>& A) {
  return bytes_of_views(A.first, A.column, A.value);
}

}  // namespace plica
