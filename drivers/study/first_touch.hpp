// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <limits>
#include <optional>
#include <plica/core/problem.hpp>
#include <string>

namespace plica {

/// Rigid motion of a body before anything touches it. The body is free in uniform gravity, damped
/// by mass at most, or it rests. Shapes do not change, so that this is exact.
struct RigidMotion {
  Point velocity = Point::Zero();  ///< at t = 0 [m/s]
  Point gravity = Point::Zero();   ///< [m/s^2]
  double damping = 0;              ///< mass damping [1/s]

  Point displacement_at(double time) const;  ///< from its start [m]
  Point velocity_at(double time) const;      ///< [m/s]
};

/// Returns the rigid motion of the body; none where it deforms or turns by itself, or may.
std::optional<RigidMotion> rigid_motion(const Problem& problem);

/// First touch of a body.
struct FirstTouch {
  /// time before which nothing is touched [s]; infinity: nothing until the end
  double time = std::numeric_limits<double>::infinity();
  /// true where the touch is exactly at `time`. Until then the body moves rigidly, and the obstacle
  /// by its given motion
  bool exact = false;
  std::string what;  ///< name of the obstacle, "a body" or "itself"
  bool expected() const { return time < std::numeric_limits<double>::infinity(); }
};

/// Returns the earliest time up to `until` [s] at which the body may touch an obstacle. There the
/// distance of a surface point is no more than what point and obstacle can have moved. A body that
/// moves rigidly has a known motion; else a point moves by |v| t + |g| t^2 / 2 at most. Time
/// advances by steps in which no touch is possible (conservative advancement; B. Mirtich, PhD
/// thesis, Berkeley 1996). Bodies in contact with each other or themselves, and bodies that loads
/// or given motions move, may touch at t = 0. Nothing is stepped.
FirstTouch first_touch(const Problem& problem, double until);

}  // namespace plica
