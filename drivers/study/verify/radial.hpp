// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Core>
#include <cmath>
#include <functional>

// Exact solutions of thick walls under pressure, to compare elements with.
namespace plica {

/// Stretches, or Cauchy's stresses [Pa], in radial, hoop and axial direction. In a sphere the axial
/// one is that of the second hoop.
using Radial = Eigen::Vector3d;

/// Wall of a tube or of a hollow ball, loaded by a pressure inside.
struct RadialWall {
  double inner = 1, outer = 2;  ///< radii at rest [m]
  bool ball = false;            ///< true: a hollow ball; false: a tube
  double along = 1;             ///< stretch of a tube along its axis
  /// Cauchy's stress at given stretches, written by principal stretches [Pa]
  std::function<Radial(const Radial& stretches)> stress;
};

/// State of a wall whose outer radius has grown.
struct RadialState {
  double pressure = 0;  ///< pressure inside [Pa]
  double inner = 0;     ///< inner radius [m]
  double axial = 0;     ///< force along the axis that holds a tube's length, without an end cap [N]
};

/// Returns the state in which the outer radius is `growth` times that at rest. It is the solution
/// of
///   dr/dR = radial stretch,   ds/dR = -k (s - hoop stress) radial stretch / r
/// from s = 0 at the outer radius inwards, k = 1 in a tube and 2 in a ball, by Runge-Kutta's method
/// of fourth order. The radial stretch is the one at which the radial stress is s. Errors are
/// rounding.
RadialState inflated(const RadialWall& wall, double growth);

/// Returns Cauchy's stress from l dW/dl of isochoric stretches l, for U = kappa/4 (J^2 - 1 - 2 ln
/// J).
/// @param pulls  l dW/dl [Pa]
/// @param J      volume ratio
/// @param bulk   kappa [Pa]
inline Radial with_volume(const Radial& pulls, double J, double bulk) {
  return (pulls.array() - pulls.mean()).matrix() / J + Radial::Constant(bulk / 2 * (J - 1 / J));
}

/// Returns Cauchy's stress of neo-Hookean tissue.
inline Radial neo_hookean_stress(const Radial& stretches, double mu, double bulk) {
  const double J = stretches.prod();
  return with_volume(mu * std::pow(J, -2.0 / 3) * stretches.cwiseAbs2(), J, bulk);
}

}  // namespace plica
