// SPDX-License-Identifier: BSD-3-Clause
// What a simulation tells of itself.
#include <plica/drivers/solver/diagnose.hpp>
#include <plica/drivers/solver/exchange.hpp>
#include <plica/drivers/solver/simulation_inside.hpp>

namespace plica {

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
std::optional<HimReport> Simulation<B>::him() const {
  return inside_->built.him;
}
template <class B>
std::optional<CycleChoice> Simulation<B>::choice() const {
  return inside_->choice;
}
template <class B>
std::vector<Part> Simulation<B>::parts() const {
  return list_parts<B>(inside_->problem, inside_->built);
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
  std::map<std::string, long> all = inside_->built.cycle->counters();
  for (const auto& part : inside_->hierarchy().levels) {
    all["force_evaluations"] += part.forces->evaluations();
    long passes = part.forces->evaluations();  // over the elements
    for (const auto& [name, count] : part.integrator->counters()) {
      all[name] += count;
      if (name == "cg_iterations") passes += count;
    }
    all["tet_evaluations"] += passes * part.level.model.tets;
  }
  if (inside_->problem.integration.retry.halvings > 0)
    all["halvings"] = inside_->halvings, all["rejected_steps"] = inside_->rejected;
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
  return inside_->level(level).state.u;
}
template <class B>
Vectors<B> Simulation<B>::velocity(int level) const {
  return inside_->level(level).state.v;
}

template <class B>
void Simulation<B>::read_positions(const DeviceOutput<B>& to, int level) const {
  plica::read_positions<B>(inside_->hierarchy().exec(), inside_->rest_positions(level), displacement(level), to);
}
template <class B>
void Simulation<B>::read_velocities(const DeviceOutput<B>& to, int level) const {
  read_vectors<B>(inside_->hierarchy().exec(), velocity(level), to);
}
template <class B>
void Simulation<B>::read_surface_positions(const DeviceOutput<B>& to) const {
  const Level<B>& finest = inside_->level(0);
  read_surface<B>(inside_->hierarchy().exec(), finest.surface, finest.state, false, to);
}
template <class B>
void Simulation<B>::read_surface_velocities(const DeviceOutput<B>& to) const {
  const Level<B>& finest = inside_->level(0);
  read_surface<B>(inside_->hierarchy().exec(), finest.surface, finest.state, true, to);
}

template <class B>
void Simulation<B>::write_state(const DeviceInput<B>& positions, const DeviceInput<B>& velocities) {
  const State<B>& state = inside_->level(0).state;
  if (velocities.size() != positions.size())  // before anything is written
    throw InputError(std::to_string(positions.size()) + " positions and " + std::to_string(velocities.size()) +
                     " velocities");
  write_positions<B>(inside_->hierarchy().exec(), positions, inside_->rest_positions(0), state.u);
  write_vectors<B>(inside_->hierarchy().exec(), velocities, state.v);
  inside_->restart();
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
template <class B>
std::vector<Point> Simulation<B>::surface_positions() const {
  const Vectors<B> x("plica::surface.x", inside_->level(0).surface.points);
  read_surface_positions(x);
  return to_host<B>(inside_->hierarchy().exec(), x);
}
template <class B>
std::vector<Point> Simulation<B>::surface_velocities() const {
  const Vectors<B> v("plica::surface.v", inside_->level(0).surface.points);
  read_surface_velocities(v);
  return to_host<B>(inside_->hierarchy().exec(), v);
}

#define PLICA_INSTANTIATE(Real, Exec) template class Simulation<Backend<Real, Exec>>;
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
