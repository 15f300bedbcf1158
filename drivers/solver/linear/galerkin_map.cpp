// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/drivers/solver/linear/multigrid.hpp>
#include <plica/drivers/solver/spaces/row_ranges.hpp>
#include <utility>

namespace plica {

namespace {

/// Calls use(column, block, weight) for the terms, weight times a block of A as GalerkinMap names it, of a coarse row from its own column on.
template <class Use>
void for_terms(const HostPattern& A, const RowMatrix& P, const RowMatrix& Pt, int row, const Use& use) {
  for (RowMatrix::InnerIterator i(Pt, row); i; ++i) {
    const auto a = static_cast<std::size_t>(i.col());
    for (int s = A.first[a]; s < A.first[a + 1]; ++s) {
      const int place = A.place[index_of(s)], block = s < A.diagonal[a] ? -1 - place : place;
      for (RowMatrix::InnerIterator j(P, A.column[index_of(s)]); j; ++j)
        if (j.col() >= row) use(static_cast<std::size_t>(j.col()), block, i.value() * j.value());
    }
  }
}

/// The blocks of every coarse row from its own on, and of how many terms each is.
struct UpperHalf {
  std::vector<std::vector<int>> column, terms;

  UpperHalf(const HostPattern& A, const RowMatrix& P, const RowMatrix& Pt)
      : column(static_cast<std::size_t>(P.cols())), terms(column.size()) {
    for_row_ranges(column.size(), [&](std::size_t begin, std::size_t end) {
      std::vector<int> count(column.size(), 0);
      for (std::size_t a = begin; a < end; ++a) {
        const int own = static_cast<int>(a);
        column[a].push_back(own);
        for_terms(A, P, Pt, own, [&](std::size_t b, int, double) {
          if (count[b]++ == 0 && b != a) column[a].push_back(static_cast<int>(b));
        });
        std::sort(column[a].begin(), column[a].end());
        for (const int b : column[a]) terms[a].push_back(std::exchange(count[index_of(b)], 0));
      }
    });
  }
};

HostPattern both_halves(const std::vector<std::vector<int>>& upper) {
  std::vector<std::vector<int>> rows(upper.size());
  for (std::size_t a = 0; a < upper.size(); ++a)
    for (const int b : upper[a]) {
      if (static_cast<int>(a) != b) rows[index_of(b)].push_back(static_cast<int>(a));
      rows[a].push_back(b);
    }
  std::vector<int> first{0}, column;
  for (auto& row : rows) {
    std::sort(row.begin(), row.end());
    column.insert(column.end(), row.begin(), row.end());
    first.push_back(static_cast<int>(column.size()));
  }
  return {std::move(first), std::move(column)};
}

}  // namespace

template <class B>
CoarseMatrix<B> coarse_matrix(const HostPattern& A, const RowMatrix& P) {
  const RowMatrix Pt = P.transpose();
  const UpperHalf upper(A, P, Pt);
  const std::vector<std::vector<int>>& columns = upper.column;
  std::vector<int> first{0}, first_block{0};
  for (const auto& row : upper.terms) {
    for (const int terms : row) first.push_back(first.back() + terms);
    first_block.push_back(static_cast<int>(first.size()) - 1);
  }
  std::vector<int> fine(index_of(first.back()));
  std::vector<typename B::Real> weight(fine.size());
  for_row_ranges(columns.size(), [&](std::size_t begin, std::size_t end) {
    std::vector<int> next(columns.size());
    for (std::size_t a = begin; a < end; ++a) {
      int block = first_block[a];
      for (const int b : columns[a]) next[index_of(b)] = first[index_of(block++)];
      for_terms(A, P, Pt, static_cast<int>(a), [&](std::size_t b, int s, double w) {
        const auto to = index_of(next[b]++);
        fine[to] = s, weight[to] = static_cast<typename B::Real>(w);
      });
    }
  });
  CoarseMatrix<B> made;
  made.pattern = both_halves(columns);
  made.matrix = block_matrix<B>("multigrid", made.pattern);
  made.map = {to_device<Indices<B>>("galerkin.first", first), to_device<Indices<B>>("galerkin.fine", fine),
              to_device<Scalars<B>>("galerkin.weight", weight)};
  return made;
}

#define PLICA_INSTANTIATE(Real, Exec) \
  template CoarseMatrix<Backend<Real, Exec>> coarse_matrix<Backend<Real, Exec>>(const HostPattern&, const RowMatrix&);
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
