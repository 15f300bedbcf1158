// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <plica/drivers/solver/him/coarse_modes.hpp>

namespace plica {

namespace {

double answer_of_mode(double square, double t, double kappa) {
  const double x = t * std::sqrt(std::max(0.0, square));
  const double cap = x > 0 ? std::min(1.0, kappa / (x * x)) : 1.0;
  if (x < 1e-4) return 1;
  return x < std::numbers::pi ? std::min(std::pow(std::sin(x / 2) / (x / 2), 2), cap) : cap;
}

}  // namespace

CoarseModes::CoarseModes(Eigen::MatrixXd K, Eigen::MatrixXd M) : K_(std::move(K)), M_(std::move(M)) {
  const double typical = M_.diagonal().maxCoeff();
  for (Eigen::Index k = 0; k < M_.rows(); ++k) {
    if (!(M_(k, k) > 0)) M_(k, k) = typical, K_(k, k) = 0;  // nothing reaches it
    M_(k, k) *= 1 + 1e-9;                                   // vertices that barely differ do not make it singular
  }
  if (M_.rows() > most_modes) return;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(K_, M_);
  squares_ = solver.eigenvalues(), modes_ = solver.eigenvectors();
  K_.resize(0, 0), M_.resize(0, 0);
}

Eigen::MatrixXd CoarseModes::answer(double t, double kappa) const {
  if (squares_.size() == 0) {
    const Eigen::LLT<Eigen::MatrixXd> factor(M_ + (t * t / kappa) * K_);
    return factor.solve(Eigen::MatrixXd::Identity(M_.rows(), M_.cols()));
  }
  const Eigen::VectorXd s = squares_.unaryExpr([&](double square) { return answer_of_mode(square, t, kappa); });
  return modes_ * s.asDiagonal() * modes_.transpose();
}

double CoarseModes::largest(double t, double kappa) const {
  if (squares_.size() == 0) return kappa;
  double most = 0;
  for (const double square : squares_) most = std::max(most, t * t * square * answer_of_mode(square, t, kappa));
  return most;
}

}  // namespace plica
