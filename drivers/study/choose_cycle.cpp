// SPDX-License-Identifier: BSD-3-Clause
#include <Kokkos_Profiling_ScopedRegion.hpp>
#include <algorithm>
#include <cmath>
#include <plica/core/error.hpp>
#include <plica/core/text.hpp>
#include <plica/drivers/solver/diagnose.hpp>
#include <plica/drivers/solver/integrators/list.hpp>
#include <plica/drivers/solver/registry.hpp>
#include <plica/drivers/solver/set_up/validate.hpp>
#include <plica/drivers/solver/simulation.hpp>
#include <plica/drivers/solver/steppers.hpp>
#include <plica/drivers/study/choose_cycle.hpp>

namespace plica {

namespace {

constexpr int trial_steps = 128;                    // critical steps
constexpr int trial_quarters = 4;                   // at whose ends states are compared
constexpr int trial_factors[] = {32, 16, 8, 4, 2};  // macro step over critical step
constexpr int usual_factor = 8;                     // where nothing moves
constexpr double no_motion = 1e-12;                 // of the body's size

// A step of him at the shortest macro step costs less than level 0 alone over the same time
static_assert(him_step_cost / 2 < 1 / 0.9);

using Quarters = std::vector<std::vector<Point>>;  // [quarter][vertex], displacements [m]

struct TrialRun {
  Quarters u;
  std::string reason;  // why there is none
};

template <class B>
TrialRun run_trial(Problem problem, const IntegrationOptions& integration, int steps, const typename B::Exec& exec) {
  const Kokkos::Profiling::ScopedRegion region("plica: cycle auto: a trial of " + integration.cycle);
  TrialRun run;
  problem.integration = integration;
  try {
    Simulation<B> simulation(problem, exec);
    for (int n = 1; n <= steps; ++n) {
      if (const auto diagnosis = simulation.step_checked()) return {{}, "diverges: " + diagnosis->text()};
      if (n % (steps / trial_quarters) == 0) run.u.push_back(to_host<B>(exec, simulation.displacement()));
    }
    const auto counters = simulation.counters();
    if (const auto refits = counters.find("inertia_refits"); refits != counters.end() && refits->second > 0)
      run.reason = "loses its stability: its inertia had to be fitted anew";
  } catch (const InputError& error) {
    run.reason = std::string("refused: ") + error.what();
  }
  return run;
}

double relative_difference(const Quarters& u, const Quarters& from) {
  double difference = 0, size = 0;
  for (std::size_t j = 0; j < from.size(); ++j)
    for (std::size_t a = 0; a < from[j].size(); ++a) {
      difference += (u[j][a] - from[j][a]).squaredNorm();
      size += from[j][a].squaredNorm();
    }
  return std::sqrt(difference / size);
}

bool anything_moves(const Quarters& u, const TetMesh& mesh) {
  const Box box = bounding_box(mesh.vertices);
  const double least = no_motion * (box.max - box.min).norm();
  return std::ranges::any_of(u, [&](const auto& field) {
    return std::ranges::any_of(field, [&](const Point& p) { return p.norm() > least; });
  });
}

IntegrationOptions alone(IntegrationOptions o, const char* integrator, std::optional<double> step) {
  o.cycle = "single", o.integrator = {integrator}, o.macro_step = step;
  return o;
}

std::string as_percent(double part) { return number(100 * part, 2) + " %"; }

template <class B>
class CycleTrials {
  using Exec = typename B::Exec;

 public:
  CycleTrials(const Problem& problem, const Exec& exec) : problem_(problem), exec_(exec) {
    choice_.error_class = problem.integration.error_class;
    ErrorClasses::visit(choice_.error_class, [&](auto chosen) { choice_.allowed = decltype(chosen)::error; });
    const Kokkos::Profiling::ScopedRegion region("plica: cycle auto: level 0 alone");
    Problem finest = problem;
    finest.integration = alone(problem.integration, SymplecticEuler::name, {});
    finest.body.levels.resize(1);
    const Simulation<B> simulation(finest, exec);
    critical_ = simulation.levels().front().critical_step;
    take("single", simulation.macro_step(), "there is no coarser level");
  }

  CycleChoice all() {
    if (!has_coarse_levels(problem_.integration.cycle, problem_.body)) return std::move(choice_);
    choice_.duration = trial_steps * critical_;
    const TrialRun reference = run_reference();
    if (!reference.reason.empty()) {
      choice_.reason = "level 0 alone, which is what errors are measured against, " + reference.reason;
    } else if (!anything_moves(reference.u, problem_.body.levels.front())) {
      try_unmoved();
    } else {
      for (const int factor : trial_factors)
        if (try_moved(factor, reference.u)) return std::move(choice_);
      look_at_alone(reference.u);
    }
    return std::move(choice_);
  }

 private:
  void take(const std::string& cycle, double macro_step, const std::string& reason) {
    choice_.cycle = cycle, choice_.reason = reason;
    choice_.macro_step = macro_step, choice_.over_critical = macro_step / critical_;
  }

  // Level 0 in steps of at most this length that hit the quarters; their length
  std::pair<TrialRun, double> run_alone(const char* integrator, double longest) const {
    const double quarter = choice_.duration / trial_quarters;
    const int steps = static_cast<int>(std::ceil(quarter / longest));
    Problem finest = problem_;
    finest.body.levels.resize(1);
    const double step = quarter / steps;
    return {run_trial<B>(finest, alone(problem_.integration, integrator, step), trial_quarters * steps, exec_), step};
  }

  TrialRun run_reference() const {
    constexpr double half = 0.5;  // of its limit
    return run_alone(Rk4::name, half * critical_ * Rk4::limit.radius / SymplecticEuler::limit.radius).first;
  }

  // Taken whatever its error, which is told
  void look_at_alone(const Quarters& reference) {
    choice_.reason = "no longer step is within " + as_percent(choice_.allowed);
    const auto [run, step] = run_alone(SymplecticEuler::name, choice_.macro_step);
    CycleTrial& trial = choice_.trials.emplace_back(CycleTrial{"single", step, step / critical_, {}, run.reason});
    if (run.reason.empty()) trial.error = relative_difference(run.u, reference);
  }

  TrialRun run_him(int factor) {
    IntegrationOptions o = problem_.integration;
    o.cycle = "him", o.macro_step = factor * critical_;
    const TrialRun run = run_trial<B>(problem_, o, trial_steps / factor, exec_);
    choice_.trials.push_back({"him", *o.macro_step, static_cast<double>(factor), {}, run.reason});
    return run;
  }

  void try_unmoved() {
    if (run_him(usual_factor).reason.empty()) {
      choice_.trials.back().reason = "nothing moves in the trial";
      take("him", choice_.trials.back().macro_step, "nothing moves in the trial, so the usual step is taken");
    } else {
      choice_.reason = "nothing moves in the trial, and the usual step of him cannot be used";
    }
  }

  bool try_moved(int factor, const Quarters& reference) {
    const TrialRun run = run_him(factor);
    CycleTrial& trial = choice_.trials.back();
    if (!run.reason.empty()) return false;
    trial.error = relative_difference(run.u, reference);
    if (!std::isfinite(*trial.error)) trial.error.reset(), trial.reason = "diverges: a displacement is not finite";
    if (!trial.error || *trial.error > choice_.allowed) return false;
    take("him", trial.macro_step, "the longest step within " + as_percent(choice_.allowed));
    return true;
  }

  const Problem& problem_;
  const Exec& exec_;
  double critical_ = 0;
  CycleChoice choice_;
};

}  // namespace

template <class B>
std::optional<CycleChoice> choose_cycle(const Problem& problem, const typename B::Exec& exec) {
  if (problem.integration.cycle != "auto") return {};
  validate(problem);
  return CycleTrials<B>(problem, exec).all();
}

Problem with_choice(Problem problem, const std::optional<CycleChoice>& choice) {
  if (choice) problem.integration.cycle = choice->cycle, problem.integration.macro_step = choice->macro_step;
  return problem;
}

#define PLICA_INSTANTIATE(Real, Exec) \
  template std::optional<CycleChoice> choose_cycle<Backend<Real, Exec>>(const Problem&, const Exec&);
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
