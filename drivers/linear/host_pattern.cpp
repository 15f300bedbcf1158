// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/core/row_ranges.hpp>
#include <plica/core/to_device.hpp>
#include <plica/drivers/linear/host_pattern.hpp>
#include <utility>

namespace plica {

namespace {

template <class View>
std::vector<int> numbers(const View& view) {
  const auto host = on_host(view);
  return {host.data(), host.data() + host.extent(0)};
}

}  // namespace

HostPattern::HostPattern(std::vector<int> first_of_row, std::vector<int> columns)
    : first(std::move(first_of_row)), column(std::move(columns)), place(column.size()) {
  // [rows so far] next block right of the diagonal; rows below need these blocks one after the
  // other
  std::vector<int> next;
  for (int a = 0; a < rows(); ++a) {
    const auto begin = column.begin() + first[index_of(a)], end = begin + blocks_of_row(a);
    diagonal.push_back(static_cast<int>(std::lower_bound(begin, end, a) - column.begin()));
    next.push_back(diagonal.back() + 1);
    for (int s = first[index_of(a)]; s < first[index_of(a + 1)]; ++s) {
      const int b = column[index_of(s)];
      if (b >= a || blocks_of_row(b) == 1) {
        place[index_of(s)] = stored++;
        continue;
      }
      int& above = next[index_of(b)];
      while (column[index_of(above)] != a) ++above;
      place[index_of(s)] = place[index_of(above)];
    }
  }
}

template <class B>
HostPattern host_pattern(const BlockMatrix<B>& A) {
  return {numbers(A.first), numbers(A.column)};
}

template <class B>
BlockMatrix<B> block_matrix(const std::string& name, const HostPattern& pattern) {
  const auto indices = [&](const char* what, const std::vector<int>& values) {
    return to_device<Indices<B>>(name + what, values);
  };
  return {pattern.rows(),
          indices(".first", pattern.first),
          indices(".column", pattern.column),
          indices(".diagonal", pattern.diagonal),
          indices(".place", pattern.place),
          zeros<Blocks9<B>>("plica::" + name + ".value", index_of(pattern.stored + 1))};
}

#define PLICA_INSTANTIATE(Real, Exec)                                                              \
  template HostPattern host_pattern<Backend<Real, Exec>>(const BlockMatrix<Backend<Real, Exec>>&); \
  template BlockMatrix<Backend<Real, Exec>> block_matrix<Backend<Real, Exec>>(const std::string&,  \
                                                                              const HostPattern&);
PLICA_FOR_EACH_PRECISION(PLICA_INSTANTIATE)

}  // namespace plica
