// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <plica/core/error.hpp>
#include <plica/drivers/solver/diagnose.hpp>
#include <plica/drivers/solver/simulation_inside.hpp>

namespace plica {

namespace {

constexpr int keep_every = 20;  // macro steps

}  // namespace

template <class B>
Simulation<B>::Simulation(const Problem& problem, const Exec& exec)
    : inside_(std::make_unique<Inside>(problem, exec)) {}
template <class B>
Simulation<B>::~Simulation() = default;

template <class B>
void Simulation<B>::step() {
  inside_->step();
}

template <class B>
std::optional<Diagnosis> Simulation<B>::check() {
  Inside& s = *inside_;
  if (s.built.cycle->alarmed(s.hierarchy()) && !s.repair()) return locate_failure<B>("stability", s.built, s.kept);
  if (s.budget_opens) s.open_budget();
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
  inside_->go_back();
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
  s.restart();
}

template <class B>
void Simulation<B>::set_external_forces(const ExternalForces<B>& forces) {
  Inside& s = *inside_;
  for (int i = 0; i < s.hierarchy().count(); ++i) s.hierarchy()[i].forces->set_external(forces, s.rest_positions(i));
  if (forces) s.budget_known = false;
}

template <class B>
void Simulation<B>::time_stages(bool on) {
  inside_->hierarchy().clock.on = on;
}

#define PLICA_INSTANTIATE(Real, Exec) template class Simulation<Backend<Real, Exec>>;
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
