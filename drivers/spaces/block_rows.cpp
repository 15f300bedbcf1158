// SPDX-License-Identifier: BSD-3-Clause
#include <Kokkos_Profiling_ScopedRegion.hpp>
#include <algorithm>
#include <plica/core/row_ranges.hpp>
#include <plica/drivers/spaces/block_rows.hpp>
#include <plica/meshes/tet_gradients.hpp>

namespace plica {

namespace {

using BlockRow = BlockRows::value_type;

/// Returns the first entry of a row whose column is not below `column`.
template <class Row>
auto from_column(Row& row, int column) {
  return std::lower_bound(row.begin(), row.end(), column,
                          [](const auto& e, int c) { return e.first < c; });
}

/// Tetrahedra of each vertex, ascending.
struct TetsOfVertices {
  std::vector<std::size_t> first;  // [vertices + 1]
  std::vector<int> tet;

  explicit TetsOfVertices(const TetMesh& mesh)
      : first(mesh.vertices.size() + 1, 0), tet(4 * mesh.tets.size()) {
    for (const auto& t : mesh.tets)
      for (const int a : t) ++first[index_of(a) + 1];
    for (std::size_t a = 0; a < mesh.vertices.size(); ++a) first[a + 1] += first[a];
    std::vector<std::size_t> next(first.begin(), first.end() - 1);
    for (std::size_t e = 0; e < mesh.tets.size(); ++e)
      for (const int a : mesh.tets[e]) tet[next[index_of(a)]++] = static_cast<int>(e);
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
      for (std::size_t k = around.first[a]; k < around.first[a + 1]; ++k) {
        const auto& tet = mesh.tets[index_of(around.tet[k])];
        columns.insert(columns.end(), tet.begin(), tet.end());
      }
      std::sort(columns.begin(), columns.end());
      columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
      BlockRow& row = K[a];
      row.reserve(columns.size());
      for (const int b : columns) row.emplace_back(b, Eigen::Matrix3d::Zero());
      for (std::size_t k = around.first[a]; k < around.first[a + 1]; ++k) {
        const auto e = index_of(around.tet[k]);
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

}  // namespace plica
