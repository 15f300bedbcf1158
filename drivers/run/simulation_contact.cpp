// SPDX-License-Identifier: BSD-3-Clause
// Motion of obstacles as callers set it, and queries of a simulation's contact.
#include <plica/core/text.hpp>
#include <plica/drivers/contact/turning.hpp>
#include <plica/drivers/run/move_obstacles.hpp>
#include <plica/drivers/run/simulation_impl.hpp>
#include <plica/drivers/run/validate.hpp>
#include <plica/meshes/boundary_triangles.hpp>

namespace plica {

template <class B>
const Contact<B>& Simulation<B>::Impl::contact_with(int obstacle) const {
  const int count = static_cast<int>(problem.contact.obstacles.size());
  if (obstacle < 0 || obstacle >= count)
    throw InputError(text("there is no obstacle ", obstacle, "; the problem has ", count,
                          ", which count from 0"));
  const Contact<B>* contact = (*built.hierarchy)[0].contact();
  if (!contact)
    throw InputError("the body has no surface that could touch obstacles; expected body.surface");
  return *contact;
}

template <class B>
void Simulation<B>::set_obstacle_motion(int obstacle, const Motion& motion) {
  impl_->contact_with(obstacle);  // throws where there is no such obstacle
  validate_motion(motion);
  impl_->move(obstacle, motion);
}
template <class B>
void Simulation<B>::set_obstacle_turn(int obstacle, const std::optional<Turn>& turn) {
  impl_->contact_with(obstacle);
  const auto number = static_cast<std::size_t>(obstacle);
  const ObstacleOptions& its = impl_->problem.contact.obstacles[number];
  if (turn && its.mass && its.inertia.empty())
    throw InputError(obstacle_name(impl_->problem.contact, number) +
                     " has mass, and does not turn; expected " + "contact.obstacles." +
                     std::to_string(obstacle) + " without mass, or with inertia");
  if (turn) validate_turn(*turn);
  impl_->move(obstacle, turn);
}
template <class B>
void Simulation<B>::Impl::move(int obstacle, const typename MotionCommands<B>::Command& how) {
  motions.record(contact_with(obstacle), time, obstacle, how);
  budget_known = false;
}

namespace {
void expect_finite_move(const char* name, const Point& value) {
  if (!value.allFinite()) throw InputError(std::string(name) + ": expected finite numbers");
}
}  // namespace

template <class B>
void Simulation<B>::move_obstacle(int obstacle, const Point& displacement) {
  expect_finite_move("displacement", displacement);
  const double now = impl_->time;
  set_obstacle_motion(obstacle, PathMotion{{{now, obstacle_displacement(obstacle)},
                                            {now + impl_->next_span(), displacement}}});
}
template <class B>
void Simulation<B>::move_obstacle(int obstacle, const Point& displacement, const Point& rotation) {
  expect_finite_move("displacement", displacement), expect_finite_move("rotation", rotation);
  const ObstacleMotion<B> place = impl_->contact_with(obstacle).place(obstacle, impl_->time);
  const Vec3<double>& about = place.pose->turn.turned ? place.pose->turn.centre : place.origin;
  const Point before = obstacle_rotation(obstacle);
  const Point way = rotation_vector(rotation_by(rotation) * rotation_by(-before));
  const double now = impl_->time, angle = way.norm();
  set_obstacle_turn(
      obstacle, Turn{angle > 0 ? way : Point(Point::UnitZ()), Point(about[0], about[1], about[2]),
                     before, PathTurn{{{now, 0}, {now + impl_->next_span(), angle}}}});
  move_obstacle(obstacle, displacement);
}
template <class B>
Point Simulation<B>::obstacle_displacement(int obstacle) const {
  const Vec3<double> d =
      impl_->contact_with(obstacle).place(obstacle, impl_->time).pose->displacement;
  return {d[0], d[1], d[2]};
}
template <class B>
Point Simulation<B>::obstacle_rotation(int obstacle) const {
  const Attitude turn = impl_->contact_with(obstacle).place(obstacle, impl_->time).pose->turn;
  return turn.turned ? rotation_vector(turn.rotation) : Point(Point::Zero());
}
template <class B>
Point Simulation<B>::obstacle_origin(int obstacle) const {
  const ObstacleMotion<B> place = impl_->contact_with(obstacle).place(obstacle, impl_->time);
  const Vec3<double> at = place.pose->placed(place.origin);
  return {at[0], at[1], at[2]};
}

template <class B>
void Simulation<B>::Impl::hold_now(int obstacle, bool closed) {
  if (!contact_with(obstacle).grasp_options(obstacle))
    throw InputError(
        text("obstacle ", obstacle_name(problem.contact, static_cast<std::size_t>(obstacle)),
             " cannot hold anything; expected contact.obstacles.", obstacle, ".grasp"));
  hold(hierarchy(), obstacle, time, closed);
  reset_snapshots();
}
template <class B>
void Simulation<B>::grasp(int obstacle) {
  impl_->hold_now(obstacle, true);
}
template <class B>
void Simulation<B>::release(int obstacle) {
  impl_->hold_now(obstacle, false);
}
template <class B>
std::vector<HeldBy> Simulation<B>::held() const {
  std::vector<HeldBy> all;
  const auto& obstacles = impl_->problem.contact.obstacles;
  for (std::size_t o = 0; o < obstacles.size(); ++o)
    if (const int number = static_cast<int>(o); obstacles[o].grasp)
      all.push_back({obstacle_name(impl_->problem.contact, o),
                     impl_->contact_with(number).held_by(impl_->hierarchy().exec(), number)});
  return all;
}

template <class B>
int Simulation<B>::torn_attachments() const {
  const Contact<B>* contact = impl_->hierarchy()[0].contact();
  return contact ? contact->torn(impl_->hierarchy().exec()) : 0;
}

template <class B>
std::vector<Wrench> Simulation<B>::wrenches() const {
  return impl_->to_host(impl_->wrench);
}

template <class B>
std::vector<Wrench> Simulation<B>::wrenches_of_last_step() const {
  return impl_->to_host(impl_->shorter ? impl_->wrench_shorter : impl_->wrench);
}

template <class B>
std::vector<Wrench> Simulation<B>::Impl::to_host(const Doubles<B>& numbers) const {
  const std::vector<double> w = host_values(built.hierarchy->exec(), numbers);
  const std::vector<std::string> names = wrench_names(problem);
  std::vector<Wrench> all;
  for (std::size_t o = 0; 6 * o < w.size(); ++o)
    all.push_back({names[o],
                   {w[6 * o], w[6 * o + 1], w[6 * o + 2]},
                   {w[6 * o + 3], w[6 * o + 4], w[6 * o + 5]}});
  return all;
}

template <class B>
std::vector<double> Simulation<B>::contact_depths() const {
  const LedCall led(*impl_, Call::contact_depths);
  const Level<B>& finest = impl_->hierarchy()[0];
  if (!finest.contact()) return {};
  std::vector<double> all =
      finest.response().depths(impl_->hierarchy().exec(), finest, impl_->time);
  all.resize(static_cast<std::size_t>(finest.contact()->obstacles()));
  return all;
}

template <class B>
double Simulation<B>::pair_depth() const {
  const Level<B>& finest = impl_->hierarchy()[0];
  if (!finest.contact() || !finest.contact()->has_pairs()) return 0;
  return finest.response().depths(impl_->hierarchy().exec(), finest, impl_->time).back();
}

template <class B>
std::vector<double> Simulation<B>::contact_pressure() const {
  const Level<B>& finest = impl_->hierarchy()[0];
  if (!finest.contact()) return {};
  const LedCall led(*impl_, Call::contact_pressure);
  std::vector<double> pressure = finest.response().normal_forces(impl_->hierarchy().exec());
  if (impl_->ranks) {
    std::vector<double> own;
    for (const int p : impl_->built.owned_points)
      own.push_back(pressure[static_cast<std::size_t>(p)]);
    if (!impl_->is_led()) impl_->expect_one_process("contact_pressure");
    pressure = impl_->given(own, 1, impl_->joined_points);
  }
  const std::vector<Point> points = surface_positions();
  if (points.empty()) return {};
  const std::vector<double> area =
      areas_of_points({points, impl_->problem.body.surface->triangles});
  for (std::size_t p = 0; p < pressure.size(); ++p)
    pressure[p] = area[p] > 0 ? pressure[p] / area[p] : 0;
  return pressure;
}

template <class B>
double Simulation<B>::friction_work() const {
  double sum = 0;
  for (const Level<B>& level : impl_->hierarchy().levels)
    if (level.contact()) sum += level.response().friction_work(impl_->hierarchy().exec());
  return sum;
}

template <class B>
std::vector<double> Simulation<B>::slipping() const {
  const LedCall led(*impl_, Call::slipping);
  const Level<B>& finest = impl_->hierarchy()[0];
  if (!finest.contact()) return {};
  return finest.response().slipping(impl_->hierarchy().exec());
}

#define PLICA_INSTANTIATE(Real, Exec) template class Simulation<Backend<Real, Exec>>;
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
