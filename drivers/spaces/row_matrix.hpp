// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/SparseCore>
#include <plica/core/row_ranges.hpp>
#include <utility>
#include <vector>

// Sparse matrices on the host by rows, and operations on all rows by all threads.
namespace plica {

using RowMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// Returns A B, computed by all threads of the host. Every entry is summed in the order of A's
/// columns, so that its bits do not depend on the number of threads.
RowMatrix product(const RowMatrix& A, const RowMatrix& B);

/// Returns P^T A P for a symmetric A.
RowMatrix galerkin_product(const RowMatrix& A, const RowMatrix& P);

/// Returns the matrix with the given rows of (column, value), columns ascending.
RowMatrix matrix_of_rows(const std::vector<std::vector<std::pair<int, double>>>& rows,
                         Eigen::Index columns);

/// Returns some rows of a matrix, in the order of their numbers.
RowMatrix some_rows(const RowMatrix& A, const std::vector<int>& rows);

/// Consecutive rows of a matrix.
struct MatrixRows {
  std::vector<int> first{0}, column;
  std::vector<double> value;

  /// Adds an entry to the last row.
  void add(int c, double v) { column.push_back(c), value.push_back(v); }
  /// Ends the row.
  void end_row() { first.push_back(static_cast<int>(column.size())); }
};

/// Returns the matrix with the rows of all parts, one after the other.
RowMatrix joined_rows(const std::vector<MatrixRows>& parts, Eigen::Index rows,
                      Eigen::Index columns);

/// Returns A with each entry moved to column number(row, column, value); an entry with a negative
/// number is dropped. Numbers ascend with the columns.
template <class Number>
RowMatrix renumbered(const RowMatrix& A, Eigen::Index columns, const Number& number) {
  const auto rows = static_cast<std::size_t>(A.rows());
  std::vector<MatrixRows> parts(row_parts(rows));
  for_row_parts(rows, [&](std::size_t p, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      for (RowMatrix::InnerIterator entry(A, static_cast<Eigen::Index>(i)); entry; ++entry)
        if (const int column = number(entry.row(), static_cast<int>(entry.col()), entry.value());
            column >= 0)
          parts[p].add(column, entry.value());
      parts[p].end_row();
    }
  });
  return joined_rows(parts, A.rows(), columns);
}

/// Returns A with only the entries for which keep(row, column, value) is true.
template <class Keep>
RowMatrix some_entries(const RowMatrix& A, const Keep& keep) {
  return renumbered(A, A.cols(), [&](Eigen::Index row, int column, double value) {
    return keep(row, column, value) ? column : -1;
  });
}

}  // namespace plica
