// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <plica/drivers/solver/element_bound.hpp>

namespace plica {

double element_bound(const TetMesh& mesh, const std::vector<Lame<double>>& lame, const std::vector<double>& density) {
  double largest = 0;
  for (std::size_t e = 0; e < mesh.tets.size(); ++e) {
    const auto region = mesh.region.empty() ? std::size_t{0} : static_cast<std::size_t>(mesh.region[e]);
    const auto& t = mesh.tets[e];
    Eigen::Matrix3d edges;
    for (int c = 0; c < 3; ++c)
      edges.col(c) = mesh.vertices[static_cast<std::size_t>(t[static_cast<std::size_t>(c + 1)])] -
                     mesh.vertices[static_cast<std::size_t>(t[0])];
    const Eigen::Matrix3d inverse = edges.inverse();
    Eigen::Matrix<double, 6, 12> strain =
        Eigen::Matrix<double, 6, 12>::Zero();  // Voigt: xx yy zz and engineering xy yz zx
    for (int c = 0; c < 4; ++c) {
      const Eigen::RowVector3d g =
          c > 0 ? Eigen::RowVector3d(inverse.row(c - 1)) : Eigen::RowVector3d(-inverse.colwise().sum());
      for (int k = 0; k < 3; ++k) strain(k, 3 * c + k) = g[k];
      strain(3, 3 * c) = g[1], strain(3, 3 * c + 1) = g[0];
      strain(4, 3 * c + 1) = g[2], strain(4, 3 * c + 2) = g[1];
      strain(5, 3 * c) = g[2], strain(5, 3 * c + 2) = g[0];
    }
    const auto& [lambda, mu] = lame[region];
    Eigen::Matrix<double, 6, 6> hooke = Eigen::Matrix<double, 6, 6>::Zero();
    hooke.topLeftCorner<3, 3>().setConstant(lambda);
    hooke.diagonal() << lambda + 2 * mu, lambda + 2 * mu, lambda + 2 * mu, mu, mu, mu;
    // the nonzero eigenvalues of B^T C B, V cancelling against the lumped rho V / 4, are those of L^T B B^T L with C = L L^T
    const Eigen::Matrix<double, 6, 6> L = hooke.llt().matrixL();
    const Eigen::Matrix<double, 6, 6> S = L.transpose() * (strain * strain.transpose()) * L;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> solver(S, Eigen::EigenvaluesOnly);
    largest = std::max(largest, 4 / density[region] * solver.eigenvalues()[5]);
  }
  return 2 / std::sqrt(largest);
}

}  // namespace plica
