// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/drivers/solver/spaces/row_ranges.hpp>
#include <plica/drivers/solver/spaces/sparse_product.hpp>
#include <tuple>

namespace plica {

namespace {

/// Some of the product's rows, one after the other.
struct ProductRows {
  std::vector<int> first{0}, column;
  std::vector<double> value;
};

/// A row in the making.
class ProductRow {
 public:
  explicit ProductRow(Eigen::Index columns)
      : sum_(static_cast<std::size_t>(columns), 0.0), known_(static_cast<std::size_t>(columns), 0) {}

  /// += factor times a row of B
  void add(double factor, const RowMatrix& B, Eigen::Index row) {
    for (RowMatrix::InnerIterator entry(B, row); entry; ++entry) {
      const auto column = static_cast<std::size_t>(entry.col());
      if (known_[column]) {
        sum_[column] += factor * entry.value();
      } else {
        known_[column] = 1, sum_[column] = factor * entry.value();
        columns_.push_back(static_cast<int>(entry.col()));
      }
    }
  }

  /// Moves what was added to the end of `rows`, columns ascending.
  void append_to(ProductRows& rows) {
    std::sort(columns_.begin(), columns_.end());
    for (const int column : columns_) {
      known_[static_cast<std::size_t>(column)] = 0;
      rows.column.push_back(column), rows.value.push_back(sum_[static_cast<std::size_t>(column)]);
    }
    rows.first.push_back(static_cast<int>(rows.column.size()));
    columns_.clear();
  }

 private:
  std::vector<double> sum_;
  std::vector<char> known_;
  std::vector<int> columns_;
};

RowMatrix joined_rows(const std::vector<ProductRows>& parts, Eigen::Index rows, Eigen::Index columns) {
  RowMatrix result(rows, columns);
  int* const first = result.outerIndexPtr();
  Eigen::Index row = 0;
  first[0] = 0;
  std::vector<int> start;
  for (const ProductRows& part : parts) {
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

}  // namespace

RowMatrix product(const RowMatrix& A, const RowMatrix& B) {
  const auto rows = static_cast<std::size_t>(A.rows());
  std::vector<ProductRows> parts(row_parts(rows));
  for_row_parts(rows, [&](std::size_t p, std::size_t first, std::size_t last) {
    ProductRow sum(B.cols());
    for (std::size_t i = first; i < last; ++i) {
      for (RowMatrix::InnerIterator entry(A, static_cast<Eigen::Index>(i)); entry; ++entry)
        sum.add(entry.value(), B, entry.col());
      sum.append_to(parts[p]);
    }
  });
  return joined_rows(parts, A.rows(), B.cols());
}

RowMatrix matrix_of_rows(const std::vector<std::vector<std::pair<int, double>>>& rows, Eigen::Index columns) {
  RowMatrix A(static_cast<Eigen::Index>(rows.size()), columns);
  int* first = A.outerIndexPtr();
  first[0] = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) first[i + 1] = first[i] + static_cast<int>(rows[i].size());
  A.resizeNonZeros(first[rows.size()]);
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t k = 0; k < rows[i].size(); ++k)
      std::tie(A.innerIndexPtr()[first[i] + static_cast<int>(k)], A.valuePtr()[first[i] + static_cast<int>(k)]) =
          rows[i][k];
  return A;
}

}  // namespace plica
