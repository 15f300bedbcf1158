// SPDX-License-Identifier: BSD-3-Clause
#include <plica/core/to_device.hpp>
#include <plica/drivers/level/rank_lists.hpp>
#include <plica/drivers/level/shared_product.hpp>
#include <plica/drivers/spaces/transfer_matrix.hpp>
#include <plica/kernels/transfer/transfer.hpp>
#include <utility>

namespace plica {

template <class B>
RowsOfAll<B>::RowsOfAll(Ranks& ranks, const std::string& what, int own, int width) : width_(width) {
  const auto counts = values_of_all(ranks, std::vector{own});
  HaloRows rows;
  rows.own = own;
  int all = 0;
  for (int q = 0; q < ranks.count(); ++q) {
    const int its = counts[index_of(q)].front();
    if (q == ranks.own()) first_ = all;
    all += its;
    if (q == ranks.own()) continue;
    rows.rank.push_back(q);
    rows.first_received.push_back(rows.first_received.back() + its);
    if (q < ranks.own()) rows.before += its;
  }
  for (std::size_t n = 0; n < rows.rank.size(); ++n) {
    for (int i = 0; i < own; ++i) rows.sent.push_back(first_ + i);
    rows.first_sent.push_back(static_cast<int>(rows.sent.size()));
  }
  rows_ = zeros<Scalars<B>>("plica::rows_of_all", index_of(all) * index_of(width));
  halo_ = std::make_unique<Halo<B>>(ranks, what, std::move(rows), std::vector{width});
}

RowsByRank::RowsByRank(const Ranks& ranks, const RankPart& part, RowMatrix whole)
    : matrix(std::move(whole)) {
  std::vector<std::vector<int>> of_rank(index_of(ranks.count()));
  const auto* const first = matrix.outerIndexPtr();
  for (int i = 0; i < static_cast<int>(matrix.rows()); ++i) {
    const auto entries = first[i + 1] - first[i];
    const int q =
        entries == 0 ? 0 : owner_in(part.first, matrix.innerIndexPtr()[first[i] + entries / 2]);
    of_rank[index_of(q)].push_back(i);
  }
  place.resize(static_cast<std::size_t>(matrix.rows()));
  int next = 0;
  for (const std::vector<int>& its : of_rank)
    for (const int i : its) place[index_of(i)] = next++;
  own = std::move(of_rank[index_of(ranks.own())]);
}

std::vector<int> RowsByRank::read_by_own() const {
  std::vector<int> reads;
  for (const int i : own)
    for (RowMatrix::InnerIterator entry(matrix, i); entry; ++entry)
      reads.push_back(static_cast<int>(entry.col()));
  return reads;
}

template <class B, class Value>
SharedProduct<B, Value>::SharedProduct(const RankLevel<B>& level, const std::string& what,
                                       RowMatrix A) {
  Ranks& ranks = *level.ranks;
  const RowsByRank by_rank(ranks, level.part, std::move(A));
  const ReadVertices read = read_vertices(ranks, level.part, by_rank.read_by_own());
  std::vector<std::vector<std::pair<int, double>>> rows;
  for (const int i : by_rank.own) {
    auto& row = rows.emplace_back();
    for (RowMatrix::InnerIterator entry(by_rank.matrix, i); entry; ++entry)
      row.emplace_back(read.place(static_cast<int>(entry.col())), entry.value());
  }
  rows_ = sparse_rows<B, Value>(
      what, matrix_of_rows(rows, static_cast<Eigen::Index>(read.vertex.size())));
  read_ = std::make_unique<GatheredVertices<B>>(ranks, "vertices for " + what, read.rows, read.own);
  results_ = RowsOfAll<B>(ranks, what, static_cast<int>(by_rank.own.size()), 3);
  place_ = to_device<Indices<B>>(what, by_rank.place);
}

template <class B, class Value>
void SharedProduct<B, Value>::operator()(const Exec& exec, const Vectors<B>& x,
                                         const Vectors<B>& y) const {
  using Real = typename B::Real;
  const Vectors<B> own(results_.own(), index_of(rows_.rows));
  update_vertices<B>(exec, "plica::shared_product", rows_.rows,
                     MultiplyRows<B, Value>{rows_, (*read_)(exec, x, 0), own});
  results_.exchange(exec);
  update_vertices<B>(exec, "plica::shared_product", static_cast<int>(place_.extent(0)),
                     PackRows<Real, Indices<B>>{results_.all().data(), place_, y.data(), 3});
}

#define PLICA_ROWS_OF_ALL(Real, Exec) template class RowsOfAll<Backend<Real, Exec>>;
PLICA_FOR_EACH_PRECISION(PLICA_ROWS_OF_ALL)
#define PLICA_SHARED_PRODUCT(Real, Exec) template class SharedProduct<Backend<Real, Exec>, float>;
PLICA_FOR_EACH_BACKEND(PLICA_SHARED_PRODUCT)
#define PLICA_SHARED_IN_DOUBLE(Exec) template class SharedProduct<Backend<double, Exec>, double>;
PLICA_FOR_EACH_SPACE(PLICA_SHARED_IN_DOUBLE)

}  // namespace plica
