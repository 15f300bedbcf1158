// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/small.hpp>

// A Motion as the device holds it, always double: a time of many steps and a displacement from it
// keep their digits.
namespace plica {

struct PathKnot {
  double time = 0;  ///< [s]
  Vec3<double> displacement;
};

/// The sum of a constant velocity, a sine and a polygon; what a motion does not have is 0.
struct Path {
  Vec3<double> velocity;          ///< [m/s]
  Vec3<double> amplitude;         ///< [m]
  double rate = 0, phase = 0;     ///< [rad/s], [rad]
  int first_knot = 0, knots = 0;  ///< among those of all paths
};

/// Where it has got to.
struct PathPoint {
  Vec3<double> displacement;  ///< [m]
  Vec3<double> velocity;      ///< [m/s]
};

}  // namespace plica
