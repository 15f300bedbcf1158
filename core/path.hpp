// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/small.hpp>

// A Motion in the form of the device, always double. A time after many steps, and a displacement
// from it, keep their digits.
namespace plica {

/// A displacement at a time.
struct PathKnot {
  double time = 0;  ///< [s]
  Vec3<double> displacement;
};

/// Sum of a constant velocity, a sine and a polygon. Parts that a motion does not have are 0.
struct Path {
  Vec3<double> velocity;          ///< [m/s]
  Vec3<double> amplitude;         ///< [m]
  double rate = 0, phase = 0;     ///< [rad/s], [rad]
  int first_knot = 0, knots = 0;  ///< place among the knots of all paths
};

/// Axis of a turn by an angle, which is the x component of a path.
struct TurnAxis {
  bool turns = false;   ///< false: the path is a translation, and the other members are not used
  Vec3<double> axis;    ///< unit vector
  Mat3<double> before;  ///< rotation at angle 0
};

/// Displacement and velocity of a path at one time.
struct PathPoint {
  Vec3<double> displacement;  ///< [m]
  Vec3<double> velocity;      ///< [m/s]
};

}  // namespace plica
