// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Core>

namespace plica {

/// The coarsest level's linear problem K phi = w^2 M phi at rest, and how the inverse mass answers its modes.
class CoarseModes {
 public:
  static constexpr Eigen::Index most_modes = 1200;     ///< solved for; larger levels answer as implicit Euler would
  static constexpr Eigen::Index most_unknowns = 4500;  ///< of a dense matrix

  /// [3 vertices x 3 vertices] each; M of vertices without mass gets a unit of its own.
  CoarseModes(Eigen::MatrixXd K, Eigen::MatrixXd M);

  /// S = Phi s Phi^T [1/kg]. With all modes s = min(sinc^2(w t / 2), kappa / (w t)^2), beyond w t = pi only the latter: leapfrog
  /// then has the exact frequency of each mode below, and none is faster than kappa allows. Else (M + t^2 K / kappa)^-1.
  Eigen::MatrixXd answer(double t, double kappa) const;

  /// The largest t^2 w^2 s, at most kappa.
  double largest(double t, double kappa) const;

 private:
  Eigen::MatrixXd K_, M_, modes_;  // K and M only without the modes
  Eigen::VectorXd squares_;        // w^2 [1/s^2]
};

}  // namespace plica
