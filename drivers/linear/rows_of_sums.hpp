// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <plica/core/matrices.hpp>
#include <plica/core/row_ranges.hpp>
#include <plica/core/to_device.hpp>
#include <plica/drivers/linear/host_pattern.hpp>
#include <plica/drivers/spaces/row_matrix.hpp>
#include <string>
#include <utility>
#include <vector>

// The two products of P^T (A P) as sums of blocks, for a whole matrix or for some of its rows.
namespace plica {

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
/// @param own        own(row): column in which the row has a block even without terms; -1: none
template <class B, class Own, class ForTerms>
RowsOfSums<B> rows_of_sums(const std::string& name, std::size_t rows, std::size_t columns,
                           const Own& own, const ForTerms& for_terms) {
  std::vector<CountedRows> parts(row_parts(rows));
  for_row_parts(rows, [&](std::size_t p, std::size_t begin, std::size_t end) {
    CountedRows& part = parts[p];
    std::vector<int> terms(columns, 0), column;
    for (std::size_t a = begin; a < end; ++a) {
      column.clear();
      const int of_row = own(a);
      if (of_row >= 0) column.push_back(of_row);
      for_terms(a, [&](int b, int, double) {
        if (terms[index_of(b)]++ == 0 && b != of_row) column.push_back(b);
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

/// Rows of A of which right_product() is made.
struct ProductRows {
  int first, last;  ///< rows [first, last)
  /// [rows and columns of A] row of P that each belongs to; empty: that of its own number
  std::vector<int> of_P = {};

  int row_of_P(int a) const { return of_P.empty() ? a : of_P[index_of(a)]; }
};

/// Returns rows of A P, but of a row a only the columns from the first nonzero column of row a of P
/// on. The right half of P^T A P needs no others.
template <class B>
RowsOfSums<B> right_product(const HostPattern& A, const RowMatrix& P, const ProductRows& rows) {
  const auto for_terms = [&](std::size_t i, const auto& use) {
    const auto a = index_of(rows.first) + i;
    const RowMatrix::InnerIterator least(P, rows.row_of_P(static_cast<int>(a)));
    if (!least) return;
    for (int s = A.first[a]; s < A.first[a + 1]; ++s) {
      const int place = A.place[index_of(s)], block = s < A.diagonal[a] ? -1 - place : place;
      for (RowMatrix::InnerIterator j(P, rows.row_of_P(A.column[index_of(s)])); j; ++j)
        if (j.col() >= least.col()) use(static_cast<int>(j.col()), block, j.value());
    }
  };
  const auto none = [](std::size_t) { return -1; };
  return rows_of_sums<B>("galerkin.right", static_cast<std::size_t>(rows.last - rows.first),
                         static_cast<std::size_t>(P.cols()), none, for_terms);
}

/// Blocks of A P, by rows.
struct ProductBlocks {
  const std::vector<int>&first, &column;  ///< blocks of each row, columns ascending
  /// [rows of P] row among these; empty: that of its own number
  std::vector<int> row_of = {};

  std::size_t row(Eigen::Index a) const {
    return row_of.empty() ? static_cast<std::size_t>(a)
                          : index_of(row_of[static_cast<std::size_t>(a)]);
  }
};

/// Returns the right half of rows of P^T (A P).
/// @param made  number of each row that is made, ascending; null: all of them
template <class B>
RowsOfSums<B> left_product(const RowMatrix& Pt, const ProductBlocks& AP,
                           const std::vector<int>* made = nullptr) {
  const auto number = [&](std::size_t i) { return made ? (*made)[i] : static_cast<int>(i); };
  const auto for_terms = [&](std::size_t at, const auto& use) {
    const int of = number(at);
    for (RowMatrix::InnerIterator i(Pt, of); i; ++i) {
      const std::size_t a = AP.row(i.col());
      for (int s = AP.first[a]; s < AP.first[a + 1]; ++s)
        if (const int b = AP.column[index_of(s)]; b >= of) use(b, s, i.value());
    }
  };
  const auto coarse = static_cast<std::size_t>(Pt.rows());
  return rows_of_sums<B>("galerkin.left", made ? made->size() : coarse, coarse, number, for_terms);
}

/// Returns the pattern of a symmetric matrix from its right half.
inline HostPattern both_halves(const std::vector<int>& first, const std::vector<int>& column) {
  std::vector<std::vector<int>> rows(first.size() - 1);
  for (std::size_t a = 0; a < rows.size(); ++a)
    for (int s = first[a]; s < first[a + 1]; ++s) {
      const int b = column[index_of(s)];
      if (static_cast<int>(a) != b) rows[index_of(b)].push_back(static_cast<int>(a));
      rows[a].push_back(b);
    }
  std::vector<int> first_of_both{0}, both;
  for (auto& row : rows) {
    std::sort(row.begin(), row.end());
    both.insert(both.end(), row.begin(), row.end());
    first_of_both.push_back(static_cast<int>(both.size()));
  }
  return {std::move(first_of_both), std::move(both)};
}

}  // namespace plica
