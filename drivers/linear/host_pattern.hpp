// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/matrices.hpp>
#include <string>
#include <vector>

namespace plica {

/// Which blocks a matrix has and where they are stored, on the host: see BlockMatrix.
struct HostPattern {
  std::vector<int> first{0}, column, diagonal, place;
  int stored = 0;  ///< blocks

  HostPattern() = default;
  /// @param first, column  rows whose columns ascend, their own one always among them
  HostPattern(std::vector<int> first, std::vector<int> column);
  /// No blocks.
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

template <class B>
HostPattern host_pattern(const BlockMatrix<B>& A);
/// Its values are zero.
template <class B>
BlockMatrix<B> block_matrix(const std::string& name, const HostPattern& pattern);

}  // namespace plica
