// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/grouping.hpp>
#include <plica/core/patches.hpp>
#include <plica/core/to_device.hpp>
#include <span>

namespace plica {

/// Returns for each vertex the rows of a kernel's sums that belong to it.
/// @param vertex_of_row  vertex of each row; negative: the row belongs to none
template <class B>
VertexShares<B> vertex_shares(std::span<const int> vertex_of_row, std::size_t vertices) {
  const Grouping rows(vertex_of_row, vertices);
  return {static_cast<int>(vertex_of_row.size()), to_device<Indices<B>>("shares.first", rows.first),
          to_device<Indices<B>>("shares.row", rows.number)};
}

}  // namespace plica
