// SPDX-License-Identifier: BSD-3-Clause
#include <Kokkos_Profiling_ScopedRegion.hpp>
#include <algorithm>
#include <cmath>
#include <plica/core/error.hpp>
#include <plica/drivers/run/diagnose.hpp>
#include <plica/drivers/run/energy_meter.hpp>
#include <plica/drivers/study/cycle_trial.hpp>

namespace plica {

namespace {

constexpr double no_motion = 1e-12;  // motion that is rounding, over the body's size

double median_of(std::vector<double> times) {
  if (times.empty()) return 0;
  const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
  std::ranges::nth_element(times, middle);
  return *middle;
}

/// Energy gain of a trial, where the work of all forces is known.
template <class B>
class GainInTrial {
 public:
  GainInTrial(const Simulation<B>& simulation, const Problem& problem)
      : simulation_(simulation),
        energy_(simulation, problem),
        work_(simulation, problem),
        knows_(EnergyBudget::knows(problem)) {
    look();
  }
  void step() { work_.step(simulation_); }
  void look() {
    if (knows_ && work_.known())
      energy_.look(simulation_.time(), simulation_.energies(), work_.done());
  }
  std::string warning() const { return energy_.warning(); }

 private:
  const Simulation<B>& simulation_;
  EnergyBudget energy_;
  ObstacleWork<B> work_;
  bool knows_;
};

}  // namespace

template <class B>
bool is_pushed(const Simulation<B>& simulation) {
  return std::ranges::any_of(simulation.wrenches(),
                             [](const Wrench& w) { return w.force.norm() > 0; });
}

template <class B>
TrialRun run_trial(Problem problem, const IntegrationOptions& integration, int steps,
                   const TrialStart& start, const TrialClock& clock, const typename B::Exec& exec) {
  const Kokkos::Profiling::ScopedRegion region("plica: cycle auto: a trial of " +
                                               integration.cycle);
  TrialRun run;
  problem.integration = integration;
  std::vector<double> times;
  try {
    const double begun = clock.now();
    Simulation<B> simulation(problem, exec);
    run.set_up_time = clock.now() - begun;
    simulation.share_cores();  // since the predicted run does so
    if (start.time > 0) simulation.set_state(start.u, start.v), simulation.set_time(start.time);
    GainInTrial<B> gain(simulation, problem);
    for (int n = 1; n <= steps; ++n) {
      const double before = clock.now();
      const auto diagnosis = simulation.step_checked();
      const double after = clock.now();
      times.push_back(after - before), run.step_time = median_of(times);
      if (diagnosis) return run.u.clear(), run.reason = "diverges: " + diagnosis->text(), run;
      if (after > clock.deadline && n < steps)
        return run.u.clear(), run.reason = "given up: trials had taken long enough", run;
      if (cuts_of(simulation.counters()) > 0)
        return run.u.clear(), run.reason = "loses its stability: steps had to be cut", run;
      gain.step();
      run.touched = run.touched || is_pushed(simulation);
      if (n % (steps / trial_quarters) != 0) continue;
      gain.look();
      run.touched = run.touched || simulation.pair_depth() > 0;
      std::vector<Point>& u = run.u.emplace_back(to_host<B>(exec, simulation.displacement()));
      for (std::size_t a = 0; a < start.u.size(); ++a) u[a] -= start.u[a];
    }
    if (const std::string warning = gain.warning(); !warning.empty())
      run.reason = "makes energy of nothing: " + warning;
  } catch (const InputError& error) {
    run.reason = std::string("refused: ") + error.what();
  }
  return run;
}

double trial_error(const TrialRun& run, const TrialRun& from, const std::vector<Point>& rigid) {
  double difference = 0, size = 0;
  for (std::size_t j = 0; j < from.u.size(); ++j)
    for (std::size_t a = 0; a < from.u[j].size(); ++a) {
      difference += (run.u[j][a] - from.u[j][a]).squaredNorm();
      size += (from.u[j][a] - rigid[j]).squaredNorm();
    }
  return std::sqrt(difference / size);
}

bool anything_moves(const TrialRun& run, const std::vector<Point>& rigid, const TetMesh& mesh) {
  const Box box = bounding_box(mesh.vertices);
  for (std::size_t j = 0; j < run.u.size(); ++j) {
    const double least = no_motion * (box.max - box.min).norm() + 1e-9 * rigid[j].norm();
    if (std::ranges::any_of(run.u[j],
                            [&](const Point& p) { return (p - rigid[j]).norm() > least; }))
      return true;
  }
  return false;
}

#define PLICA_INSTANTIATE(Real, Exec)                              \
  template bool is_pushed(const Simulation<Backend<Real, Exec>>&); \
  template TrialRun run_trial<Backend<Real, Exec>>(                \
      Problem, const IntegrationOptions&, int, const TrialStart&, const TrialClock&, const Exec&);
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
