// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <plica/drivers/app/output/run_files.hpp>
#include <plica/drivers/app/view/user_forces.hpp>
#include <plica/drivers/elastic/materials.hpp>

namespace plica::app {
namespace {

constexpr double patch = 0.06;  // radius of the grasped patch, over the body's size
// maximum length of the spring that counts for its force, over the body's size
constexpr double longest_pull = 0.1;
constexpr double hand_speed = 2;  // maximum speed of the hand, in body sizes per simulated second
constexpr double ball_speed = 1;  // maximum speed of the ball, in body sizes per simulated second
// maximum of h^2 k / m of a pulled vertex; with its own stiffness this must stay below 4
constexpr double pull_limit = 0.1;
// maximum of h^2 k / m of a pushed vertex; with its own stiffness this must stay below 4
constexpr double push_limit = 0.25;
constexpr double ball_stiffness = 2;  // stiffness at a vertex, over Young's modulus times an edge
constexpr double damping_ratio = 0.3;
constexpr double whole_pull = 0.6;   // full pull while every element has this part of its volume
constexpr double no_pull = 0.25;     // no pull if an element has only this part of its volume
constexpr double least_grip = 1e-3;  // grip below which give_way() does not help
constexpr double regained = 1.02;    // factor on the grip per macro step, up to 1
constexpr double look_every = 4;     // time between checks of volumes, in critical steps of level 0

template <class Rows>
Point row(const Rows& rows, std::size_t i) {
  return {static_cast<double>(rows(i, 0)), static_cast<double>(rows(i, 1)),
          static_cast<double>(rows(i, 2))};
}
template <class B>
void add(const Vectors<B>& forces, std::size_t i, const Point& force) {
  for (int k = 0; k < 3; ++k) forces(i, k) += static_cast<typename B::Real>(force[k]);
}

}  // namespace

template <class B>
UserForces<B>::UserForces(const Scene& scene, const Simulation<B>& simulation, double size)
    : scene_gravity_(scene.problem.gravity),
      size_(size),
      young_(stiffness_at_rest(scene.problem.body.material)),
      macro_step_(simulation.macro_step()),
      mesh_(scene.problem.body.levels.front()),
      nodal_(simulation.levels().front().element == "nodal"),
      between_(look_every * simulation.levels().front().critical_step) {
  if (scene_gravity_.norm() > 0) down_ = scene_gravity_.normalized();
  const auto& levels = simulation.levels();
  for (std::size_t i = 0; i < std::min(levels.size(), scene.problem.body.levels.size()); ++i) {
    LevelParts parts;
    parts.mass = vertex_masses(scene.problem.body, static_cast<int>(i));
    parts.edge = levels[i].mean_edge;
    parts.step =
        levels[i].substeps > 0 ? levels[i].share * macro_step_ / levels[i].substeps : macro_step_;
    parts.critical = simulation.him() ? levels[i].critical_step : 0;
    levels_.push_back(std::move(parts));
  }
}

template <class B>
void UserForces<B>::Follower::aim(const Point& goal, double reach, double step) {
  const Point way = goal - place;
  velocity = way * std::min(1.0, reach / std::max(way.norm(), 1e-300)) / step;
}

template <class B>
void UserForces<B>::hold(const Controls& controls, double time) {
  const bool anew = controls.pull && (!controls_.pull || controls.pull->at != controls_.pull->at);
  if (anew) ++grips_, placed_ = false;
  if (controls.tool && !controls_.tool) ball_.place = controls.tool->centre;
  controls_ = controls, start_ = time;
  more_gravity_ = down_ * controls.gravity - scene_gravity_;
  pull_ = push_ = Point::Zero();
  if (controls.pull && placed_)
    hand_.aim(controls.pull->target, hand_speed * size_ * macro_step_, macro_step_);
  if (controls.tool)
    ball_.aim(controls.tool->centre, ball_speed * size_ * macro_step_, macro_step_);
  tool_ = controls.tool;
  if (tool_) tool_->centre = ball_.place;
}

template <class B>
bool UserForces<B>::give_way() {
  grip_ *= 0.5;
  return controls_.pull && grip_ > least_grip;
}

template <class B>
void UserForces<B>::advance() {
  grip_ = std::min(1.0, grip_ * regained);
  for (Follower* one : {&hand_, &ball_})
    one->place += macro_step_ * one->velocity, one->velocity.setZero();
  if (tool_) tool_->centre = ball_.place;
}

// Uses the volumes of level 0's tetrahedra; for nodal elements, the sum of those around a vertex
template <class B>
double UserForces<B>::bearing(const ForceRequest<B>& request) const {
  std::vector<double> rest(nodal_ ? mesh_.vertices.size() : 0), now(rest);
  double least = 1;
  for (const auto& tet : mesh_.tets) {
    std::array<Eigen::Matrix3d, 2> edges;
    const auto corner = [&](int c) {
      return static_cast<std::size_t>(tet[static_cast<std::size_t>(c)]);
    };
    for (int k = 0; k < 3; ++k) {
      edges[0].col(k) = row(request.rest, corner(k + 1)) - row(request.rest, corner(0));
      edges[1].col(k) = edges[0].col(k) + row(request.displacement, corner(k + 1)) -
                        row(request.displacement, corner(0));
    }
    const double before = edges[0].determinant(), after = edges[1].determinant();
    if (!nodal_) least = std::min(least, after / before);
    for (int c = 0; nodal_ && c < 4; ++c) rest[corner(c)] += before, now[corner(c)] += after;
  }
  for (std::size_t v = 0; v < rest.size(); ++v)
    if (rest[v] > 0) least = std::min(least, now[v] / rest[v]);
  return std::clamp((least - no_pull) / (whole_pull - no_pull), 0.0, 1.0);
}

template <class B>
double UserForces<B>::since_start(const ForceRequest<B>& request) const {
  return std::clamp(request.time + request.ahead - start_, 0.0, macro_step_);
}

template <class B>
void UserForces<B>::operator()(const ForceRequest<B>& request) {
  if constexpr (B::on_host) {
    if (static_cast<std::size_t>(request.level) >= levels_.size()) return;
    request.exec.fence("plica::hands");
    LevelParts& level = levels_[static_cast<std::size_t>(request.level)];
    if (more_gravity_ != Point::Zero())
      for (std::size_t i = 0; i < level.mass.size(); ++i)
        add<B>(request.force, i, level.mass[i] * more_gravity_);
    if (controls_.pull && request.level == 0 && !(std::abs(request.time - looked_) < between_))
      bears_ = bearing(request), looked_ = request.time;
    if (controls_.pull) add_pull(level, request);
    if (controls_.tool) add_push(level, request);
  }
}

template <class B>
void UserForces<B>::take_hold(LevelParts& level, const ForceRequest<B>& request) {
  level.grip = grips_;
  level.held.clear(), level.weight.clear(), level.offset.clear();
  const double radius = std::max(patch * size_, 1.2 * level.edge);
  double sum = 1e-300;  // above 0, since no vertex may be near
  Point middle = Point::Zero();
  for (std::size_t i = 0; i < level.mass.size(); ++i) {
    const double w = 1 - (row(request.rest, i) - controls_.pull->at).norm() / radius;
    if (w <= 0) continue;
    level.held.push_back(i), level.weight.push_back(w);
    level.offset.push_back(row(request.rest, i) + row(request.displacement, i));
    sum += w, middle += w * level.offset.back();
  }
  // starts at the middle of the patch, wherever the mouse is
  if (!placed_ && !level.held.empty()) hand_.place = middle / sum, placed_ = true;
  for (std::size_t j = 0; j < level.held.size(); ++j)
    level.weight[j] /= sum, level.offset[j] -= middle / sum;
}

// Returns the stiffness m / h^2 of a vertex for a step h; infinite on implicit levels. Cycle him
// adds inertia to motion that is finer than its step resolves. For a patch this has the effect of a
// shorter step h.
template <class B>
double UserForces<B>::most_stiffness(const LevelParts& level, const ForceRequest<B>& request,
                                     std::size_t vertex, double radius) const {
  if (request.stiffness.extent(0) > 0) return HUGE_VAL;  // implicit
  double step = level.step;
  if (level.critical > 0)
    step = std::min(step, level.critical * std::max(1.0, 2 * radius / level.edge));
  return level.mass[vertex] / (step * step);
}

// Pulls every vertex of the patch to its place in the patch at the time of the grasp, like forceps.
// A thread would pull all vertices to one point.
template <class B>
void UserForces<B>::add_pull(LevelParts& level, const ForceRequest<B>& request) {
  using Real = typename B::Real;
  if (level.grip != grips_) take_hold(level, request);
  const Point target = hand_.place + since_start(request) * hand_.velocity;
  Point sum = Point::Zero();
  for (std::size_t j = 0; j < level.held.size(); ++j) {
    const std::size_t i = level.held[j];
    const Point v = row(request.velocity, i),
                x = row(request.rest, i) + row(request.displacement, i) + request.ahead * v;
    const double k = grip_ * bears_ *
                     std::min(level.weight[j] * controls_.stiffness,
                              pull_limit * most_stiffness(level, request, i,
                                                          std::max(patch * size_, level.edge)));
    const double c = 2 * damping_ratio * std::sqrt(k * level.mass[i]);
    const Point way = target + level.offset[j] - x;
    const Point held = way * std::min(1.0, longest_pull * size_ / std::max(way.norm(), 1e-300));
    const Point force = k * held - c * (v - hand_.velocity);
    add<B>(request.force, i, force);
    if (request.stiffness.extent(0) > 0)
      for (int b = 0; b < 3; ++b)
        request.stiffness(i, b) += static_cast<Real>(k + c / request.step);
    sum += force;
  }
  if (request.level == 0) pull_ = sum;
}

template <class B>
void UserForces<B>::add_push(const LevelParts& level, const ForceRequest<B>& request) {
  using Real = typename B::Real;
  const Point centre = ball_.place + since_start(request) * ball_.velocity;
  const double radius = controls_.tool->radius;
  Point sum = Point::Zero();
  for (std::size_t i = 0; i < level.mass.size(); ++i) {
    const Point v = row(request.velocity, i);
    const Point away =
        row(request.rest, i) + row(request.displacement, i) + request.ahead * v - centre;
    const double distance = away.norm(), depth = radius - distance;
    if (!(depth > 0) || !(distance > 0)) continue;
    const Point n = away / distance;
    const double k = std::min(ball_stiffness * young_ * level.edge,
                              push_limit * most_stiffness(level, request, i, radius));
    const double c = damping_ratio * std::sqrt(k * level.mass[i]);
    const Point force = std::max(k * depth - c * n.dot(v - ball_.velocity), 0.0) * n;
    add<B>(request.force, i, force);
    if (request.stiffness.extent(0) > 0) {
      const double stiff = k + c / request.step, pairs[6] = {n[0] * n[0], n[1] * n[1], n[2] * n[2],
                                                             n[0] * n[1], n[0] * n[2], n[1] * n[2]};
      for (int b = 0; b < 6; ++b) request.stiffness(i, b) += static_cast<Real>(stiff * pairs[b]);
    }
    sum += force;
  }
  if (request.level == 0) push_ = sum;
}

#define PLICA_INSTANTIATE(Real, Exec) template class UserForces<Backend<Real, Exec>>;
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica::app
