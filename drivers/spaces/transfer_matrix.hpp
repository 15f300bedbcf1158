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

/// Returns the matrix that smooths values at a mesh's vertices, [vertices x vertices]. Each vertex
/// gets a weighted average over itself and its neighbours, by moving least squares of degree one
/// (Lancaster & Salkauskas 1981). Linear fields do not change. With s the distance over 1.2 times
/// the vertex's longest edge, the weight is the spline (1 - s)^2 (1 + 2 s). Vertices with fewer
/// than four neighbours, or whose |weights| would sum to more than 3, keep their value.
RowMatrix ring_smoothing(const TetMesh& mesh);

/// Returns the motion of all vertices from that of those which follow no others, [vertices x
/// vertices]: the identity, but for the rows of followers, which have the weights of their masters.
RowMatrix follower_matrix(const TetMesh& mesh);

/// Returns per vertex nonzero where its motion is given, or follows that of others.
std::vector<char> given_or_following(const TetMesh& mesh, std::vector<char> constrained);

/// Copies a sparse matrix to the device. Rows are filled up with zeros to multiples of 4 entries.
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

/// Returns the transfer P from a coarse mesh to a fine one, [fine vertices x coarse vertices]. It
/// has the weights of `up`, smoothed on the fine mesh if `smooth`. Rows and columns of vertices
/// whose motion is given, or follows that of others, are empty; weights up to 1e-6 are left out.
/// @param fine_constrained    per fine vertex, nonzero: its motion is given
/// @param coarse_constrained  per coarse vertex, nonzero: its motion is given
/// @param up                  embedding of the fine vertices in the coarse mesh
/// @param smooth              whether ring_smoothing() is applied
RowMatrix transfer_matrix(const TetMesh& fine, const std::vector<char>& fine_constrained,
                          const TetMesh& coarse, const std::vector<char>& coarse_constrained,
                          const Embedding& up, bool smooth);

}  // namespace plica
