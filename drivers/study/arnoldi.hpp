// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Core>
#include <complex>
#include <functional>

namespace plica {

/// An eigenvalue of a map as a Krylov space sees it.
struct RitzValue {
  std::complex<double> value;
  double residual = 0;  ///< |A y - value y| / |value y| of its vector y
};

/// The largest by modulus in the space of start, A start, A^2 start ... of at most `dimension` (Arnoldi 1951, orthogonalised
/// twice); exact where that space holds no more.
RitzValue largest_ritz_value(const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& map,
                             const Eigen::VectorXd& start, Eigen::Index dimension);

}  // namespace plica
