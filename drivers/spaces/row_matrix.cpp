// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/drivers/spaces/row_matrix.hpp>
#include <span>
#include <tuple>

namespace plica {

RowMatrix joined_rows(const std::vector<MatrixRows>& parts, Eigen::Index rows,
                      Eigen::Index columns) {
  RowMatrix result(rows, columns);
  int* const first = result.outerIndexPtr();
  Eigen::Index row = 0;
  first[0] = 0;
  std::vector<int> start;
  for (const MatrixRows& part : parts) {
    start.push_back(first[row]);
    for (std::size_t i = 1; i < part.first.size(); ++i) first[++row] = start.back() + part.first[i];
  }
  result.resizeNonZeros(first[rows]);
  for_row_ranges(parts.size(), [&](std::size_t from, std::size_t to) {
    for (std::size_t p = from; p < to; ++p) {
      std::copy(parts[p].column.begin(), parts[p].column.end(), result.innerIndexPtr() + start[p]);
      std::copy(parts[p].value.begin(), parts[p].value.end(), result.valuePtr() + start[p]);
    }
  });
  return result;
}

namespace {

/// Row of a product while it is summed.
class ProductRow {
 public:
  explicit ProductRow(Eigen::Index columns)
      : sum_(static_cast<std::size_t>(columns), 0.0),
        known_(sum_.size(), 0),
        columns_(sum_.size() + 1) {}

  /// Adds factor times a row of B, from column `from` on. The loop has no branch: a branch on
  /// whether a column is new would be hard to predict.
  void add(double factor, const RowMatrix& B, Eigen::Index row, int from = 0) {
    const int *const column = B.innerIndexPtr(), *const last = column + B.outerIndexPtr()[row + 1];
    const double* const value = B.valuePtr();
    double* const sum = sum_.data();
    char* const known = known_.data();
    int* next = columns_.data() + count_;
    for (const int* at = std::lower_bound(column + B.outerIndexPtr()[row], last, from); at < last;
         ++at) {
      *next = *at;
      next += std::exchange(known[*at], 1) == 0;
      sum[*at] += factor * value[at - column];
    }
    count_ = static_cast<std::size_t>(next - columns_.data());
  }

  /// Appends the row to `rows`, columns ascending, and clears it.
  void append_to(MatrixRows& rows) {
    const std::span<int> columns(columns_.data(), count_);
    std::ranges::sort(columns);
    for (const int column : columns) {
      const auto j = static_cast<std::size_t>(column);
      known_[j] = 0;
      rows.add(column, std::exchange(sum_[j], 0.0));
    }
    rows.end_row();
    count_ = 0;
  }

 private:
  std::vector<double> sum_;   // per column; 0 where nothing was added
  std::vector<char> known_;   // per column, 1 where something was added
  std::vector<int> columns_;  // known columns; one more place is overwritten by repeated columns
  std::size_t count_ = 0;
};

/// Returns A B; row i is computed from column from(i) on.
template <class From>
RowMatrix product_from(const RowMatrix& A, const RowMatrix& B, const From& from) {
  const auto rows = static_cast<std::size_t>(A.rows());
  std::vector<MatrixRows> parts(row_parts(rows));
  for_row_parts(rows, [&](std::size_t p, std::size_t first, std::size_t last) {
    ProductRow sum(B.cols());
    for (std::size_t i = first; i < last; ++i) {
      for (RowMatrix::InnerIterator entry(A, static_cast<Eigen::Index>(i)); entry; ++entry)
        sum.add(entry.value(), B, entry.col(), from(i));
      sum.append_to(parts[p]);
    }
  });
  return joined_rows(parts, A.rows(), B.cols());
}

}  // namespace

RowMatrix product(const RowMatrix& A, const RowMatrix& B) {
  return product_from(A, B, [](std::size_t) { return 0; });
}

RowMatrix galerkin_product(const RowMatrix& A, const RowMatrix& P) {
  const RowMatrix upper = product_from(RowMatrix(P.transpose()), product(A, P),
                                       [](std::size_t i) { return static_cast<int>(i); });
  return upper.selfadjointView<Eigen::Upper>();
}

RowMatrix matrix_of_rows(const std::vector<std::vector<std::pair<int, double>>>& rows,
                         Eigen::Index columns) {
  RowMatrix A(static_cast<Eigen::Index>(rows.size()), columns);
  int* first = A.outerIndexPtr();
  first[0] = 0;
  for (std::size_t i = 0; i < rows.size(); ++i)
    first[i + 1] = first[i] + static_cast<int>(rows[i].size());
  A.resizeNonZeros(first[rows.size()]);
  for_row_ranges(rows.size(), [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) {
      int place = first[i];
      for (const auto& entry : rows[i])
        std::tie(A.innerIndexPtr()[place], A.valuePtr()[place]) = entry, ++place;
    }
  });
  return A;
}

RowMatrix some_rows(const RowMatrix& A, const std::vector<int>& rows) {
  MatrixRows made;
  for (const int row : rows) {
    for (RowMatrix::InnerIterator entry(A, row); entry; ++entry)
      made.add(static_cast<int>(entry.col()), entry.value());
    made.end_row();
  }
  return joined_rows({std::move(made)}, static_cast<Eigen::Index>(rows.size()), A.cols());
}

}  // namespace plica
