// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <plica/core/time_functions.hpp>
#include <plica/drivers/contact/turning.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/kernels/loads/boundary_conditions.hpp>
#include <type_traits>

namespace plica {

namespace {

struct AlongAxis {
  Point axis;
  Motion operator()(const SteadyTurn& o) const { return SteadyMotion(o.angular_velocity * axis); }
  Motion operator()(const SineTurn& o) const {
    return SineMotion{o.amplitude * axis, o.frequency, o.phase};
  }
  Motion operator()(const PathTurn& o) const {
    PathMotion path;
    for (const auto& knot : o.knots) path.knots.push_back({knot.time, knot.angle * axis});
    return path;
  }
};

}  // namespace

Motion angle_of(const Turn& turn) {
  return std::visit(AlongAxis{turn.axis.normalized()}, turn.angle);
}

bool moves(const ObstacleOptions& o) {
  return o.mass || moves(o.motion) || (o.turn && moves(angle_of(*o.turn)));
}

Point origin_of(const ObstacleOptions& o) {
  Point origin = Point::Zero();
  visit_shape(o.shape, [&](auto shape, const auto& its) { origin = shape.origin(its); });
  return origin;
}

Point turned_about(const ObstacleOptions& obstacle) {
  return obstacle.turn && obstacle.turn->about ? *obstacle.turn->about : origin_of(obstacle);
}

ObstaclePose pose_at_start(const ObstacleOptions& options) {
  std::vector<PathKnot> knots;
  const Path path = make_path(options.motion, knots);
  ObstaclePose pose{.displacement = path_at(path, knots.data(), 0).displacement,
                    .speed = {},
                    .time = 0,
                    .turn = {}};
  if (options.turn) pose.turn = Turning(*options.turn, turned_about(options)).at(0);
  return pose;
}

Eigen::Matrix3d inertia_matrix(const ObstacleOptions& obstacle) {
  const auto& I = obstacle.inertia;
  Eigen::Matrix3d matrix = Point(I[0], I[1], I[2]).asDiagonal();
  if (I.size() == 6) {
    matrix(0, 1) = matrix(1, 0) = I[3];
    matrix(0, 2) = matrix(2, 0) = I[4];
    matrix(1, 2) = matrix(2, 1) = I[5];
  }
  return matrix;
}

Point principal_moments(const ObstacleOptions& obstacle) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertia_matrix(obstacle)).eigenvalues();
}

double reach_from(const Point& on_line, const Point& along, const ShapeOptions& shape) {
  const Point axis = along.normalized();
  const auto beside = [&](const Point& x) { return axis.cross(x - on_line).norm(); };
  double reach = std::numeric_limits<double>::infinity();
  visit_shape(shape, [&](auto, const auto& o) {
    using O = std::decay_t<decltype(o)>;
    if constexpr (requires { o.to_radius; })
      reach = std::max(beside(o.from) + o.radius, beside(o.to) + o.to_radius);
    else if constexpr (requires { o.to; })
      reach = std::max(beside(o.from), beside(o.to)) + o.radius;
    else if constexpr (std::is_same_v<O, SphereOptions>)
      reach = beside(o.centre) + o.radius;
    else if constexpr (std::is_same_v<O, BlockOptions>)
      reach = beside(o.centre) + o.size.norm() / 2;
    else if constexpr (std::is_same_v<O, SurfaceOptions>)
      reach = beside(*std::ranges::max_element(o.surface.vertices, {}, beside));
  });
  return reach;
}

Mat3<double> rotation_by(const Point& vector) {
  const double angle = vector.norm();
  if (!(angle > 0)) return Mat3<double>::identity();
  const Eigen::Matrix3d R = Eigen::AngleAxisd(angle, Point(vector / angle)).toRotationMatrix();
  Mat3<double> rotation;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) rotation[i][j] = R(i, j);
  return rotation;
}

Point rotation_vector(const Mat3<double>& rotation) {
  Eigen::Matrix3d R;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) R(i, j) = rotation[i][j];
  const Eigen::AngleAxisd turn(R);
  return turn.angle() * turn.axis();
}

RigidTool rigid_tool(const ObstacleOptions& o) {
  const CouplingOptions& c = o.coupling;
  const auto critical = [](double stiffness, double mass) {
    return 2 * std::sqrt(stiffness * mass);
  };
  RigidTool tool;
  tool.mass = *o.mass, tool.stiffness = c.stiffness;
  tool.damping = c.damping.value_or(critical(c.stiffness, *o.mass));
  if (o.inertia.empty()) return tool;
  const Eigen::Matrix3d I = inertia_matrix(o);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) tool.inertia[i][j] = I(i, j);
  tool.angular_stiffness = c.angular_stiffness;
  tool.angular_damping =
      c.angular_damping.value_or(critical(c.angular_stiffness, principal_moments(o)[2]));
  return tool;
}

Turning::Turning(const Turn& turn, const Point& about)
    : turned_(true),
      centre_(vec3<double>(turn.about.value_or(about))),
      before_(rotation_by(turn.rotation)),
      angle_(make_path(angle_of(turn), knots_)) {}

Attitude Turning::at(double time, double ahead) const {
  if (!turned_) return {};
  const PathPoint now = path_step(angle_, knots_.data(), time, ahead);
  const Vec3<double>& angle = now.displacement;
  Attitude turn{true, centre_, rotation_by({angle[0], angle[1], angle[2]}) * before_, now.velocity};
  if (const double by = ahead * std::sqrt(dot(now.velocity, now.velocity)); by > 0) {
    const double half = std::sin(by / 2) / by;  // 1 - cos(by) = 2 sin^2(by / 2)
    turn.along = std::sin(by) / by, turn.inward = 2 * half * half * ahead;
  }
  return turn;
}

}  // namespace plica
