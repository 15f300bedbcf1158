// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/core/row_ranges.hpp>
#include <plica/drivers/linear/multigrid.hpp>
#include <utility>

namespace plica {

namespace {

/// Rows of blocks, where each block is a sum of terms.
template <class B>
struct RowsOfSums {
  std::vector<int> first{0}, column;  ///< columns of the blocks of a row, ascending
  BlockTerms<B> terms;
};

/// Numbers of blocks and terms of some rows, one row after the other.
struct CountedRows {
  std::vector<int> blocks;         ///< [rows] number of blocks
  std::vector<int> column, terms;  ///< [blocks] column, and number of terms
};

/// Returns the rows whose terms a function lists.
/// @param for_terms  (row, use): calls use(column, block, weight) for all terms of a row, in the
///                   same order every time
/// @param own        true: each row has a block in the column of its own number, even without terms
template <class B, class ForTerms>
RowsOfSums<B> rows_of_sums(const std::string& name, std::size_t rows, std::size_t columns, bool own,
                           const ForTerms& for_terms) {
  std::vector<CountedRows> parts(row_parts(rows));
  for_row_parts(rows, [&](std::size_t p, std::size_t begin, std::size_t end) {
    CountedRows& part = parts[p];
    std::vector<int> terms(columns, 0), column;
    for (std::size_t a = begin; a < end; ++a) {
      column.clear();
      if (own) column.push_back(static_cast<int>(a));
      for_terms(a, [&](int b, int, double) {
        if (terms[index_of(b)]++ == 0 && !(own && index_of(b) == a)) column.push_back(b);
      });
      std::ranges::sort(column);
      for (const int b : column)
        part.column.push_back(b), part.terms.push_back(std::exchange(terms[index_of(b)], 0));
      part.blocks.push_back(static_cast<int>(column.size()));
    }
  });
  RowsOfSums<B> made;
  std::vector<int> first_term{0};
  for (const CountedRows& part : parts) {
    made.column.insert(made.column.end(), part.column.begin(), part.column.end());
    for (const int blocks : part.blocks) made.first.push_back(made.first.back() + blocks);
    for (const int terms : part.terms) first_term.push_back(first_term.back() + terms);
  }
  const auto terms = index_of(first_term.back());
  const HostWritten<B, Indices<B>> block(name + ".block", terms);
  const HostWritten<B, Scalars<B>> weight(name + ".weight", terms);
  for_row_ranges(rows, [&](std::size_t begin, std::size_t end) {
    std::vector<int> next(columns);
    for (std::size_t a = begin; a < end; ++a) {
      for (int s = made.first[a]; s < made.first[a + 1]; ++s)
        next[index_of(made.column[index_of(s)])] = first_term[index_of(s)];
      for_terms(a, [&](int b, int term, double w) {
        const int to = next[index_of(b)]++;
        block.data()[to] = term, weight.data()[to] = static_cast<typename B::Real>(w);
      });
    }
  });
  made.terms = {to_device<Indices<B>>(name + ".first", first_term), block.upload(),
                weight.upload()};
  return made;
}

/// Returns the pattern of a symmetric matrix from its right half.
template <class B>
HostPattern both_halves(const RowsOfSums<B>& right) {
  std::vector<std::vector<int>> rows(right.first.size() - 1);
  for (std::size_t a = 0; a < rows.size(); ++a)
    for (int s = right.first[a]; s < right.first[a + 1]; ++s) {
      const int b = right.column[index_of(s)];
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

/// Returns A P, but of row a only the columns from the first nonzero column of row a of P on.
/// The right half of P^T A P needs no others.
template <class B>
RowsOfSums<B> right_product(const HostPattern& A, const RowMatrix& P) {
  const auto for_terms = [&](std::size_t a, const auto& use) {
    const RowMatrix::InnerIterator least(P, static_cast<Eigen::Index>(a));
    if (!least) return;
    for (int s = A.first[a]; s < A.first[a + 1]; ++s) {
      const int place = A.place[index_of(s)], block = s < A.diagonal[a] ? -1 - place : place;
      for (RowMatrix::InnerIterator j(P, A.column[index_of(s)]); j; ++j)
        if (j.col() >= least.col()) use(static_cast<int>(j.col()), block, j.value());
    }
  };
  return rows_of_sums<B>("galerkin.right", static_cast<std::size_t>(P.rows()),
                         static_cast<std::size_t>(P.cols()), false, for_terms);
}

/// Returns the right half of P^T (A P).
template <class B>
RowsOfSums<B> left_product(const RowMatrix& P, const RowsOfSums<B>& AP) {
  const RowMatrix Pt = P.transpose();
  const auto for_terms = [&](std::size_t row, const auto& use) {
    for (RowMatrix::InnerIterator i(Pt, static_cast<Eigen::Index>(row)); i; ++i) {
      const auto a = static_cast<std::size_t>(i.col());
      for (int s = AP.first[a]; s < AP.first[a + 1]; ++s)
        if (const int b = AP.column[index_of(s)]; index_of(b) >= row) use(b, s, i.value());
    }
  };
  const auto coarse = static_cast<std::size_t>(P.cols());
  return rows_of_sums<B>("galerkin.left", coarse, coarse, true, for_terms);
}

}  // namespace

template <class B>
CoarseMatrix<B> coarse_matrix(const HostPattern& A, const RowMatrix& P) {
  const RowsOfSums<B> AP = right_product<B>(A, P), half = left_product<B>(P, AP);
  CoarseMatrix<B> made;
  made.pattern = both_halves(half);
  made.matrix = block_matrix<B>("multigrid", made.pattern);
  made.map = {AP.terms, half.terms, unset<Blocks9<B>>("plica::galerkin.between", AP.column.size())};
  return made;
}

#define PLICA_INSTANTIATE(Real, Exec)                                            \
  template CoarseMatrix<Backend<Real, Exec>> coarse_matrix<Backend<Real, Exec>>( \
      const HostPattern&, const RowMatrix&);
PLICA_FOR_EACH_PRECISION(PLICA_INSTANTIATE)

}  // namespace plica
