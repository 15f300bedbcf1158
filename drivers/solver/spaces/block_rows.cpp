// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/LU>
#include <algorithm>
#include <plica/drivers/solver/spaces/block_rows.hpp>
#include <plica/drivers/solver/spaces/index_of.hpp>
#include <plica/drivers/solver/spaces/row_ranges.hpp>
#include <plica/meshes/mesh_quality.hpp>

namespace plica {

namespace {

/// A row in the making: blocks are added to columns in any order.
class RowSum {
 public:
  explicit RowSum(std::size_t columns) : place_(columns, -1) {}

  void add(int column, double factor, const Eigen::Matrix3d& block) {
    int& place = place_[index_of(column)];
    if (place < 0) {
      place = static_cast<int>(row_.size());
      row_.emplace_back(column, factor * block);
    } else {
      row_[index_of(place)].second += factor * block;
    }
  }

  /// What was added, ascending; starts anew.
  std::vector<std::pair<int, Eigen::Matrix3d>> take() {
    for (const auto& entry : row_) place_[index_of(entry.first)] = -1;
    std::sort(row_.begin(), row_.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    return std::exchange(row_, {});
  }

 private:
  std::vector<std::pair<int, Eigen::Matrix3d>> row_;
  std::vector<int> place_;
};

/// The first entry of a row in this column or behind it.
template <class Row>
auto from_column(Row& row, int column) {
  return std::lower_bound(row.begin(), row.end(), column, [](const auto& e, int c) { return e.first < c; });
}

}  // namespace

BlockRows rest_stiffness(const TetMesh& mesh, const std::vector<std::array<double, 2>>& lame) {
  BlockRows K(mesh.vertices.size());
  for (std::size_t a = 0; a < K.size(); ++a) K[a].emplace_back(static_cast<int>(a), Eigen::Matrix3d::Zero());
  for (const auto& [a, b] : mesh_edges(mesh)) {
    K[index_of(a)].emplace_back(b, Eigen::Matrix3d::Zero());
    K[index_of(b)].emplace_back(a, Eigen::Matrix3d::Zero());
  }
  for (auto& row : K) std::sort(row.begin(), row.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (std::size_t e = 0; e < mesh.tets.size(); ++e) {
    const auto& tet = mesh.tets[e];
    Eigen::Matrix3d edges;
    for (std::size_t c = 0; c < 3; ++c)
      edges.row(static_cast<Eigen::Index>(c)) =
          (mesh.vertices[index_of(tet[c + 1])] - mesh.vertices[index_of(tet[0])]).transpose();
    const double volume = mesh.part(e) * edges.determinant() / 6;
    Eigen::Matrix<double, 4, 3> gradient;
    gradient.bottomRows<3>() = edges.inverse().transpose();
    gradient.row(0) = -gradient.bottomRows<3>().colwise().sum();
    const auto [lambda, mu] = lame[mesh.region.empty() ? 0 : index_of(mesh.region[e])];
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) {
        const Point gi = gradient.row(i), gj = gradient.row(j);
        Eigen::Matrix3d block = lambda * gi * gj.transpose() + mu * gj * gi.transpose();
        block.diagonal().array() += mu * gi.dot(gj);
        auto& row = K[index_of(tet[index_of(i)])];
        from_column(row, tet[index_of(j)])->second += volume * block;
      }
  }
  return K;
}

BlockRows galerkin_product(const BlockRows& K, const RowMatrix& P) {
  const auto columns = static_cast<std::size_t>(P.cols());
  BlockRows KP(K.size()), result(columns);
  for_row_ranges(K.size(), [&](std::size_t first, std::size_t last) {
    RowSum sum(columns);
    for (std::size_t i = first; i < last; ++i) {
      for (const auto& [j, block] : K[i])
        for (RowMatrix::InnerIterator entry(P, j); entry; ++entry)
          sum.add(static_cast<int>(entry.col()), entry.value(), block);
      KP[i] = sum.take();
    }
  });
  const RowMatrix Pt = P.transpose();
  for_row_ranges(columns, [&](std::size_t first, std::size_t last) {
    RowSum sum(columns);
    for (std::size_t I = first; I < last; ++I) {
      for (RowMatrix::InnerIterator entry(Pt, static_cast<Eigen::Index>(I)); entry; ++entry)
        for (const auto& [J, block] : KP[static_cast<std::size_t>(entry.col())]) sum.add(J, entry.value(), block);
      result[I] = sum.take();
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
