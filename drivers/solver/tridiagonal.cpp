// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Eigenvalues>
#include <cmath>
#include <plica/drivers/solver/tridiagonal.hpp>

namespace plica {

RitzBound largest_ritz_bound(const std::vector<double>& diagonal, const std::vector<double>& beside, double next) {
  const auto vector = [](const std::vector<double>& x) {
    return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size())));
  };
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(vector(diagonal), vector(beside));
  const Eigen::Index last = solver.eigenvalues().size() - 1;
  return {solver.eigenvalues()(last), next * std::abs(solver.eigenvectors()(last, last))};
}

}  // namespace plica
