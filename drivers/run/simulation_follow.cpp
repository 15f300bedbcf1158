// SPDX-License-Identifier: BSD-3-Clause
// A refined part of the body that follows an obstacle.
//
// Between two macro steps the elements round the obstacle are looked at. Where one of them, well
// within the radius, is not refined, other elements are chosen: those within the radius. A
// simulation is built of the body with the part there, and goes on from the state of the one before
// (simulation_cut.cpp). What both meshes have keeps its place and velocity. A vertex that is new is
// in the middle of an edge, and so moves as the edge did: elements that are cut in eight are
// strained as before. What becomes coarser loses what its middles had. One rigid motion of the
// vertices whose mass has changed keeps momentum, linear and angular.
//
// A saved state has the numbers of the elements that are refined, and no mesh: restore() refines
// them again.
#include <Kokkos_Timer.hpp>
#include <algorithm>
#include <cmath>
#include <map>
#include <plica/core/row_ranges.hpp>
#include <plica/core/text.hpp>
#include <plica/core/to_device.hpp>
#include <plica/drivers/body/momenta.hpp>
#include <plica/drivers/contact/turning.hpp>
#include <plica/drivers/run/compose_levels.hpp>
#include <plica/drivers/run/simulation_impl.hpp>
#include <plica/kernels/contact/gap.hpp>
#include <utility>

namespace plica {

namespace {

constexpr double always_refined = 0.75;  // part of the radius

template <class View, class Exec>
std::vector<double> doubles_of(const Exec& exec, const View& field) {
  const auto values = host_values(exec, field);
  return {values.begin(), values.end()};
}

std::vector<Point> sums(std::vector<Point> a, const std::vector<Point>& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] += b[i];
  return a;
}

/// Returns the vertices that take up momentum: those that move freely and have another mass than
/// before, or are new.
/// @param mass_before  masses by the ends of vertices [kg]
template <class B>
std::vector<int> vertices_of_new_mass(const LevelData<B>& level, const std::vector<Ends>& ends,
                                      const std::vector<double>& mass,
                                      const std::map<Ends, double>& mass_before) {
  constexpr double same = 1e-4;  // relative, above the rounding of floats
  const auto inverse = on_host(level.model.inverse_mass);
  const auto slides = on_host(level.sliding.place);
  std::vector<int> chosen;
  for (std::size_t v = 0; v < ends.size(); ++v) {
    if (!(inverse(v) > 0) || (level.sliding.count > 0 && slides(v) >= 0)) continue;
    const auto before = mass_before.find(ends[v]);
    if (before == mass_before.end() || std::abs(before->second - mass[v]) > same * mass[v])
      chosen.push_back(static_cast<int>(v));
  }
  return chosen;
}

/// Stops vertices that are fixed: one may be new, in the middle between one that is and one that
/// was free.
template <class B>
void stop_fixed_vertices(const LevelData<B>& level, std::vector<Point>& v) {
  const auto inverse = on_host(level.model.inverse_mass);
  std::vector<char> moved(v.size(), 0);  // by a given motion
  const auto given = on_host(level.prescribed.vertex);
  for (int i = 0; i < level.prescribed.count; ++i) moved[index_of(given(i))] = 1;
  for (std::size_t a = 0; a < v.size(); ++a)
    if (!(inverse(a) > 0) && moved[a] == 0) v[a].setZero();
}

}  // namespace

template <class B>
FollowReport Simulation<B>::followed() const {
  return impl_->part_moves;
}

/// Returns where the point is now that the part is round [m].
template <class B>
Point Simulation<B>::followed_place() const {
  const ContactOptions& contact = impl_->problem.contact;
  const FollowOptions& follows = impl_->problem.body.following->follows;
  const std::size_t number = followed_obstacle(follows, contact);
  const ObstacleOptions& obstacle = contact.obstacles[number];
  const Point at = follows.at.value_or(origin_of(obstacle));
  for (const ToolState& tool : tools()) {  // obstacles with mass
    if (tool.obstacle != follows.obstacle) continue;
    const Point centre = obstacle.centre_of_mass.value_or(origin_of(obstacle));
    const Vec3<double> arm = rotation_by(tool.rotation) * vec3<double>(Point(at - centre));
    return centre + tool.displacement + Point(arm[0], arm[1], arm[2]);
  }
  const int o = static_cast<int>(number);
  const Vec3<double> place =
      impl_->contact_with(o).place(o, impl_->time).pose->placed(vec3<double>(at));
  return {place[0], place[1], place[2]};
}

/// Returns after how many macro steps the elements round the obstacle are looked at again: in the
/// time of that, sound comes no further than the part is wider than it must be.
template <class B>
long Simulation<B>::Impl::steps_between_looks() const {
  const LevelReport& finest = built.reports.front();
  const double margin = (1 - always_refined) * problem.body.following->follows.radius;
  const double passing =  // number of macro steps; 0: implicit ones are long
      margin / finest.mean_edge * finest.critical_step / built.macro_step;
  return std::max(1L, static_cast<long>(std::min(passing, 1e3)));
}

template <class B>
void Simulation<B>::follow_ahead() {
  Impl& s = *impl_;
  if (s.steps <= s.looked_at || s.steps % s.steps_between_looks() != 0) return;
  s.looked_at = s.steps;
  const FollowingPart& part = *s.problem.body.following;
  const std::vector<Point> x =
      values_at_vertices(s.ends, positions(), part.coarser.vertices.size());
  const Point centre = followed_place();
  const auto within = [&](double radius) {
    return tets_within(part.coarser.tets, x, centre, radius);
  };
  if (std::ranges::includes(part.refined, within(always_refined * part.follows.radius))) return;
  const Kokkos::Timer timer;
  std::unique_ptr<Impl> next = s.with_part(within(part.follows.radius));
  next->go_on_from(s);
  impl_ = std::move(next);
  ++impl_->part_moves.moves, impl_->part_moves.seconds += timer.seconds();
}

/// Returns a simulation with other elements refined, at its start.
template <class B>
auto Simulation<B>::Impl::with_part(std::vector<int> refined) -> std::unique_ptr<Impl> {
  Problem next = present_problem();
  FollowingPart& part = *next.body.following;
  part.refined = std::move(refined);
  try {
    next.body.levels.front() = partly_refined(part.coarser, part.refined).mesh;
    return std::make_unique<Impl>(next, hierarchy().exec(), Validation::done);
  } catch (const InputError& error) {
    throw InputError("body.levels.0.refine.follows: of the body with the part elsewhere, at " +
                     number(time, 6) + " s, " + error.what());
  }
}

/// Returns a simulation with the elements refined that a saved one had; none: this one has the
/// same.
template <class B>
auto Simulation<B>::Impl::with_saved_part(const std::optional<std::vector<int>>& saved)
    -> std::unique_ptr<Impl> {
  const auto& part = problem.body.following;
  if (saved.has_value() != part.has_value())
    throw InputError(text("the saved state has ", saved ? "a" : "no",
                          " part that follows an obstacle, this simulation has ",
                          part ? "one" : "none", "; expected a simulation of the same problem"));
  if (!saved || *saved == part->refined) return nullptr;
  const auto tets = static_cast<int>(part->coarser.tets.size());
  for (std::size_t i = 0; i < saved->size(); ++i)
    if ((*saved)[i] < 0 || (*saved)[i] >= tets || (i > 0 && (*saved)[i] <= (*saved)[i - 1]))
      throw InputError(
          "the saved state is damaged: it has refined elements that the mesh does not have");
  return with_part(*saved);
}

/// Carries the state of level 0 over from a simulation with other elements refined.
template <class B>
void Simulation<B>::Impl::carry_over_part(Impl& before) {
  const Exec& exec = hierarchy().exec();
  const Level<B>&was = before.hierarchy()[0], &is = hierarchy()[0];
  const TetMesh &old_mesh = before.built.meshes.front(), &mesh = built.meshes.front();
  const std::size_t whole = problem.body.following->coarser.vertices.size();
  const std::vector<Point> old_u = plica::to_host<B>(exec, was.state.u),
                           old_v = plica::to_host<B>(exec, was.state.v);
  std::vector<Point> u = carried_values(before.ends, old_u, ends, whole),
                     v = carried_values(before.ends, old_v, ends, whole);
  follow_masters(mesh.followers, u);
  stop_fixed_vertices<B>(is, v);
  const std::vector<double> old_mass = doubles_of(exec, was.model.mass),
                            mass = doubles_of(exec, is.model.mass);
  std::map<Ends, double> mass_before;
  for (std::size_t a = 0; a < old_mass.size(); ++a) mass_before[before.ends[a]] += old_mass[a];
  restore_momenta(momenta_of(old_mass, sums(old_u, old_mesh.vertices), old_v), mass,
                  sums(u, mesh.vertices), vertices_of_new_mass<B>(is, ends, mass, mass_before), v);
  copy(exec, is.state.u, to_device<Vectors<B>>("carried", rows<typename B::Real>(u)));
  copy(exec, is.state.v, to_device<Vectors<B>>("carried", rows<typename B::Real>(v)));
}

#define PLICA_INSTANTIATE(Real, Exec) template class Simulation<Backend<Real, Exec>>;
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
