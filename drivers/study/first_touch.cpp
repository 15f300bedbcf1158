// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <functional>
#include <plica/core/time_functions.hpp>
#include <plica/drivers/body/initial_state.hpp>
#include <plica/drivers/contact/turning.hpp>
#include <plica/drivers/cycles/him/advice.hpp>
#include <plica/drivers/study/first_touch.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/kernels/loads/boundary_conditions.hpp>
#include <plica/meshes/mesh_quality.hpp>

namespace plica {

namespace {

constexpr double touching = 1e-3;  // gap that counts as a touch, over the mean edge
// maximum number of advances of time per obstacle; then the time so far, which is a safe bound
constexpr int most_advances = 200;

bool starts_turning(const InitialOptions& initial) {
  return initial.angular_velocity.norm() > 0 || initial.twist || !initial.parts.empty();
}

bool something_drives(const Problem& p) {
  return !p.body.loads.empty() || p.surface_forces ||
         std::ranges::any_of(p.body.prescribed, [](const PrescribedMotion& given) {
           return given.rotate || moves(given.motion);
         });
}

/// Pose of an obstacle over time, by its motion and turn.
class Course {
 public:
  explicit Course(const ObstacleOptions& o) : path_(make_path(o.motion, knots_)) {
    if (o.turn) turning_.emplace(*o.turn, turned_about(o));
  }
  ObstaclePose at(double time) const {
    ObstaclePose pose{.displacement = path_at(path_, knots_.data(), time).displacement,
                      .speed = {},
                      .time = time,
                      .turn = {}};
    if (turning_) pose.turn = turning_->at(time);
    return pose;
  }

 private:
  std::vector<PathKnot> knots_;
  Path path_;
  std::optional<Turning> turning_;
};

/// Distance of a point from a shape, or a lower bound of it [m]. For a surface it is the distance
/// from its bounding box, since a surface's distances are only sampled at set-up.
using Distance = std::function<double(const Vec3<double>&)>;

Distance distance_from(const ShapeOptions& shape, bool& exact) {
  Distance distance;
  visit_shape(shape, [&](auto one, const auto& its) {
    if constexpr (requires { one.template shape<double>(its); }) {
      distance = [gap = one.template shape<double>(its)](const Vec3<double>& x) {
        return gap(x).distance;
      };
      exact = true;
    } else {
      const Box box = bounding_box(its.surface.vertices);
      const double around = its.thickness / 2;
      distance = [box, around](const Vec3<double>& x) {
        const Point p(x[0], x[1], x[2]);
        return (p - p.cwiseMax(box.min).cwiseMin(box.max)).norm() - around;
      };
      exact = false;
    }
  });
  return distance;
}

/// Motion of a body until it touches something, as far as it is known.
struct Approach {
  std::vector<Point> places;  // points of the surface at t = 0 [m]
  // none: its points may go anywhere within speed t + |gravity| t^2 / 2
  std::optional<RigidMotion> motion;
  double speed = 0, gravity = 0;

  Point displacement(double t) const { return motion ? motion->displacement_at(t) : Point::Zero(); }
  double astray(double t) const { return motion ? 0 : speed * t + gravity * t * t / 2; }
  double fastest(double t) const {
    return motion ? motion->velocity_at(t).norm() : speed + gravity * t;
  }
  double accelerates(double t) const {
    return motion ? (motion->gravity - motion->damping * motion->velocity_at(t)).norm() : gravity;
  }
};

double fastest_of(const ObstacleOptions& o, const std::vector<Point>& places) {
  double speed = fastest(o.motion);
  if (!o.turn) return speed;
  const Point about = turned_about(o);
  double reach = 0;
  for (const Point& x : places) reach = std::max(reach, (x - about).norm());
  return speed +
         fastest(angle_of(*o.turn)) * std::min(2 * reach, reach_from(about, o.turn->axis, o.shape));
}

// Returns the time in which v t + a t^2 / 2 reaches a distance
double time_to_go(double distance, double v, double a) {
  if (!(a > 0)) return v > 0 ? distance / v : std::numeric_limits<double>::infinity();
  return 2 * distance / (v + std::sqrt(v * v + 2 * a * distance));
}

FirstTouch touch_of(const ObstacleOptions& o, const Approach& body, double close, double until) {
  FirstTouch touch;
  bool exact = false;
  const Distance distance = distance_from(o.shape, exact);
  const Course course(o);
  constexpr double never = std::numeric_limits<double>::infinity();
  const double speed = fastest_of(o, body.places), wanted = o.grasp ? grasp_reach(*o.grasp) : 0;
  // a grasp at any distance acts when it closes
  const bool anywhere = wanted == never;
  const double reach = anywhere ? 0 : wanted, closes = !anywhere ? never
                                                       : o.grasp->from.empty()
                                                           ? 0
                                                           : o.grasp->from.front();
  double t = 0;
  for (int i = 0; i < most_advances; ++i) {
    const ObstaclePose pose = course.at(t);
    const Vec3<double> moved = vec3<double>(body.displacement(t));
    double gap = std::numeric_limits<double>::infinity();
    for (const Point& x : body.places)
      gap = std::min(gap, distance(pose.local(vec3<double>(x) + moved)));
    gap -= reach + body.astray(t);
    if (gap <= close) {
      touch.time = t, touch.exact = exact && body.motion && !o.grasp;
      return touch;
    }
    t = std::min(t + time_to_go(gap, speed + body.fastest(t), body.accelerates(t)), closes);
    if (!(t < until)) return touch;
    if (t == closes) break;
  }
  touch.time = t;
  return touch;
}

}  // namespace

Point RigidMotion::displacement_at(double t) const {
  if (damping * t < 1e-6) return t * velocity + t * t / 2 * gravity;
  const double faded = -std::expm1(-damping * t) / damping;
  return faded * velocity + (t - faded) / damping * gravity;
}

Point RigidMotion::velocity_at(double t) const {
  if (damping * t < 1e-6) return velocity + t * gravity;
  return std::exp(-damping * t) * velocity - std::expm1(-damping * t) / damping * gravity;
}

std::optional<RigidMotion> rigid_motion(const Problem& p) {
  const InitialOptions& initial = p.body.initial;
  if (something_drives(p) || has_pairs(p) || starts_deformed(initial) || starts_turning(initial))
    return {};
  const bool rests = !(initial.velocity.norm() > 0) && !(p.gravity.norm() > 0);
  if (rests) return RigidMotion{};
  const bool evenly = std::ranges::none_of(
      p.body.regions, [](const auto& r) { return r.second.damping.mass.has_value(); });
  if (!p.body.fixed.empty() || !p.body.prescribed.empty() || !evenly) return {};
  return RigidMotion{initial.velocity, p.gravity, p.body.damping.mass};
}

FirstTouch first_touch(const Problem& p, double until) {
  FirstTouch first;
  if (!has_contact(p) || !(until > 0)) return first;
  if (has_pairs(p)) return {0, false, p.body.parts.size() > 1 ? "a body" : "itself"};
  const auto& obstacles = p.contact.obstacles;
  const bool follows = std::ranges::any_of(
      obstacles, [](const auto& o) { return o.mass && (moves(o.motion) || o.turn); });
  if (something_drives(p) || starts_deformed(p.body.initial) || follows)
    return {0, false, obstacle_name(p.contact, 0)};
  Approach body{places_at_start(p.body), rigid_motion(p), 0, p.gravity.norm()};
  const TetMesh& mesh = p.body.levels.front();
  const Box box = bounding_box(mesh.vertices);
  for (const Point& v : initial_velocity(p.body.initial, mesh, (box.min + box.max) / 2))
    body.speed = std::max(body.speed, v.norm());
  const double close = touching * mean_edge_length(mesh);
  for (std::size_t o = 0; o < obstacles.size(); ++o) {
    FirstTouch touch = touch_of(obstacles[o], body, close, std::min(until, first.time));
    if (touch.time < first.time) first = std::move(touch), first.what = obstacle_name(p.contact, o);
  }
  return first;
}

}  // namespace plica
