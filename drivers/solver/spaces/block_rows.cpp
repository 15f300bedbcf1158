// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/LU>
#include <Kokkos_Profiling_ScopedRegion.hpp>
#include <algorithm>
#include <plica/drivers/solver/spaces/block_rows.hpp>
#include <plica/drivers/solver/spaces/row_ranges.hpp>
#include <utility>

namespace plica {

namespace {

using BlockRow = BlockRows::value_type;

constexpr std::size_t block_size = 9;

/// A row whose columns are in the order in which they came.
struct LooseRow {
  std::vector<int> column;
  std::vector<double> block;  // 9 numbers of each
};

/// A row in the making: blocks are added to columns in any order.
class RowSum {
 public:
  explicit RowSum(std::size_t columns) : place_(columns, -1) {}

  void add(int column, double factor, const double* __restrict__ block) {
    int& place = place_[index_of(column)];
    if (place < 0) {
      place = static_cast<int>(columns_.size());
      columns_.push_back(column);
      if (blocks_.size() < block_size * columns_.size()) blocks_.resize(2 * block_size * columns_.size());
      double* const __restrict__ sum = blocks_.data() + block_size * index_of(place);
      for (std::size_t k = 0; k < block_size; ++k) sum[k] = factor * block[k];
    } else {
      double* const __restrict__ sum = blocks_.data() + block_size * index_of(place);
      for (std::size_t k = 0; k < block_size; ++k) sum[k] += factor * block[k];
    }
  }

  /// What was added; starts anew.
  LooseRow take() {
    LooseRow row{{columns_.begin(), columns_.end()}, {blocks_.data(), blocks_.data() + block_size * columns_.size()}};
    for (const int column : columns_) place_[index_of(column)] = -1;
    columns_.clear();
    return row;
  }
  /// The same, columns ascending.
  BlockRow take_sorted() {
    std::sort(columns_.begin(), columns_.end());
    BlockRow row;
    row.reserve(columns_.size());
    for (const int column : columns_) {
      const int place = std::exchange(place_[index_of(column)], -1);
      row.emplace_back(column, Eigen::Map<const Eigen::Matrix3d>(blocks_.data() + block_size * index_of(place)));
    }
    columns_.clear();
    return row;
  }

 private:
  std::vector<int> columns_, place_;
  std::vector<double> blocks_;
};

/// The first entry of a row in this column or behind it.
template <class Row>
auto from_column(Row& row, int column) {
  return std::lower_bound(row.begin(), row.end(), column, [](const auto& e, int c) { return e.first < c; });
}

/// Each vertex's tetrahedra, ascending.
struct TetsOfVertices {
  std::vector<int> first, tet;

  explicit TetsOfVertices(const TetMesh& mesh) : first(mesh.vertices.size() + 1, 0), tet(4 * mesh.tets.size()) {
    for (const auto& t : mesh.tets)
      for (const int a : t) ++first[index_of(a) + 1];
    for (std::size_t a = 0; a < mesh.vertices.size(); ++a) first[a + 1] += first[a];
    std::vector<int> next(first.begin(), first.end() - 1);
    for (std::size_t e = 0; e < mesh.tets.size(); ++e)
      for (const int a : mesh.tets[e]) tet[index_of(next[index_of(a)]++)] = static_cast<int>(e);
  }
};

/// Of a linear element's shape functions, and its volume of body.
struct TetGradients {
  Eigen::Matrix<double, 4, 3> gradient;
  double volume;

  TetGradients(const TetMesh& mesh, std::size_t e) {
    const auto& tet = mesh.tets[e];
    Eigen::Matrix3d edges;
    for (std::size_t c = 0; c < 3; ++c)
      edges.row(static_cast<Eigen::Index>(c)) =
          (mesh.vertices[index_of(tet[c + 1])] - mesh.vertices[index_of(tet[0])]).transpose();
    volume = mesh.part(e) * edges.determinant() / 6;
    gradient.bottomRows<3>() = edges.inverse().transpose();
    gradient.row(0) = -gradient.bottomRows<3>().colwise().sum();
  }
};

}  // namespace

BlockRows rest_stiffness(const TetMesh& mesh, const std::vector<std::array<double, 2>>& lame) {
  const Kokkos::Profiling::ScopedRegion region("plica: stiffness at rest");
  const TetsOfVertices around(mesh);
  BlockRows K(mesh.vertices.size());
  for_row_ranges(K.size(), [&](std::size_t first, std::size_t last) {
    std::vector<int> columns;
    for (std::size_t a = first; a < last; ++a) {
      columns.assign(1, static_cast<int>(a));
      for (int k = around.first[a]; k < around.first[a + 1]; ++k) {
        const auto& tet = mesh.tets[index_of(around.tet[index_of(k)])];
        columns.insert(columns.end(), tet.begin(), tet.end());
      }
      std::sort(columns.begin(), columns.end());
      columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
      BlockRow& row = K[a];
      row.reserve(columns.size());
      for (const int b : columns) row.emplace_back(b, Eigen::Matrix3d::Zero());
      for (int k = around.first[a]; k < around.first[a + 1]; ++k) {
        const auto e = index_of(around.tet[index_of(k)]);
        const auto& tet = mesh.tets[e];
        const TetGradients of(mesh, e);
        const auto [lambda, mu] = lame[mesh.region.empty() ? 0 : index_of(mesh.region[e])];
        const auto i = std::ranges::find(tet, static_cast<int>(a)) - tet.begin();
        for (int j = 0; j < 4; ++j) {
          const Point gi = of.gradient.row(i), gj = of.gradient.row(j);
          Eigen::Matrix3d block = lambda * gi * gj.transpose() + mu * gj * gi.transpose();
          block.diagonal().array() += mu * gi.dot(gj);
          from_column(row, tet[index_of(j)])->second += of.volume * block;
        }
      }
    }
  });
  return K;
}

BlockRows galerkin_product(const BlockRows& K, const RowMatrix& P) {
  const Kokkos::Profiling::ScopedRegion region("plica: coarse stiffness");
  const auto columns = static_cast<std::size_t>(P.cols());
  std::vector<LooseRow> KP(K.size());
  BlockRows result(columns);
  for_row_ranges(K.size(), [&](std::size_t first, std::size_t last) {
    RowSum sum(columns);
    for (std::size_t i = first; i < last; ++i) {
      for (const auto& [j, block] : K[i])
        for (RowMatrix::InnerIterator entry(P, j); entry; ++entry)
          sum.add(static_cast<int>(entry.col()), entry.value(), block.data());
      KP[i] = sum.take();
    }
  });
  const RowMatrix Pt = P.transpose();
  for_row_ranges(columns, [&](std::size_t first, std::size_t last) {
    RowSum sum(columns);
    for (std::size_t I = first; I < last; ++I) {
      for (RowMatrix::InnerIterator entry(Pt, static_cast<Eigen::Index>(I)); entry; ++entry) {
        const LooseRow& row = KP[static_cast<std::size_t>(entry.col())];
        const double* block = row.block.data();
        for (const int J : row.column) sum.add(J, entry.value(), block), block += block_size;
      }
      result[I] = sum.take_sorted();
    }
  });
  return result;
}

Eigen::MatrixXd dense_matrix(const BlockRows& K) {
  const auto n = static_cast<Eigen::Index>(3 * K.size());
  Eigen::MatrixXd full = Eigen::MatrixXd::Zero(n, n);
  for (std::size_t i = 0; i < K.size(); ++i)
    for (const auto& [j, block] : K[i]) full.block<3, 3>(static_cast<Eigen::Index>(3 * i), 3 * j) = block;
  return 0.5 * (full + full.transpose());
}

}  // namespace plica
