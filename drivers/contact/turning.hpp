// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/obstacles.hpp>
#include <plica/core/path.hpp>
#include <plica/kernels/contact/move_tool.hpp>
#include <vector>

// Turns on the host. A rotation is told by a vector: its direction is the axis, its length the
// angle.
namespace plica {

/// The angle as a motion: that of rotation vectors along the axis [rad].
Motion angle_of(const Turn& turn);

/// Whether an obstacle ever moves or turns.
bool moves(const ObstacleOptions& obstacle);

/// The point that it turns about at t = 0 [m].
Point turned_about(const ObstacleOptions& obstacle);

/// Of one with inertia, about its centre of mass at t = 0 [kg m^2].
Eigen::Matrix3d inertia_matrix(const ObstacleOptions& obstacle);
Point principal_moments(const ObstacleOptions& obstacle);  ///< ascending

/// How far a shape goes from a line [m]; infinity: without end, or not known.
double reach_from(const Point& on_line, const Point& along, const ShapeOptions& shape);

Mat3<double> rotation_by(const Point& vector);
/// The shortest of those that lead there.
Point rotation_vector(const Mat3<double>& rotation);

/// One with mass.
RigidTool rigid_tool(const ObstacleOptions& obstacle);

/// How an obstacle is turned in time.
class Turning {
 public:
  Turning() = default;                            ///< not at all
  Turning(const Turn& turn, const Point& about);  ///< `about` unless the turn says
  /// See path_step() for `ahead`.
  Attitude at(double time, double ahead = 0) const;

 private:
  bool turned_ = false;
  Vec3<double> centre_;
  Mat3<double> before_;  // its rotation without the angle
  std::vector<PathKnot> knots_;
  Path angle_;
};

}  // namespace plica
