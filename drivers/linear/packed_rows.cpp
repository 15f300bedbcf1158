// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <numeric>
#include <plica/core/row_ranges.hpp>
#include <plica/drivers/linear/multigrid_parts.hpp>

namespace plica {

SlotOrder plain_order(int vertices) {
  SlotOrder order;
  order.vertex.resize(index_of(vertices));
  std::iota(order.vertex.begin(), order.vertex.end(), 0);
  order.slot = order.vertex;
  return order;
}

SlotOrder slot_order(const HostPattern& A, int height) {
  SlotOrder order = plain_order(A.rows());
  const int window = 32 * height;
  for (int begin = 0; begin < A.rows(); begin += window)
    std::stable_sort(order.vertex.begin() + begin,
                     order.vertex.begin() + std::min(begin + window, A.rows()),
                     [&](int a, int b) { return A.blocks_of_row(a) > A.blocks_of_row(b); });
  for (int s = 0; s < A.rows(); ++s) order.slot[index_of(order.vertex[index_of(s)])] = s;
  order.vertex.resize(index_of((A.rows() + height - 1) / height * height), -1);
  return order;
}

template <class B>
PackedRows<B> packed_rows(const HostPattern& A, const SlotOrder& order) {
  constexpr int height = PackedRows<B>::height;
  using Pair = std::array<std::array<int, height>, 2>;
  PackedRows<B> rows;
  rows.slices = static_cast<int>(order.vertex.size()) / height;
  std::vector<int> first{0};
  std::vector<Pair> column;
  for (int q = 0; q < rows.slices; ++q) {
    const auto of_slice = order.vertex.begin() + q * height;
    int longest = 0;
    for (int l = 0; l < height; ++l)
      if (of_slice[l] >= 0) longest = std::max(longest, A.blocks_of_row(of_slice[l]));
    column.resize(column.size() + index_of((longest + 1) / 2));
    for (int l = 0; l < height; ++l)
      for (int j = 0; j < longest + longest % 2; ++j) {
        const int a = of_slice[l];
        const bool is_block = a >= 0 && j < A.blocks_of_row(a);
        column[index_of(first.back() + j / 2)][index_of(j % 2)][index_of(l)] =
            is_block ? order.slot[index_of(A.column[index_of(A.first[index_of(a)] + j)])]
                     : q * height + l;
      }
    first.push_back(static_cast<int>(column.size()));
  }
  rows.first = to_device<Indices<B>>("packed.first", first);
  rows.vertex = to_device<Indices<B>>("packed.vertex", order.vertex);
  rows.column = to_device<decltype(rows.column)>("packed.column", column);
  rows.word = zeros<decltype(rows.word)>("plica::packed.word", column.size());
  rows.scale = zeros<Scalars<B>>("plica::packed.scale", order.vertex.size());
  return rows;
}

RowMatrix by_slots(const RowMatrix& P, const SlotOrder& rows, const SlotOrder& columns) {
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index a = 0; a < P.rows(); ++a)
    for (RowMatrix::InnerIterator entry(P, a); entry; ++entry)
      entries.emplace_back(rows.slot[index_of(static_cast<int>(a))],
                           columns.slot[index_of(static_cast<int>(entry.col()))], entry.value());
  RowMatrix made(static_cast<Eigen::Index>(rows.vertex.size()),
                 static_cast<Eigen::Index>(columns.vertex.size()));
  made.setFromTriplets(entries.begin(), entries.end());
  return made;
}

#define PLICA_PACKED_ROWS(Exec)                                                                   \
  template PackedRows<Backend<float, Exec>> packed_rows<Backend<float, Exec>>(const HostPattern&, \
                                                                              const SlotOrder&);
PLICA_FOR_EACH_SPACE(PLICA_PACKED_ROWS)

}  // namespace plica
