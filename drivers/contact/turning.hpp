// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/obstacles.hpp>
#include <plica/core/path.hpp>
#include <plica/kernels/contact/move_tool.hpp>
#include <vector>

// Turns of obstacles, computed on the host. A rotation vector has the direction of the axis and the
// length of the angle [rad].
namespace plica {

/// Returns the angle of a turn as a motion of rotation vectors along the axis [rad].
Motion angle_of(const Turn& turn);

/// Returns true where an obstacle ever moves or turns.
bool moves(const ObstacleOptions& obstacle);

/// Returns the point that an obstacle turns about at t = 0 [m].
Point turned_about(const ObstacleOptions& obstacle);

/// Returns the origin of an obstacle's shape, before its motion [m].
Point origin_of(const ObstacleOptions& obstacle);
/// Returns the pose of an obstacle at t = 0.
ObstaclePose pose_at_start(const ObstacleOptions& obstacle);

/// Returns the inertia of an obstacle about its centre of mass at t = 0 [kg m^2].
Eigen::Matrix3d inertia_matrix(const ObstacleOptions& obstacle);
/// Returns the principal moments of inertia, ascending [kg m^2].
Point principal_moments(const ObstacleOptions& obstacle);

/// Returns the largest distance of a shape from a line [m]; infinity: endless, or not known.
double reach_from(const Point& on_line, const Point& along, const ShapeOptions& shape);

/// Returns the rotation matrix of a rotation vector [rad].
Mat3<double> rotation_by(const Point& vector);
/// Returns the shortest rotation vector of a rotation matrix [rad].
Point rotation_vector(const Mat3<double>& rotation);

/// Returns mass, inertia and coupling of an obstacle with mass.
RigidTool rigid_tool(const ObstacleOptions& obstacle);

/// Attitude of an obstacle as a function of time.
class Turning {
 public:
  Turning() = default;  ///< makes one that never turns
  /// Makes one that turns about `about` [m], unless the turn names another point.
  Turning(const Turn& turn, const Point& about);
  /// Returns the attitude at `time` [s], with the mean velocity of the next `ahead` [s].
  Attitude at(double time, double ahead = 0) const;

 private:
  bool turned_ = false;
  Vec3<double> centre_;
  Mat3<double> before_;  // rotation at angle 0
  std::vector<PathKnot> knots_;
  Path angle_;
};

}  // namespace plica
