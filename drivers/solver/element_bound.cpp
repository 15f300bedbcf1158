// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <plica/drivers/solver/element_bound.hpp>
#include <plica/meshes/mesh_quality.hpp>

namespace plica {

std::vector<double> element_steps(const TetMesh& mesh, const std::vector<Lame<double>>& lame,
                                  const std::vector<double>& density) {
  std::vector<double> steps;
  steps.reserve(mesh.tets.size());
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
    steps.push_back(std::sqrt(density[region] / solver.eigenvalues()[5]));  // 2/w, w^2 = 4/rho times the eigenvalue
  }
  return steps;
}

double element_bound(const TetMesh& mesh, const std::vector<Lame<double>>& lame, const std::vector<double>& density) {
  return std::ranges::min(element_steps(mesh, lame, density));
}

std::vector<StiffElement> stiffest_elements(const TetMesh& mesh, const std::vector<double>& steps, std::size_t count) {
  std::vector<int> order(steps.size());
  std::iota(order.begin(), order.end(), 0);
  const auto middle = order.begin() + static_cast<std::ptrdiff_t>(std::min(count, order.size()));
  std::ranges::partial_sort(order, middle, [&](int a, int b) {
    const double of_a = steps[static_cast<std::size_t>(a)], of_b = steps[static_cast<std::size_t>(b)];
    return of_a != of_b ? of_a < of_b : a < b;
  });
  std::vector<StiffElement> worst;
  for (auto it = order.begin(); it != middle; ++it) {
    const auto e = static_cast<std::size_t>(*it);
    const std::string region = mesh.region.empty() ? "" : mesh.region_names[static_cast<std::size_t>(mesh.region[e])];
    worst.push_back({*it, region, tet_shape(mesh, *it).height_ratio, steps[e]});
  }
  return worst;
}

}  // namespace plica
