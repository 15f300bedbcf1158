// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <plica/drivers/spaces/transfer_matrix.hpp>
#include <plica/meshes/mesh_quality.hpp>
#include <utility>
#include <vector>

namespace plica {

namespace {

constexpr double reach = 1.2;      // radius over the longest edge
constexpr double most_weight = 3;  // maximum sum of |weights|
constexpr std::size_t fewest = 5;  // minimum number of entries

double spline(double s) { return s < 1 ? (1 - s) * (1 - s) * (1 + 2 * s) : 0; }

// Returns the weights of `ring`, whose first entry is the vertex itself. Returns nothing where the
// ring is too small or the fit is not good.
std::vector<double> ring_weights(const TetMesh& mesh, const std::vector<int>& ring) {
  const auto at = [&](int v) { return mesh.vertices[static_cast<std::size_t>(v)]; };
  if (ring.size() < fewest) return {};
  double longest = 0;
  for (int b : ring) longest = std::max(longest, (at(b) - at(ring[0])).norm());
  std::vector<double> weight;
  std::vector<Eigen::Vector4d> basis;
  Eigen::Matrix4d moments = Eigen::Matrix4d::Zero();
  for (int b : ring) {
    const Point d = (at(b) - at(ring[0])) / (reach * longest);
    basis.emplace_back(1, d[0], d[1], d[2]);
    weight.push_back(spline(d.norm()));
    moments += weight.back() * basis.back() * basis.back().transpose();
  }
  const Eigen::Vector4d c =
      moments.completeOrthogonalDecomposition().solve(Eigen::Vector4d::Unit(0));
  double sum = 0, size = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    weight[i] *= c.dot(basis[i]);
    sum += weight[i], size += std::abs(weight[i]);
  }
  return std::abs(sum - 1) < 1e-8 && size <= most_weight ? weight : std::vector<double>{};
}

}  // namespace

RowMatrix ring_smoothing(const TetMesh& mesh) {
  const auto n = static_cast<Eigen::Index>(mesh.vertices.size());
  std::vector<std::vector<int>> rings(mesh.vertices.size());
  for (int a = 0; a < static_cast<int>(n); ++a) rings[static_cast<std::size_t>(a)].push_back(a);
  for (const auto& [a, b] : mesh_edges(mesh)) {
    rings[static_cast<std::size_t>(a)].push_back(b);
    rings[static_cast<std::size_t>(b)].push_back(a);
  }
  std::vector<Eigen::Triplet<double>> entries;
  for (const auto& ring : rings) {
    const std::vector<double> weight = ring_weights(mesh, ring);
    if (weight.empty()) entries.emplace_back(ring[0], ring[0], 1.0);
    for (std::size_t i = 0; i < weight.size(); ++i)
      if (std::abs(weight[i]) > 1e-12) entries.emplace_back(ring[0], ring[i], weight[i]);
  }
  RowMatrix S(n, n);
  S.setFromTriplets(entries.begin(), entries.end());
  return S;
}

RowMatrix follower_matrix(const TetMesh& mesh) {
  std::vector<std::vector<std::pair<int, double>>> rows(mesh.vertices.size());
  for (std::size_t a = 0; a < rows.size(); ++a) rows[a] = {{static_cast<int>(a), 1.0}};
  const Followers& followers = mesh.followers;
  for (std::size_t i = 0; i < followers.vertex.size(); ++i) {
    auto& row = rows[index_of(followers.vertex[i])];
    row.clear();
    for (std::size_t c = 0; c < 4; ++c)
      if (followers.weight[i][c] != 0) row.emplace_back(followers.of[i][c], followers.weight[i][c]);
    std::ranges::sort(row);
  }
  return matrix_of_rows(rows, static_cast<Eigen::Index>(rows.size()));
}

std::vector<char> given_or_following(const TetMesh& mesh, std::vector<char> constrained) {
  for (const int v : mesh.followers.vertex) constrained[index_of(v)] = 1;
  return constrained;
}

namespace {

RowMatrix barycentric_transfer(const Embedding& up, std::size_t coarse_vertices) {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t a = 0; a < up.vertices.size(); ++a)
    for (std::size_t c = 0; c < 4; ++c)
      if (up.weights[a][c] != 0)
        entries.emplace_back(static_cast<int>(a), up.vertices[a][c], up.weights[a][c]);
  RowMatrix P(static_cast<Eigen::Index>(up.vertices.size()),
              static_cast<Eigen::Index>(coarse_vertices));
  P.setFromTriplets(entries.begin(), entries.end());
  return P;
}

}  // namespace

RowMatrix transfer_matrix(const TetMesh& fine, const std::vector<char>& fine_constrained,
                          const TetMesh& coarse, const std::vector<char>& coarse_constrained,
                          const Embedding& up, bool smooth) {
  RowMatrix P = barycentric_transfer(up, coarse.vertices.size());
  if (smooth) P = RowMatrix(ring_smoothing(fine) * P);
  if (!coarse.followers.vertex.empty()) P = product(P, follower_matrix(coarse));
  const std::vector<char> given = given_or_following(fine, fine_constrained);
  return some_entries(P, [&](Eigen::Index a, int b, double value) {
    return !given[static_cast<std::size_t>(a)] && !coarse_constrained[index_of(b)] &&
           std::abs(value) > 1e-6;
  });
}

}  // namespace plica
