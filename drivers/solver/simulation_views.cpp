// SPDX-License-Identifier: BSD-3-Clause
// What a simulation tells of itself.
#include <plica/drivers/solver/diagnose.hpp>
#include <plica/drivers/solver/simulation_inside.hpp>
#include <plica/kernels/transfer/map_state.hpp>

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
  return inside_->level(level).state.u;
}
template <class B>
Vectors<B> Simulation<B>::velocity(int level) const {
  return inside_->level(level).state.v;
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

#define PLICA_INSTANTIATE(Real, Exec) template class Simulation<Backend<Real, Exec>>;
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
