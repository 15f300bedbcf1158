// SPDX-License-Identifier: BSD-3-Clause
#include <plica/core/error.hpp>
#include <plica/drivers/solver/simulation_check.hpp>

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
  MacroStepCheck<B, Inside> checks(s);
  const bool retries = s.problem.integration.retry.halvings > 0;
  auto bad = checks.examine();
  if (bad && retries) bad = checks.retry(*bad);
  if (bad) return bad;
  if (retries || s.steps - s.kept_steps >= keep_every) s.keep();
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
