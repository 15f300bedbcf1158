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
/// @tparam Number  type of the numbers, which holds their count
template <class Number>
struct GroupingOf {
  std::vector<Number> first, number;  ///< group g: number[first[g] ... first[g + 1] - 1]

  /// Sorts the numbers by their groups.
  /// @param group_of  group of each number; negative: the number is in no group
  GroupingOf(std::span<const int> group_of, std::size_t groups) : first(groups + 1, 0) {
    for (const int g : group_of)
      if (g >= 0) ++first[index_of(g) + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());
    number.resize(place(first.back()));
    std::vector<Number> next = first;
    for (std::size_t i = 0; i < group_of.size(); ++i)
      if (group_of[i] >= 0) number[place(next[index_of(group_of[i])]++)] = static_cast<Number>(i);
  }

  std::size_t groups() const { return first.size() - 1; }

  std::span<Number> of(std::size_t g) {
    return std::span(number).subspan(place(first[g]), place(first[g + 1] - first[g]));
  }
  std::span<const Number> of(std::size_t g) const {
    return std::span(number).subspan(place(first[g]), place(first[g + 1] - first[g]));
  }

 private:
  static std::size_t place(Number n) { return static_cast<std::size_t>(n); }
};
/// Vertices, tetrahedra or other items that `int` can count, sorted by group.
using Grouping = GroupingOf<int>;

/// Returns the tetrahedra of a mesh, sorted by region.
inline Grouping tets_by_region(const TetMesh& mesh) {
  if (mesh.region.empty()) return {std::vector<int>(mesh.tets.size(), 0), 1};
  return {mesh.region, index_of(*std::ranges::max_element(mesh.region)) + 1};
}

}  // namespace plica
