// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <optional>
#include <plica/core/mesh.hpp>
#include <variant>
#include <vector>

/// Given translations, of vertices or obstacles: displacement from where they are at rest, as a
/// function of time. And turns of obstacles: an angle as a function of time.
namespace plica {

/// With one velocity from the start.
struct SteadyMotion {
  Point velocity = Point::Zero();  ///< [m/s] from t = 0
  SteadyMotion() = default;
  /// From any Eigen vector [m/s].
  template <class Expression>
  SteadyMotion(const Eigen::MatrixBase<Expression>& v) : velocity(v) {}
};

/// Straight from one displacement to the next; it stays at the first before, and at the last after.
struct PathMotion {
  /// A displacement at a time.
  struct Knot {
    double time = 0;                     ///< [s], each after the one before
    Point displacement = Point::Zero();  ///< [m]
  };
  std::vector<Knot> knots;  ///< at least one
};

/// amplitude * (sin(2 pi frequency t + phase) - sin(phase)). The displacement is zero at t = 0 for
/// any phase. With phase -pi/2 the velocity is also zero then.
struct SineMotion {
  Point amplitude = Point::Zero();  ///< [m]
  double frequency = 1;             ///< [1/s]
  double phase = 0;                 ///< [rad]
};

/// Any of them.
using Motion = std::variant<SteadyMotion, PathMotion, SineMotion>;

/// At one rate from the start.
struct SteadyTurn {
  double angular_velocity = 0;  ///< [rad/s] from t = 0
};

/// Straight from one angle to the next; it stays at the first before, and at the last after.
struct PathTurn {
  /// An angle at a time.
  struct Knot {
    double time = 0;   ///< [s], each after the one before
    double angle = 0;  ///< [rad]
  };
  std::vector<Knot> knots;  ///< at least one
};

/// amplitude * (sin(2 pi frequency t + phase) - sin(phase)), as a SineMotion
struct SineTurn {
  double amplitude = 0;  ///< [rad]
  double frequency = 1;  ///< [1/s]
  double phase = 0;      ///< [rad]
};

/// By an angle about an axis, which goes along with the translation: x = about + R (X - about) +
/// displacement.
struct Turn {
  /// counter-clockwise where it points at the eye; its length does not matter
  Point axis = Point::UnitZ();
  /// on the axis, at t = 0 [m]; none: what torques on the obstacle are about
  std::optional<Point> about = {};
  /// Before the angle, about the same point: its direction is the axis, its length the angle [rad].
  Point rotation = Point::Zero();
  std::variant<SteadyTurn, PathTurn, SineTurn> angle = {};  ///< how far it has turned
};

}  // namespace plica
