// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <plica/core/error.hpp>
#include <plica/drivers/solver/diagnose.hpp>
#include <plica/drivers/solver/energy_meter.hpp>
#include <plica/drivers/solver/parts.hpp>
#include <plica/drivers/solver/set_up/build_hierarchy.hpp>
#include <plica/drivers/solver/set_up/validate.hpp>
#include <plica/drivers/solver/simulation.hpp>
#include <plica/kernels/transfer/map_state.hpp>

namespace plica {

namespace {

constexpr int keep_every = 20;  // macro steps

const Problem& valid(const Problem& problem) {
  validate(problem);
  return problem;
}

}  // namespace

template <class B>
struct Simulation<B>::Inside {
  Inside(const Problem& p, const Exec& exec)
      : problem(p), built(build_hierarchy<B>(valid(p), exec)), meter(*built.hierarchy, p.gravity) {
    problem.body.levels.clear();  // the placed meshes in use are in `built`
    for (const auto& part : built.hierarchy->levels) kept.emplace_back("kept", part.level.model.vertices);
    budget_known =
        problem.body.prescribed.empty() && std::none_of(p.contact.obstacles.begin(), p.contact.obstacles.end(),
                                                        [](const ObstacleOptions& o) { return o.velocity.norm() > 0; });
    parts = list_parts<B>(p, built);
    keep();
    start_energy();
  }

  Problem problem;
  BuiltHierarchy<B> built;
  EnergyMeter<B> meter;
  std::vector<Part> parts;
  std::vector<State<B>> kept;
  double time = 0, kept_time = 0;
  long steps = 0, kept_steps = 0;
  bool budget_known;  // nothing from outside but gravity does work
  double residual = 0, worst_residual = 0;
  double start = 0, put_in = 0;  // energy at the start, the most that was ever there to be had [J]

  Hierarchy<B>& hierarchy() { return *built.hierarchy; }

  void keep() {
    for (std::size_t i = 0; i < kept.size(); ++i) kept[i].copy(hierarchy().exec(), hierarchy().levels[i].level.state);
    kept_time = time, kept_steps = steps;
  }
  void start_energy() {
    const Energies e = meter.all(time);
    start = put_in = e.total();
  }
};

template <class B>
Simulation<B>::Simulation(const Problem& problem, const Exec& exec)
    : inside_(std::make_unique<Inside>(problem, exec)) {}
template <class B>
Simulation<B>::~Simulation() = default;

template <class B>
void Simulation<B>::step() {
  Inside& s = *inside_;
  for (auto& part : s.hierarchy().levels) part.forces->begin_macro_step();
  s.built.cycle->step(s.hierarchy(), s.time, s.built.macro_step);
  s.time = static_cast<double>(++s.steps) * s.built.macro_step;
  s.residual = 0;
  for (const auto& part : s.hierarchy().levels) s.residual = std::max(s.residual, part.integrator->residual());
  s.worst_residual = std::max(s.worst_residual, s.residual);
}

template <class B>
std::optional<Diagnosis> Simulation<B>::check() {
  Inside& s = *inside_;
  const Energies e = s.meter.motion();
  if (auto inverted = find_inverted<B>(s.built)) return inverted;
  if (!std::isfinite(e.kinetic) || !std::isfinite(e.potential)) return locate_failure<B>("non_finite", s.built, s.kept);
  s.put_in = std::max(s.put_in, s.start - e.potential);
  // elastic and contact energy are not negative: kinetic energy beyond what was put in is made of nothing. Twice, since
  // discrete energies waver; never less than that of a thousandth of an edge per step
  const double edge_speed = 1e-3 * s.built.reports.front().mean_edge / s.built.macro_step;
  const double allowed = 2 * s.put_in + 0.5 * s.built.reports.front().mass * edge_speed * edge_speed;
  if (s.budget_known && e.kinetic > allowed) return locate_failure<B>("energy", s.built, s.kept);
  if (s.steps - s.kept_steps >= keep_every) s.keep();
  return {};
}

template <class B>
void Simulation<B>::return_to_last_good() {
  Inside& s = *inside_;
  for (std::size_t i = 0; i < s.kept.size(); ++i) {
    Level<B>& level = s.hierarchy().levels[i].level;
    level.state.copy(s.hierarchy().exec(), s.kept[i]);
    level.flags.clear(s.hierarchy().exec());
  }
  s.built.cycle->begin(s.hierarchy());
  s.time = s.kept_time, s.steps = s.kept_steps;
}

template <class B>
double Simulation<B>::time() const {
  return inside_->time;
}
template <class B>
double Simulation<B>::macro_step() const {
  return inside_->built.macro_step;
}
template <class B>
long Simulation<B>::macro_steps() const {
  return inside_->steps;
}
template <class B>
const std::vector<LevelReport>& Simulation<B>::levels() const {
  return inside_->built.reports;
}
template <class B>
std::vector<Part> Simulation<B>::parts() const {
  return inside_->parts;
}
template <class B>
Energies Simulation<B>::energies() const {
  return inside_->meter.all(inside_->time);
}

template <class B>
std::map<std::string, double> Simulation<B>::stages() const {
  return inside_->hierarchy().clock.seconds();
}

template <class B>
std::map<std::string, long> Simulation<B>::counters() const {
  std::map<std::string, long> all;
  for (const auto& part : inside_->hierarchy().levels) {
    all["force_evaluations"] += part.forces->evaluations();
    for (const auto& [name, count] : part.integrator->counters()) all[name] += count;
  }
  return all;
}

template <class B>
double Simulation<B>::residual() const {
  return inside_->residual;
}
template <class B>
double Simulation<B>::worst_residual() const {
  return inside_->worst_residual;
}

template <class B>
Vectors<B> Simulation<B>::displacement(int level) const {
  return inside_->hierarchy()[level].level.state.u;
}
template <class B>
Vectors<B> Simulation<B>::velocity(int level) const {
  return inside_->hierarchy()[level].level.state.v;
}

template <class B>
std::vector<Point> Simulation<B>::positions(int level) const {
  std::vector<Point> x = to_host<B>(inside_->hierarchy().exec(), displacement(level));
  const auto& rest = inside_->built.meshes[static_cast<std::size_t>(level)].vertices;
  for (std::size_t a = 0; a < x.size(); ++a) x[a] += rest[a];
  return x;
}

template <class B>
std::vector<Point> Simulation<B>::velocities(int level) const {
  return to_host<B>(inside_->hierarchy().exec(), velocity(level));
}

namespace {

/// Level 0's state at the surface's points.
template <class B>
State<B> on_surface(Hierarchy<B>& h) {
  const EmbeddedSurface<B>& surface = h[0].level.surface;
  const State<B> mapped("surface", surface.points);
  map_fields<B, MapState>(h.exec(), "plica::surface", surface.embedding, h[0].level.state, {}, {}, mapped, {});
  return mapped;
}

}  // namespace

template <class B>
std::vector<Point> Simulation<B>::surface_positions() const {
  Hierarchy<B>& h = inside_->hierarchy();
  std::vector<Point> x = to_host<B>(h.exec(), on_surface<B>(h).u);
  const auto rest = to_host<B>(h.exec(), h[0].level.surface.rest);
  for (std::size_t p = 0; p < x.size(); ++p) x[p] += rest[p];
  return x;
}

template <class B>
std::vector<Point> Simulation<B>::surface_velocities() const {
  Hierarchy<B>& h = inside_->hierarchy();
  return to_host<B>(h.exec(), on_surface<B>(h).v);
}

template <class B>
void Simulation<B>::set_state(const std::vector<Point>& displacement, const std::vector<Point>& velocity) {
  Inside& s = *inside_;
  const State<B>& state = s.hierarchy()[0].level.state;
  const auto copy = [&](const std::vector<Point>& from, const Vectors<B>& to, const char* what) {
    if (from.size() != to.extent(0))
      throw InputError(std::string("set_state: ") + std::to_string(from.size()) + " " + what + " for " +
                       std::to_string(to.extent(0)) + " vertices of level 0");
    const auto host = Kokkos::create_mirror_view(to);
    for (std::size_t a = 0; a < from.size(); ++a)
      for (int k = 0; k < 3; ++k) host(a, static_cast<std::size_t>(k)) = static_cast<typename B::Real>(from[a][k]);
    Kokkos::deep_copy(to, host);
  };
  s.hierarchy().exec().fence("plica::set_state");
  copy(displacement, state.u, "displacements");
  copy(velocity, state.v, "velocities");
  s.built.cycle->begin(s.hierarchy());
  s.keep();
  s.start_energy();
}

template <class B>
void Simulation<B>::time_stages(bool on) {
  inside_->hierarchy().clock.on = on;
}

#define PLICA_INSTANTIATE(Real, Exec) template class Simulation<Backend<Real, Exec>>;
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
