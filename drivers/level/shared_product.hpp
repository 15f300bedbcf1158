// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <memory>
#include <plica/core/matrices.hpp>
#include <plica/drivers/spaces/row_matrix.hpp>
#include <plica/kernels/halo.hpp>
#include <string>
#include <vector>

// From a level that several ranks share to a coarser one that is whole on each of them. Each
// number is summed by one rank, in the order in which one process sums it:
//
//   fine field       own vertices of rank 0  |  of rank 1          gathered where another rank's
//                        \    |    /            \   |   /            vertices are read
//   coarse field     rows of rank 0          |  rows of rank 1     then each receives all rows
namespace plica {

/// Rows of which each rank makes its own, and receives those of all others.
template <class B>
class RowsOfAll {
 public:
  using Real = typename B::Real;
  using Exec = typename B::Exec;

  RowsOfAll() = default;
  /// All ranks call this.
  /// @param own    number of rows of this rank
  /// @param width  numbers of a row
  RowsOfAll(Ranks& ranks, const std::string& what, int own, int width);
  /// Returns the rows that this rank makes.
  Real* own() const { return rows_.data() + std::ptrdiff_t{first_} * width_; }
  /// Returns the rows of all ranks, one rank after the other, after exchange().
  const Scalars<B>& all() const { return rows_; }
  void exchange(const Exec& exec) const { halo_->exchange(exec, rows_.data(), width_); }

 private:
  int first_ = 0, width_ = 0;
  Scalars<B> rows_;
  std::unique_ptr<Halo<B>> halo_;
};

/// Which rank makes each row of a matrix whose columns are the vertices of a shared level: one that
/// owns a vertex which the row reads.
struct RowsByRank {
  RowMatrix matrix;        ///< matrix of the whole level
  std::vector<int> own;    ///< rows that this rank makes, ascending
  std::vector<int> place;  ///< [rows] place of each among those of rank 0, of rank 1, ...

  RowsByRank(const Ranks& ranks, const RankPart& part, RowMatrix whole);
  /// Returns the vertices of the whole level that the own rows read, in any order.
  std::vector<int> read_by_own() const;
};

/// Product of a matrix with a field of a level that ranks share; each rank has the whole result.
template <class B, class Value>
class SharedProduct {
 public:
  using Exec = typename B::Exec;
  /// All ranks call this.
  /// @param A  [rows x vertices of the whole level]
  SharedProduct(const RankLevel<B>& level, const std::string& what, RowMatrix A);
  /// Sets y = A x, of x at the vertices that ranks own. Waits.
  void operator()(const Exec& exec, const Vectors<B>& x, const Vectors<B>& y) const;
  template <class Archive>
  void name_fields(Archive& archive) const {
    archive.owns(rows_, results_.all(), place_);
  }

 private:
  SparseRows<B, Value> rows_;  ///< rows that this rank makes
  std::unique_ptr<GatheredVertices<B>> read_;
  RowsOfAll<B> results_;
  Indices<B> place_;  ///< [rows] place of each in results_
};

}  // namespace plica
