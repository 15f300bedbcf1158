// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <limits>
#include <optional>
#include <plica/core/problem.hpp>
#include <string>

namespace plica {

/// How a body moves as a whole before anything touches it: a free one in uniform gravity, damped by
/// mass at most, or one that rests. Shapes do not change, so that this is exact.
struct RigidMotion {
  Point velocity = Point::Zero();  ///< at t = 0 [m/s]
  Point gravity = Point::Zero();   ///< [m/s^2]
  double damping = 0;              ///< by mass [1/s]

  Point displacement_at(double time) const;  ///< from where it starts [m]
  Point velocity_at(double time) const;      ///< [m/s]
};

/// None where the body deforms or turns by itself, or may.
std::optional<RigidMotion> rigid_motion(const Problem& problem);

/// When a body first touches something.
struct FirstTouch {
  /// not before this [s]; infinity: not until the end
  double time = std::numeric_limits<double>::infinity();
  /// then indeed: the body moves rigidly until then, and what it touches as given
  bool exact = false;
  std::string what;  ///< the obstacle's name, "a body" or "itself"
  bool expected() const { return time < std::numeric_limits<double>::infinity(); }
};

/// The earliest time up to `until` [s] at which the distance of a surface point from an obstacle is
/// no more than what both can have moved: for a body that moves rigidly what they have moved, else
/// |v| t + |g| t^2 / 2. Goes on from time to time by what is sure (conservative advancement; B.
/// Mirtich, PhD thesis, Berkeley 1996). Bodies that touch each other or themselves, and those that
/// loads or given motions move, may touch at once. Nothing is stepped.
FirstTouch first_touch(const Problem& problem, double until);

}  // namespace plica
