// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <plica/core/fields.hpp>
#include <plica/core/matrices.hpp>
#include <plica/core/mesh.hpp>
#include <plica/drivers/spaces/row_matrix.hpp>
#include <plica/meshes/embedding.hpp>
#include <vector>

namespace plica {

/// Values at a mesh's vertices smoothed over their edges, [vertices x vertices]: each vertex takes
/// a weighted average over itself and its neighbours, by moving least squares of degree one
/// (Lancaster & Salkauskas 1981), so that linear fields stay as they are. The weight is the spline
/// (1 - s)^2 (1 + 2 s) of the distance over 1.2 times the vertex's longest edge. Vertices with too
/// few neighbours, or whose weights would grow beyond 3, keep their value.
RowMatrix ring_smoothing(const TetMesh& mesh);

/// A sparse matrix on the device.
template <class B, class Value = typename B::Real>
SparseRows<B, Value> sparse_rows(const std::string& name, const RowMatrix& A) {
  std::vector<int> first{0}, column;
  std::vector<Value> value;
  for (Eigen::Index row = 0; row < A.rows(); ++row) {
    const auto begin = column.size();
    for (RowMatrix::InnerIterator entry(A, row); entry; ++entry)
      column.push_back(static_cast<int>(entry.col())),
          value.push_back(static_cast<Value>(entry.value()));
    const auto entries = column.size() - begin;
    const auto fill = A.cols() == 0 ? 0 : entries == 0 ? 4 : (4 - entries % 4) % 4;
    const int beside =
        std::max(0, std::min(entries == 0 ? 0 : column[begin], static_cast<int>(A.cols()) - 2));
    column.insert(column.begin() + static_cast<std::ptrdiff_t>(begin), fill, beside);
    value.insert(value.begin() + static_cast<std::ptrdiff_t>(begin), fill, Value(0));
    first.push_back(static_cast<int>(column.size()));
  }
  return {static_cast<int>(A.rows()), to_device<Indices<B>>(name + ".first", first),
          to_device<Indices<B>>(name + ".column", column),
          to_device<decltype(SparseRows<B, Value>::value)>(name + ".value", value)};
}

template <class... Views>
std::size_t bytes_of_views(const Views&... views) {
  return (0 + ... + (views.span() * sizeof(typename Views::value_type)));
}

template <class B, class Value>
std::size_t bytes_of_rows(const SparseRows<B, Value>& A) {
  return bytes_of_views(A.first, A.column, A.value);
}

/// P, [fine vertices x coarse vertices]: the fine vertices' places in the coarse mesh, `up`,
/// smoothed on the fine mesh where asked for. Vertices whose motion is given (`constrained`, one
/// per vertex) have no part in it; neither have weights below 1e-6.
RowMatrix transfer_matrix(const TetMesh& fine, const std::vector<char>& fine_constrained,
                          const TetMesh& coarse, const std::vector<char>& coarse_constrained,
                          const Embedding& up, bool smooth);

}  // namespace plica
