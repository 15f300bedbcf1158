// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <plica/drivers/solver/spaces/transfer_matrix.hpp>

namespace plica {

namespace {

RowMatrix barycentric_transfer(const Embedding& up, std::size_t coarse_vertices) {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t a = 0; a < up.vertices.size(); ++a)
    for (std::size_t c = 0; c < 4; ++c)
      if (up.weights[a][c] != 0) entries.emplace_back(static_cast<int>(a), up.vertices[a][c], up.weights[a][c]);
  RowMatrix P(static_cast<Eigen::Index>(up.vertices.size()), static_cast<Eigen::Index>(coarse_vertices));
  P.setFromTriplets(entries.begin(), entries.end());
  return P;
}

}  // namespace

RowMatrix transfer_matrix(const TetMesh& fine, const std::vector<char>& fine_constrained, const TetMesh& coarse,
                          const std::vector<char>& coarse_constrained, const Embedding& up, bool smooth) {
  RowMatrix P = barycentric_transfer(up, coarse.vertices.size());
  if (smooth) P = RowMatrix(ring_smoothing(fine) * P);
  P.prune([&](Eigen::Index a, Eigen::Index b, double value) {
    return !fine_constrained[static_cast<std::size_t>(a)] && !coarse_constrained[static_cast<std::size_t>(b)] &&
           std::abs(value) > 1e-6;
  });
  return P;
}

}  // namespace plica
