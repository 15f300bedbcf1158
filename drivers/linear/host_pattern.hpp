// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/matrices.hpp>
#include <string>
#include <vector>

namespace plica {

/// Pattern of a matrix on the host: its blocks, and where they are stored; see BlockMatrix.
struct HostPattern {
  std::vector<int> first{0}, column, diagonal, place;
  int stored = 0;  ///< number of stored blocks

  HostPattern() = default;
  /// Makes the pattern of a matrix with these rows.
  /// @param first, column  rows whose columns ascend; each row has its own column
  HostPattern(std::vector<int> first, std::vector<int> column);
  /// Returns a pattern without blocks.
  static HostPattern empty(int rows) {
    HostPattern pattern;
    pattern.first.resize(static_cast<std::size_t>(rows) + 1, 0);
    return pattern;
  }

  int rows() const { return static_cast<int>(first.size()) - 1; }
  int blocks_of_row(int a) const {
    return first[static_cast<std::size_t>(a) + 1] - first[static_cast<std::size_t>(a)];
  }
};

/// Copies the pattern of a matrix to the host.
template <class B>
HostPattern host_pattern(const BlockMatrix<B>& A);
/// Returns a matrix of a pattern, with all values 0.
template <class B>
BlockMatrix<B> block_matrix(const std::string& name, const HostPattern& pattern);

}  // namespace plica
