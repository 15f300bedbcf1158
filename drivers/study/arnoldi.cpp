// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>
#include <plica/drivers/study/arnoldi.hpp>

namespace plica {

RitzValue largest_ritz_value(const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& map,
                             const Eigen::VectorXd& start, Eigen::Index dimension) {
  const Eigen::Index m = std::min(dimension, start.size());
  Eigen::MatrixXd Q(start.size(), m), H = Eigen::MatrixXd::Zero(m, m);
  Q.col(0) = start.normalized();
  Eigen::Index used = 0;
  double beyond = 0;
  while (used < m) {
    Eigen::VectorXd w = map(Q.col(used));
    const double size = w.norm();
    const auto basis = Q.leftCols(used + 1);
    for (int pass = 0; pass < 2; ++pass) {
      const Eigen::VectorXd h = basis.transpose() * w;
      H.col(used).head(used + 1) += h;
      w -= basis * h;
    }
    beyond = w.norm();
    ++used;
    if (used == m || !(beyond > 10 * std::numeric_limits<double>::epsilon() * size)) break;
    H(used, used - 1) = beyond;
    Q.col(used) = w / beyond;
  }
  const Eigen::EigenSolver<Eigen::MatrixXd> small(H.topLeftCorner(used, used));
  Eigen::Index largest = 0;
  small.eigenvalues().cwiseAbs().maxCoeff(&largest);
  const std::complex<double> value = small.eigenvalues()[largest];
  const Eigen::VectorXcd y = small.eigenvectors().col(largest);
  const double of_it = std::abs(value) * y.norm();
  return {value, of_it > 0 ? beyond * std::abs(y[used - 1]) / of_it : 0};
}

}  // namespace plica
