// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <plica/core/row_ranges.hpp>
#include <plica/drivers/elastic/element_bound.hpp>
#include <plica/meshes/mesh_quality.hpp>

namespace plica {

namespace {

/// Returns 2/w of one element alone [s].
/// With B its strains per displacement and C Hooke's law, w^2 is 4 / rho times the largest
/// eigenvalue of B^T C B: the volume V cancels against the lumped mass rho V / 4. G is the sum of g
/// g^T over the gradients g of the corners. In the principal axes of G shear and stretch are
/// separate. The eigenvalues mu (G_i + G_j) of shear are never the largest; stretch has the matrix
/// (lambda 1 1^T + 2 mu) G.
double element_step(const TetMesh& mesh, std::size_t e, const std::vector<Lame<double>>& lame,
                    const std::vector<double>& density) {
  const auto region =
      mesh.region.empty() ? std::size_t{0} : static_cast<std::size_t>(mesh.region[e]);
  const auto& t = mesh.tets[e];
  Eigen::Matrix3d edges;
  for (int c = 0; c < 3; ++c)
    edges.col(c) = mesh.vertices[static_cast<std::size_t>(t[static_cast<std::size_t>(c + 1)])] -
                   mesh.vertices[static_cast<std::size_t>(t[0])];
  const Eigen::Matrix3d inverse = edges.inverse();
  const Eigen::RowVector3d first = inverse.colwise().sum();
  const Eigen::Matrix3d G = inverse.transpose() * inverse + first.transpose() * first;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;  // closed form: to about 8 digits
  solver.computeDirect(G, Eigen::EigenvaluesOnly);
  const Eigen::Vector3d root = solver.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  const auto& [lambda, mu] = lame[region];
  Eigen::Matrix3d stretch = lambda * root * root.transpose();
  stretch.diagonal() += 2 * mu * root.cwiseAbs2();
  solver.computeDirect(stretch, Eigen::EigenvaluesOnly);
  return std::sqrt(density[region] / solver.eigenvalues()[2]);  // 2/w
}

}  // namespace

std::vector<double> element_steps(const TetMesh& mesh, const std::vector<Lame<double>>& lame,
                                  const std::vector<double>& density) {
  std::vector<double> steps(mesh.tets.size());
  for_row_ranges(steps.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t e = first; e < last; ++e) steps[e] = element_step(mesh, e, lame, density);
  });
  return steps;
}

double element_bound(const TetMesh& mesh, const std::vector<Lame<double>>& lame,
                     const std::vector<double>& density) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t e = 0; e < mesh.tets.size(); ++e)
    least = std::min(least, element_step(mesh, e, lame, density));
  return least;
}

std::vector<StiffElement> stiffest_elements(const TetMesh& mesh, const std::vector<double>& steps,
                                            std::size_t count) {
  std::vector<int> order(steps.size());
  std::iota(order.begin(), order.end(), 0);
  const auto middle = order.begin() + static_cast<std::ptrdiff_t>(std::min(count, order.size()));
  std::ranges::partial_sort(order, middle, [&](int a, int b) {
    const double of_a = steps[static_cast<std::size_t>(a)],
                 of_b = steps[static_cast<std::size_t>(b)];
    return of_a != of_b ? of_a < of_b : a < b;
  });
  std::vector<StiffElement> worst;
  for (auto it = order.begin(); it != middle; ++it) {
    const auto e = static_cast<std::size_t>(*it);
    const std::string region =
        mesh.region.empty() ? "" : mesh.region_names[static_cast<std::size_t>(mesh.region[e])];
    worst.push_back({*it, region, tet_shape(mesh, *it).height_ratio, steps[e]});
  }
  return worst;
}

}  // namespace plica
