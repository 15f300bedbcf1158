// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <plica/drivers/study/lowest_eigenvalues.hpp>
#include <random>

namespace plica {

namespace {

constexpr double close_enough = 1e-9;
constexpr Eigen::Index most_products = 240;

Eigen::VectorXd random_direction(Eigen::Index size, std::mt19937& random) {
  Eigen::VectorXd x(size);
  std::normal_distribution<double> normal;
  for (double& value : x) value = normal(random);
  return x;
}

}  // namespace

std::vector<double> lowest_eigenvalues(const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& inverse,
                                       Eigen::Index size, int count) {
  const Eigen::Index most = std::min(size, most_products), wanted = std::min<Eigen::Index>(count, size);
  std::mt19937 random(1);
  Eigen::MatrixXd Q(size, most);
  Eigen::VectorXd diagonal(most), beside = Eigen::VectorXd::Zero(most);
  Eigen::VectorXd next = random_direction(size, random);
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> small;
  for (Eigen::Index used = 1; used <= most; ++used) {
    Q.col(used - 1) = next.normalized();
    next = inverse(Q.col(used - 1));
    diagonal[used - 1] = Q.col(used - 1).dot(next);
    const auto basis = Q.leftCols(used);
    for (int pass = 0; pass < 2; ++pass) next -= basis * (basis.transpose() * next);
    beside[used - 1] = next.norm();
    if (used < most && (used < 2 * wanted || used % 5 != 0)) continue;
    small.computeFromTridiagonal(diagonal.head(used), beside.head(used - 1));
    const Eigen::VectorXd residual = beside[used - 1] * small.eigenvectors().row(used - 1).cwiseAbs();
    const auto last = [&](const auto& v) { return v.tail(std::min(wanted, used)); };
    if ((last(residual).array() <= close_enough * last(small.eigenvalues()).array()).all()) break;
  }
  std::vector<double> list;
  for (Eigen::Index i = small.eigenvalues().size() - 1; i >= 0 && static_cast<Eigen::Index>(list.size()) < wanted; --i)
    list.push_back(1 / small.eigenvalues()[i]);
  return list;
}

}  // namespace plica
