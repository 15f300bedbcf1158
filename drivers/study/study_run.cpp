// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <chrono>
#include <cmath>
#include <plica/core/error.hpp>
#include <plica/core/precision.hpp>
#include <plica/drivers/run/diagnose.hpp>
#include <plica/drivers/study/choose_cycle.hpp>
#include <plica/drivers/study/study_run.hpp>

namespace plica {

namespace {

using Clock = std::chrono::steady_clock;
using Exec = Kokkos::DefaultExecutionSpace;

constexpr double short_run = 0.2;  // wall time below which a run is short [s]
constexpr int runs_if_short = 5;

double since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

template <class E>
E instance(int threads) {
  const int most = E().concurrency();
  if (threads == 0 || threads == most) return {};
  if (threads < 0 || threads > most)
    throw InputError("study.threads: " + std::to_string(threads) + " threads; " + E::name() +
                     " has " + std::to_string(most));
#if defined(KOKKOS_ENABLE_OPENMP)
  if constexpr (std::is_same_v<E, Kokkos::OpenMP>) return E(threads);
#endif
  throw InputError("study.threads: " + std::string(E::name()) +
                   " runs with all it has; leave study.threads out");
}

// Returns whether only gravity does work on the body
bool keeps_energy(const Problem& p) {
  return p.body.loads.empty() && p.body.prescribed.empty() && !damps_by_mass(p.body) &&
         !damps_by_stiffness(p.body) && !has_contact(p);
}

template <class B>
class Measured {
 public:
  Measured(const Problem& problem, const Exec& exec, const StudyRunOptions& options)
      : options_(options),
        exec_(exec),
        start_(Clock::now()),
        simulation_(with_choice(problem, choose_cycle<B>(problem, {options.duration, {}}, exec)),
                    exec),
        conserves_(keeps_energy(problem)),
        part_(0, 1 + options.timed_runs) {
    result_.setup_time = since(start_);
    result_.macro_step = simulation_.macro_step();
    result_.macro_steps = std::lround(std::ceil(options.duration / result_.macro_step - 1e-9));
    at_start_ = simulation_.save();
  }

  StudyRun all() {
    sampled();
    int runs = options_.timed_runs;
    for (int i = 0; i < runs && result_.status == "completed"; ++i) {
      simulation_.restore(at_start_);
      if (i == 0) wall_times_.clear();
      part_ = {i + 1, 1 + runs};
      timed();
      if (i == 0 && !wall_times_.empty()) runs = timed_runs_of(wall_times_[0], runs);
    }
    if (!wall_times_.empty()) {
      std::ranges::sort(wall_times_);
      result_.wall_time = wall_times_[wall_times_.size() / 2];
      result_.wall_time_spread = wall_times_.back() - wall_times_.front();
      result_.timed_runs = static_cast<int>(wall_times_.size());
    }
    return std::move(result_);
  }

 private:
  // Takes one macro step; returns false where the run ends here
  bool step(double& wall_time) {
    const auto start = Clock::now();
    const auto diagnosis = simulation_.step_checked();
    wall_time += since(start);
    if (diagnosis) result_.status = "diverged", result_.reason = diagnosis->text();
    if (!diagnosis) result_.reached = simulation_.time();
    if (!diagnosis && options_.go_on && since(asked_) > 0.05) {
      asked_ = Clock::now();
      const double run =
          static_cast<double>(simulation_.macro_steps()) / static_cast<double>(result_.macro_steps);
      if (!options_.go_on((part_.first + run) / part_.second)) result_.status = "stopped";
    }
    return result_.status == "completed";
  }

  std::vector<Point> sampled(const Vectors<B>& field) const {
    std::vector<Point> values = to_host<B>(exec_, field);
    return options_.at == nullptr ? values : interpolated(values, *options_.at);
  }

  void sampled() {
    TrajectorySampler sampler(options_.sample_times, result_.macro_step, result_.macro_steps);
    const double before = conserves_ ? simulation_.energies().total() : 0;
    double most = 0, wall_time = 0;
    for (long n = 0;; ++n) {
      if (sampler.wants(n)) {
        sampler.add(n, sampled(simulation_.displacement()), sampled(simulation_.velocity()));
        if (conserves_) {
          const Energies e = simulation_.energies();
          most = std::max(most, e.kinetic + e.elastic + e.contact);
        }
      }
      if (n == result_.macro_steps) break;
      if (!step(wall_time)) return;
    }
    if (conserves_ && most > 0)
      result_.energy_drift = (simulation_.energies().total() - before) / most;
    result_.trajectory = sampler.take();
    result_.tet_evaluations = simulation_.counters().at("tet_evaluations");
    wall_times_.push_back(wall_time);
  }

  void timed() {
    double wall_time = 0;
    for (long n = 0; n < result_.macro_steps; ++n)
      if (!step(wall_time)) return;
    wall_times_.push_back(wall_time);
  }

  const StudyRunOptions& options_;
  Exec exec_;
  Clock::time_point start_, asked_{};
  Simulation<B> simulation_;
  bool conserves_;
  SavedState at_start_;
  StudyRun result_;
  std::vector<double> wall_times_;
  std::pair<int, int> part_;  // number of this run, number of all
};

template <class B>
StudyRun run(const Problem& problem, const StudyRunOptions& options) {
  const Exec exec = instance<Exec>(options.threads);
  try {
    return Measured<B>(problem, exec, options).all();
  } catch (const InputError& error) {
    StudyRun refused;
    refused.status = "refused", refused.reason = error.what();
    return refused;
  }
}

}  // namespace

int timed_runs_of(double wall_time, int asked) {
  return asked > 0 && wall_time < short_run ? std::max(asked, runs_if_short) : asked;
}

void check_threads(int threads) { instance<Exec>(threads); }

StudyRun study_run(const Problem& problem, const StudyRunOptions& options) {
  return in_precision<Exec>(
      options.precision, [&]<class B>(std::type_identity<B>) { return run<B>(problem, options); });
}

namespace {

constexpr int most_shortenings = 3;

struct Pair {
  StudyRun coarse, fine;  // at the longer and at the shorter step
  bool stopped() const { return coarse.status == "stopped" || fine.status == "stopped"; }
};

StudyRun run_at(const Problem& problem, const StudyOptions& options, const std::string& integrator,
                double step, const std::function<bool(double)>& go_on, const Embedding* at) {
  StudyCase one;
  one.integration = problem.integration;
  IntegrationOptions& o = one.integration;
  o.cycle = "single", o.integrator = {integrator}, o.substeps = {1};
  o.distribution = "equal", o.shares = {}, o.macro_step = step;
  StudyRunOptions run{options.duration, sampling_times(options.duration, options.samples)};
  run.timed_runs = 0, run.go_on = go_on, run.at = at;
  return study_run(problem_of(problem, one), run);
}

}  // namespace

StudyRun run_to_samples(const Problem& problem, const StudyOptions& options,
                        const std::string& integrator, double longest_step,
                        const std::function<bool(double)>& go_on, const Embedding* at) {
  const double interval = options.duration / options.samples;
  double step = interval / std::ceil(interval / longest_step - 1e-9);
  for (int halvings = 0;; ++halvings, step /= 2) {
    StudyRun result = run_at(problem, options, integrator, step, go_on, at);
    if (result.status != "diverged" && result.status != "refused") return result;
    if (halvings == most_shortenings)
      throw InputError("study: the reference, single/" + integrator + " at " +
                       std::to_string(1e3 * step) + " ms, is not to be had: " + result.reason);
  }
}

namespace {

StudyRun run_below(const Problem& problem, const StudyOptions& options, double longest_step,
                   const std::function<bool(double)>& go_on) {
  return run_to_samples(problem, options, options.reference_integrator, longest_step, go_on);
}

Pair run_both(const Problem& problem, const StudyOptions& options, double critical_step,
              double& wall_time, const std::function<bool(double)>& go_on) {
  const auto part = [&go_on](double from, double size) {
    return [&go_on, from, size](double p) { return !go_on || go_on(from + size * p); };
  };
  Pair runs;
  runs.coarse =
      run_below(problem, options, options.reference_step * critical_step, part(0, 1.0 / 7));
  if (!runs.stopped())
    runs.fine = run_below(problem, options, runs.coarse.macro_step / 2, part(1.0 / 7, 2.0 / 7));
  wall_time = runs.coarse.wall_time + runs.fine.wall_time;
  if (runs.stopped()) return runs;
  expect_motion(runs.fine.trajectory, problem.body.levels.front());
  if (errors_of(runs.coarse.trajectory, runs.fine.trajectory).displacement <=
      options.reference_error)
    return runs;
  runs.coarse = std::move(runs.fine);
  runs.fine = run_below(problem, options, runs.coarse.macro_step / 2, part(3.0 / 7, 4.0 / 7));
  wall_time += runs.fine.wall_time;
  return runs;
}

// Adds the reference on the finer mesh. Edges half as long have about half the critical step
void add_finer(StudyReference& reference, const Problem& problem, const StudyOptions& options,
               const std::function<bool(double)>& go_on) {
  Problem finer = problem;
  finer.body.levels = {*options.finer};
  const double critical = study_levels(finer).front().critical_step;
  const StudyRun run = run_below(finer, options, options.reference_step * critical, go_on);
  if (run.status == "stopped") {
    reference.trajectory = {};
    return;
  }
  const Embedding finest =
      embed(problem.body.levels.front().vertices, *options.finer, Outside::clamp);
  reference.finer = interpolated(run.trajectory, finest);
  reference.space_error = errors_of(reference.trajectory, *reference.finer).displacement;
}

}  // namespace

StudyReference make_reference(const Problem& problem, const StudyOptions& options,
                              double critical_step, const std::function<bool(double)>& go_on) {
  StudyReference reference;
  reference.method = "single/" + options.reference_integrator;
  reference.critical_step = critical_step;
  Pair runs = run_both(problem, options, critical_step, reference.wall_time, go_on);
  if (runs.stopped()) return reference;
  const StudyErrors own = errors_of(runs.coarse.trajectory, runs.fine.trajectory);
  reference.macro_step = runs.fine.macro_step;
  reference.own_error = own.displacement, reference.own_error_velocity = own.velocity;
  reference.seconds_per_evaluation =
      runs.fine.wall_time / static_cast<double>(runs.fine.tet_evaluations);
  reference.trajectory = std::move(runs.fine.trajectory);
  if (options.finer) add_finer(reference, problem, options, go_on);
  return reference;
}

}  // namespace plica
