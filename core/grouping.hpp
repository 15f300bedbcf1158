// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <numeric>
#include <plica/core/mesh.hpp>
#include <plica/core/row_ranges.hpp>
#include <span>
#include <vector>

namespace plica {

/// Numbers 0, 1, ... sorted by group: one group after the other, ascending in each.
struct Grouping {
  std::vector<int> first, number;  ///< group g: number[first[g] ... first[g + 1] - 1]

  /// Sorts the numbers by their groups.
  /// @param group_of  group of each number; negative: the number is in no group
  Grouping(std::span<const int> group_of, std::size_t groups) : first(groups + 1, 0) {
    for (const int g : group_of)
      if (g >= 0) ++first[index_of(g) + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());
    number.resize(index_of(first.back()));
    std::vector<int> next = first;
    for (std::size_t i = 0; i < group_of.size(); ++i)
      if (group_of[i] >= 0) number[index_of(next[index_of(group_of[i])]++)] = static_cast<int>(i);
  }

  std::size_t groups() const { return first.size() - 1; }

  std::span<int> of(std::size_t g) {
    return std::span(number).subspan(index_of(first[g]), index_of(first[g + 1] - first[g]));
  }
  std::span<const int> of(std::size_t g) const {
    return std::span(number).subspan(index_of(first[g]), index_of(first[g + 1] - first[g]));
  }
};

/// Returns the tetrahedra of a mesh, sorted by region.
inline Grouping tets_by_region(const TetMesh& mesh) {
  if (mesh.region.empty()) return {std::vector<int>(mesh.tets.size(), 0), 1};
  return {mesh.region, index_of(*std::ranges::max_element(mesh.region)) + 1};
}

}  // namespace plica
