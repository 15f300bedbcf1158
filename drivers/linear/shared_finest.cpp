// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <numeric>
#include <plica/core/row_ranges.hpp>
#include <plica/core/to_device.hpp>
#include <plica/drivers/level/rank_lists.hpp>
#include <plica/drivers/linear/rows_of_sums.hpp>
#include <plica/drivers/linear/shared_finest.hpp>
#include <plica/kernels/linear/chebyshev.hpp>
#include <plica/kernels/linear/vertex_blocks.hpp>
#include <utility>

namespace plica {

namespace {

/// Numbers for each rank, and from each.
using ByRanks = std::vector<std::vector<int>>;

ByRanks for_each_rank(const Ranks& ranks) { return ByRanks(index_of(ranks.count())); }

/// Computes r of each slot of the next level from what all ranks restricted; 0 where it has no
/// vertex.
template <class B, class To>
struct PlaceRestricted {
  Scalars<B> from;
  Indices<B> place;
  To r;
  KOKKOS_INLINE_FUNCTION void operator()(int slot) const {
    Vec3<typename B::Real> value;
    if (const int at = place(slot); at >= 0)
      for (int k = 0; k < 3; ++k) value[k] = from(3 * at + k);
    set_vector<B>(r, slot, value);
  }
};

}  // namespace

template <class B>
SharedGalerkin<B>::SharedGalerkin(Ranks& ranks, const RankPart& part, const HostPattern& A,
                                  const RowMatrix& P, const RowsByRank& coarse) {
  RowsOfSums<B> AP = right_product<B>(A, P, {part.first_owned, part.last_owned, part.vertex});
  right_ = AP.terms;
  // rows of A P that the own rows of P^T A P read
  const int first_own = part.first[index_of(ranks.own())];
  std::vector<char> reads(static_cast<std::size_t>(P.rows()), 0);
  for (const int a : coarse.read_by_own()) reads[index_of(a)] = 1;
  ByRanks asked = for_each_rank(ranks);
  for (std::size_t a = 0; a < reads.size(); ++a)
    if (const int q = owner_in(part.first, static_cast<int>(a)); reads[a] && q != ranks.own())
      asked[index_of(q)].push_back(static_cast<int>(a));
  // each rank answers with the columns of its rows
  const ByRanks wanted = exchange_numbers(ranks, asked);
  ByRanks counts = for_each_rank(ranks), columns = counts;
  HaloRows rows;
  rows.own = AP.first.back();
  std::vector<int> sent_to;  // [ranks + 1] into rows.sent
  for (std::size_t q = 0; q < wanted.size(); ++q) {
    sent_to.push_back(static_cast<int>(rows.sent.size()));
    for (const int a : wanted[q]) {
      const auto row = index_of(a - first_own);
      counts[q].push_back(AP.first[row + 1] - AP.first[row]);
      for (int s = AP.first[row]; s < AP.first[row + 1]; ++s)
        columns[q].push_back(AP.column[index_of(s)]), rows.sent.push_back(s);
    }
  }
  sent_to.push_back(static_cast<int>(rows.sent.size()));
  const ByRanks their_counts = exchange_numbers(ranks, counts),
                their_columns = exchange_numbers(ranks, columns);
  std::vector<int> row_of(static_cast<std::size_t>(P.rows()), -1);
  for (int i = 0; i < part.owned(); ++i) row_of[index_of(first_own + i)] = i;
  for (std::size_t q = 0; q < asked.size(); ++q) {
    for (std::size_t i = 0; i < asked[q].size(); ++i) {
      row_of[index_of(asked[q][i])] = static_cast<int>(AP.first.size()) - 1;
      AP.first.push_back(AP.first.back() + their_counts[q][i]);
    }
    AP.column.insert(AP.column.end(), their_columns[q].begin(), their_columns[q].end());
    if (wanted[q].empty() && asked[q].empty()) continue;
    rows.rank.push_back(static_cast<int>(q));
    rows.first_sent.push_back(sent_to[q + 1]);
    rows.first_received.push_back(AP.first.back() - rows.own);
  }
  between_ = unset<Blocks9<B>>("plica::galerkin.between", AP.column.size());
  halo_ = std::make_unique<Halo<B>>(ranks, "rows of A P", std::move(rows), std::vector{9});
  const RowsOfSums<B> half =
      left_product<B>(coarse.matrix, {AP.first, AP.column, std::move(row_of)}, &coarse.own);
  left_ = half.terms;
  half_ = RowsOfAll<B>(ranks, "blocks of P^T A P", half.first.back(), 9);
  gather_pattern(ranks, half.first, half.column, coarse);
}

/// Finds the pattern of the whole matrix from the rows that each rank makes.
template <class B>
void SharedGalerkin<B>::gather_pattern(Ranks& ranks, const std::vector<int>& first,
                                       const std::vector<int>& column, const RowsByRank& coarse) {
  std::vector<int> counts;
  for (std::size_t i = 0; i + 1 < first.size(); ++i) counts.push_back(first[i + 1] - first[i]);
  std::vector<int> begin{0}, columns;  // by rank
  for (const std::vector<int>& its : values_of_all(ranks, counts))
    for (const int count : its) begin.push_back(begin.back() + count);
  for (const std::vector<int>& its : values_of_all(ranks, column))
    columns.insert(columns.end(), its.begin(), its.end());
  std::vector<int> first_of_all{0}, all, place;
  for (const int at : coarse.place) {
    for (int s = begin[index_of(at)]; s < begin[index_of(at + 1)]; ++s)
      all.push_back(columns[index_of(s)]), place.push_back(s);
    first_of_all.push_back(static_cast<int>(all.size()));
  }
  pattern_ = both_halves(first_of_all, all);
  place_ = to_device<Indices<B>>("galerkin.place", place);
}

template <class B>
void SharedGalerkin<B>::operator()(const Exec& exec, const BlockMatrix<B>& A,
                                   const BlockMatrix<B>& coarse) const {
  update_vertices<B>(exec, "plica::galerkin", right_.blocks(),
                     SumOfBlocks<B>{right_, A.value, between_});
  halo_->exchange(exec, between_.data(), 9);
  update_vertices<B>(
      exec, "plica::galerkin", left_.blocks(),
      SumOfBlocks<B>{left_, between_, Blocks9<B>(half_.own(), index_of(left_.blocks()))});
  half_.exchange(exec);
  using Real = typename B::Real;
  update_vertices<B>(
      exec, "plica::galerkin", static_cast<int>(place_.extent(0)),
      PackRows<Real, Indices<B>>{half_.all().data(), place_, coarse.value.data(), 9});
}

namespace {

/// Sorts the local vertices that are sent to each rank, and the own ones, by their slots. Returns
/// the vertices of the whole mesh that the rank reads, in the order in which it has them.
std::vector<int> sort_by_slots(Ranks& ranks, const RankPart& part, const std::vector<int>& slot,
                               ReadVertices& read) {
  const auto by_slot = [&](int v) { return slot[index_of(v)]; };
  std::ranges::sort(read.own, {}, by_slot);
  ByRanks order = for_each_rank(ranks);
  HaloRows& rows = read.rows;
  for (std::size_t n = 0; n < rows.rank.size(); ++n) {
    const std::span its(rows.sent.begin() + rows.first_sent[n],
                        rows.sent.begin() + rows.first_sent[n + 1]);
    std::ranges::sort(its, {}, by_slot);
    for (const int v : its) order[index_of(rows.rank[n])].push_back(part.vertex[index_of(v)]);
  }
  for (const int v : read.own) order[index_of(ranks.own())].push_back(part.vertex[index_of(v)]);
  std::vector<int> vertex;
  for (const std::vector<int>& its : exchange_numbers(ranks, order))
    vertex.insert(vertex.end(), its.begin(), its.end());
  return vertex;
}

}  // namespace

template <class B>
SharedRestriction<B>::SharedRestriction(Ranks& ranks, const RankPart& part,
                                        const RowsByRank& coarse, const SlotOrder& fine,
                                        const std::vector<int>& vertex) {
  ReadVertices read = read_vertices(ranks, part, coarse.read_by_own());
  const std::vector<int> order = sort_by_slots(ranks, part, fine.slot, read);
  std::vector<int> place_of(static_cast<std::size_t>(coarse.matrix.cols()), -1);
  for (std::size_t i = 0; i < order.size(); ++i) place_of[index_of(order[i])] = static_cast<int>(i);
  std::vector<std::vector<std::pair<int, double>>> down;
  for (const int i : coarse.own) {
    auto& row = down.emplace_back();
    for (RowMatrix::InnerIterator a(coarse.matrix, i); a; ++a)
      row.emplace_back(place_of[static_cast<std::size_t>(a.col())], a.value());
    std::ranges::sort(row);
  }
  // a field of one row is read in another way than longer ones, which one process has
  const auto n = static_cast<Eigen::Index>(std::max<std::size_t>(2, order.size()));
  down_ = sparse_rows<B>("multigrid.down", matrix_of_rows(down, n));
  read_ = zeros<Fours<B>>("plica::multigrid.read", n);
  const auto to_slots = [&](std::vector<int>& local) {
    for (int& v : local) v = fine.slot[index_of(v)];
  };
  to_slots(read.own), to_slots(read.rows.sent);
  own_ = to_device<Indices<B>>("multigrid.own", read.own);
  before_ = read.rows.before;
  halo_ = std::make_unique<Halo<B>>(ranks, "residuals to restrict", std::move(read.rows),
                                    std::vector{4});
  restricted_ = RowsOfAll<B>(ranks, "restricted residuals", static_cast<int>(coarse.own.size()), 3);
  std::vector<int> place;
  for (const int v : vertex) place.push_back(v < 0 ? -1 : coarse.place[index_of(v)]);
  place_ = to_device<Indices<B>>("multigrid.place", place);
}

template <class B>
template <class To>
void SharedRestriction<B>::operator()(const Exec& exec, const Fours<B>& residual,
                                      const To& r) const {
  using Real = typename B::Real;
  update_vertices<B>(
      exec, "plica::gather_own", static_cast<int>(own_.extent(0)),
      PackRows<Real, Indices<B>>{residual.data(), own_, read_.data() + 4 * before_, 4});
  halo_->exchange(exec, residual.data(), read_.data(), 4);
  update_vertices<B>(exec, "plica::restrict_residual", down_.rows,
                     RestrictFours<B, Vectors<B>>{
                         down_, read_, Vectors<B>(restricted_.own(), index_of(down_.rows))});
  restricted_.exchange(exec);
  update_vertices<B>(exec, "plica::place_restricted", static_cast<int>(place_.extent(0)),
                     PlaceRestricted<B, To>{restricted_.all(), place_, r});
}

SlotOrder slot_order(const HostPattern& A, int height, const RankPart& part, bool plain) {
  const int first = part.first_owned, last = part.last_owned, n = A.rows();
  const auto whole = [&](int count) { return (count + height - 1) / height * height; };
  SlotOrder order = plain_order(n);
  if (plain) {
    for (int a = 0; a < n; ++a)
      if (!part.owns(a)) order.vertex[index_of(a)] = -1;
    order.vertex.resize(index_of(whole(n)), -1);
    return order;
  }
  const int begin = whole(first), end = begin + whole(last - first);
  const int window = 32 * height;
  for (int from = first; from < last; from += window)
    std::stable_sort(order.vertex.begin() + from,
                     order.vertex.begin() + std::min(from + window, last),
                     [&](int a, int b) { return A.blocks_of_row(a) > A.blocks_of_row(b); });
  std::vector<int> vertex(index_of(whole(end + n - last)), -1);
  for (int i = first; i < last; ++i) {
    const int v = order.vertex[index_of(i)], slot = begin + i - first;
    vertex[index_of(slot)] = v, order.slot[index_of(v)] = slot;
  }
  for (int v = last; v < n; ++v) order.slot[index_of(v)] = end + v - last;
  order.vertex = std::move(vertex);
  return order;
}

HaloRows rows_by_slots(HaloRows vertices, const RankPart& part, const SlotOrder& order) {
  for (int& row : vertices.sent) row = order.slot[index_of(row)];
  if (part.last_owned < static_cast<int>(order.slot.size()))
    vertices.own = order.slot[index_of(part.last_owned)] - vertices.before;
  return vertices;
}

RowNumbers numbers_of_blocks(Ranks& ranks, const RankPart& part, const std::vector<char>& given,
                             const HostPattern& A) {
  const auto stored = index_of(A.stored);
  RowNumbers made{std::vector<int>(stored + 1, -1), std::vector<char>(stored + 1, 0)};
  // stored blocks of own rows in their order, and blocks that the rows of other ranks store
  int own = 0;
  ByRanks asked = for_each_rank(ranks);
  std::vector<std::vector<int>> place_of_asked(asked.size());
  for (int a = part.first_owned; a < part.last_owned; ++a)
    for (int s = A.first[index_of(a)]; s < A.first[index_of(a + 1)]; ++s) {
      const int b = A.column[index_of(s)], place = A.place[index_of(s)];
      if (b >= a || given[index_of(b)]) {
        made.number[index_of(place)] = own++, made.is_own[index_of(place)] = 1;
      } else if (!part.owns(b)) {
        const auto q = index_of(part.owner[index_of(b)]);
        asked[q].push_back(part.vertex[index_of(b)]), asked[q].push_back(part.vertex[index_of(a)]);
        place_of_asked[q].push_back(place);
      }
    }
  int before = 0;
  const ByRanks counts = values_of_all(ranks, std::vector{own});
  for (int q = 0; q < ranks.count(); ++q) {
    if (q < ranks.own()) before += counts[index_of(q)].front();
    made.all += index_of(counts[index_of(q)].front());
  }
  for (int& number : made.number)
    if (number >= 0) number += before;
  const auto local = [&](int v) {
    return static_cast<int>(std::ranges::lower_bound(part.vertex, v) - part.vertex.begin());
  };
  ByRanks wanted = exchange_numbers(ranks, asked), answers = for_each_rank(ranks);
  for (std::size_t q = 0; q < wanted.size(); ++q)
    for (std::size_t i = 0; i < wanted[q].size(); i += 2) {
      const auto row = index_of(local(wanted[q][i]));
      const auto begin = A.column.begin() + A.first[row], end = A.column.begin() + A.first[row + 1];
      const auto block = std::lower_bound(begin, end, local(wanted[q][i + 1])) - A.column.begin();
      answers[q].push_back(made.number[index_of(A.place[static_cast<std::size_t>(block)])]);
    }
  const ByRanks numbers = exchange_numbers(ranks, answers);
  for (std::size_t q = 0; q < numbers.size(); ++q)
    for (std::size_t i = 0; i < numbers[q].size(); ++i)
      made.number[index_of(place_of_asked[q][i])] = numbers[q][i];
  // the reserve behind the last block
  made.number.back() = static_cast<int>(made.all++), made.is_own.back() = ranks.own() == 0;
  return made;
}

#define PLICA_SHARED_FINEST(Exec)                                                                \
  template class SharedGalerkin<Backend<float, Exec>>;                                           \
  template class SharedRestriction<Backend<float, Exec>>;                                        \
  template void SharedRestriction<Backend<float, Exec>>::operator()(                             \
      const Exec&, const Fours<Backend<float, Exec>>&, const Vectors<Backend<float, Exec>>&)     \
      const;                                                                                     \
  template void SharedRestriction<Backend<float, Exec>>::operator()(                             \
      const Exec&, const Fours<Backend<float, Exec>>&, const SlotVectors<Backend<float, Exec>>&) \
      const;
PLICA_FOR_EACH_SPACE(PLICA_SHARED_FINEST)

}  // namespace plica
