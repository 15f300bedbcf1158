// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <optional>
#include <plica/core/mesh.hpp>
#include <variant>
#include <vector>

/// Given motions. A translation of vertices or obstacles is a displacement from where they are at
/// rest, as a function of time. A turn of an obstacle is an angle as a function of time.
namespace plica {

/// Translation with one velocity from the start.
struct SteadyMotion {
  Point velocity = Point::Zero();  ///< [m/s] from t = 0
  SteadyMotion() = default;
  /// Takes the velocity from any Eigen vector [m/s].
  template <class Expression>
  SteadyMotion(const Eigen::MatrixBase<Expression>& v) : velocity(v) {}
};

/// Translation in straight lines from one displacement to the next. It stays at the first before
/// its time, and at the last after.
struct PathMotion {
  /// A displacement at a time.
  struct Knot {
    double time = 0;                     ///< [s], each after the one before
    Point displacement = Point::Zero();  ///< [m]
  };
  std::vector<Knot> knots;  ///< at least one
};

/// Translation amplitude * (sin(2 pi frequency t + phase) - sin(phase)). The displacement is zero
/// at t = 0 for any phase. With phase -pi/2 the velocity is also zero then.
struct SineMotion {
  Point amplitude = Point::Zero();  ///< [m]
  double frequency = 1;             ///< [1/s]
  double phase = 0;                 ///< [rad]
};

/// A translation of any kind.
using Motion = std::variant<SteadyMotion, PathMotion, SineMotion>;

/// Turn at one rate from the start.
struct SteadyTurn {
  double angular_velocity = 0;  ///< [rad/s] from t = 0
};

/// Turn whose angle is linear in time between given ones. It stays at the first before its time,
/// and at the last after.
struct PathTurn {
  /// An angle at a time.
  struct Knot {
    double time = 0;   ///< [s], each after the one before
    double angle = 0;  ///< [rad]
  };
  std::vector<Knot> knots;  ///< at least one
};

/// Turn by the angle amplitude * (sin(2 pi frequency t + phase) - sin(phase)), zero at t = 0.
struct SineTurn {
  double amplitude = 0;  ///< [rad]
  double frequency = 1;  ///< [1/s]
  double phase = 0;      ///< [rad]
};

/// Turn by an angle about an axis, which moves with the translation. A point X goes to x = about +
/// R (X - about) + displacement.
struct Turn {
  /// Axis, counter-clockwise where it points at the eye; its length does not matter
  Point axis = Point::UnitZ();
  /// Point on the axis at t = 0 [m]; none: the point that torques on the obstacle are about
  std::optional<Point> about = {};
  /// Rotation before the angle, about the same point: its direction is the axis, its length the
  /// angle [rad]
  Point rotation = Point::Zero();
  std::variant<SteadyTurn, PathTurn, SineTurn> angle = {};  ///< angle over time
};

}  // namespace plica
