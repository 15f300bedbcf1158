// SPDX-License-Identifier: BSD-3-Clause
#include <Kokkos_Profiling_ScopedRegion.hpp>
#include <algorithm>
#include <cmath>
#include <plica/core/error.hpp>
#include <plica/core/text.hpp>
#include <plica/drivers/solver/diagnose.hpp>
#include <plica/drivers/solver/energy_meter.hpp>
#include <plica/drivers/solver/him/advice.hpp>
#include <plica/drivers/solver/integrators/list.hpp>
#include <plica/drivers/solver/registry.hpp>
#include <plica/drivers/solver/set_up/validate.hpp>
#include <plica/drivers/solver/simulation.hpp>
#include <plica/drivers/solver/steppers.hpp>
#include <plica/drivers/study/choose_cycle.hpp>
#include <plica/meshes/embedding.hpp>

namespace plica {

namespace {

constexpr int trial_steps = 128;                    // critical steps
constexpr int trial_quarters = 4;                   // at whose ends states are compared
constexpr int trial_factors[] = {32, 16, 8, 4, 2};  // macro step over critical step
constexpr int usual_factor = 8;                     // where nothing moves
constexpr double no_motion = 1e-12;                 // of the body's size
constexpr double before_touching = 0.125;           // of a trial: where it starts
constexpr double most_looking = 400;                // forces of level 0 that the look ahead may cost

// A step of him at the shortest macro step costs less than level 0 alone over the same time
static_assert(him_step_cost / 2 < 1 / 0.9);

using Quarters = std::vector<std::vector<Point>>;  // [quarter][vertex], displacements [m]

// Where trials start: from the scene's own start, or from a state of level 0
struct TrialStart {
  double time = 0;  // [s]
  std::vector<Point> u, v;
};

struct TrialRun {
  Quarters u;
  std::string reason;  // why there is none
};

template <class B>
TrialRun run_trial(Problem problem, const IntegrationOptions& integration, int steps, const TrialStart& start,
                   const typename B::Exec& exec) {
  const Kokkos::Profiling::ScopedRegion region("plica: cycle auto: a trial of " + integration.cycle);
  TrialRun run;
  problem.integration = integration;
  try {
    Simulation<B> simulation(problem, exec);
    if (start.time > 0) simulation.set_state(start.u, start.v), simulation.set_time(start.time);
    EnergyBudget energy(simulation, problem);
    ObstacleWork<B> work(simulation, problem);
    const auto look = [&] {
      if (EnergyBudget::knows(problem) && work.known())
        energy.look(simulation.time(), simulation.energies(), work.done());
    };
    look();
    for (int n = 1; n <= steps; ++n) {
      if (const auto diagnosis = simulation.step_checked()) return {{}, "diverges: " + diagnosis->text()};
      work.step(simulation);
      if (n % (steps / trial_quarters) != 0) continue;
      look();
      std::vector<Point>& u = run.u.emplace_back(to_host<B>(exec, simulation.displacement()));
      for (std::size_t a = 0; a < start.u.size(); ++a) u[a] -= start.u[a];
    }
    const auto counters = simulation.counters();
    if (const auto refits = counters.find("inertia_refits"); refits != counters.end() && refits->second > 0)
      run.reason = "loses its stability: its inertia had to be fitted anew";
    if (energy.growth() > EnergyBudget::notable) run.reason = "makes energy of nothing: " + energy.warning();
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

/// One of its levels alone.
Problem only(Problem problem, std::size_t level) {
  Body& body = problem.body;
  body.levels = {body.levels[level]};
  if (body.element.size() > 1) body.element = {body.element[level]};
  return problem;
}

template <class B>
bool touches(const Simulation<B>& simulation) {
  return std::ranges::any_of(simulation.wrenches(), [](const Wrench& w) { return w.force.norm() > 0; });
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
    Problem finest = only(problem, 0);
    finest.integration = alone(problem.integration, SymplecticEuler::name, {});
    const Simulation<B> simulation(finest, exec);
    critical_ = simulation.levels().front().critical_step, edge_ = simulation.levels().front().mean_edge;
    take("single", simulation.macro_step(), "there is no coarser level");
  }

  CycleChoice all() {
    if (!has_coarse_levels(problem_.integration.cycle, problem_.body)) return std::move(choice_);
    choice_.duration = trial_steps * critical_;
    if (has_contact(problem_)) look_ahead();
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

  // Contact decides which step will do, so trials begin shortly before it. The coarsest level alone, in explicit steps, says when
  // something first touches; its state there is level 0's. Where it sees nothing, or fails, trials begin at the start
  void look_ahead() {
    const Kokkos::Profiling::ScopedRegion region("plica: cycle auto: the coarsest level looks ahead");
    const std::size_t last = problem_.body.levels.size() - 1;
    Problem coarsest = only(problem_, last);
    coarsest.integration = alone(problem_.integration, SymplecticEuler::name, {});
    const TetMesh &fine = problem_.body.levels.front(), &coarse = problem_.body.levels[last];
    const double least = before_touching * choice_.duration;
    const auto most = static_cast<long>(most_looking * static_cast<double>(fine.tets.size()) /
                                        static_cast<double>(coarse.tets.size()));
    try {
      Simulation<B> simulation(coarsest, exec_);
      TrialStart before, now;
      for (long n = 0; n < most; ++n) {
        if (simulation.step_checked()) return;
        if (touches(simulation)) {
          if (before.time > 0) start_ = {before.time, on_level_0(before.u), on_level_0(before.v)};
          choice_.start = start_.time;
          return;
        }
        if (simulation.time() < now.time + least) continue;
        before = std::move(now);
        now = {simulation.time(), to_host<B>(exec_, simulation.displacement()),
               to_host<B>(exec_, simulation.velocity())};
      }
    } catch (const InputError&) {  // of the coarsest mesh alone: what is wrong there is told by whoever uses it
    }
  }

  std::vector<Point> on_level_0(const std::vector<Point>& field) const {
    const Embedding rows = embed(problem_.body.levels.front().vertices, problem_.body.levels.back(), Outside::clamp);
    std::vector<Point> values(rows.vertices.size(), Point::Zero());
    for (std::size_t a = 0; a < values.size(); ++a)
      for (std::size_t c = 0; c < 4; ++c)
        values[a] += rows.weights[a][c] * field[static_cast<std::size_t>(rows.vertices[a][c])];
    return values;
  }

  // Level 0 in steps of at most this length that hit the quarters; their length
  std::pair<TrialRun, double> run_alone(const char* integrator, double longest) const {
    const double quarter = choice_.duration / trial_quarters;
    const int steps = static_cast<int>(std::ceil(quarter / longest));
    const double step = quarter / steps;
    return {run_trial<B>(only(problem_, 0), alone(problem_.integration, integrator, step), trial_quarters * steps,
                         start_, exec_),
            step};
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
    TrialRun run;
    run.reason = too_fast_for_him(problem_, *o.macro_step, edge_);
    if (run.reason.empty()) run = run_trial<B>(problem_, o, trial_steps / factor, start_, exec_);
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
  double critical_ = 0, edge_ = 0;
  TrialStart start_;
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
