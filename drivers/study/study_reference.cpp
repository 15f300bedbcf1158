// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <plica/core/error.hpp>
#include <plica/drivers/study/study_reference.hpp>

namespace plica {

namespace {

constexpr int most_halvings = 3;

struct Pair {
  StudyRun coarse, fine;  // in time
  bool stopped() const { return coarse.status == "stopped" || fine.status == "stopped"; }
};

StudyRun run_at(const Problem& problem, const StudyOptions& options, double step,
                const std::function<bool(double)>& go_on) {
  StudyCase one;
  one.integration = problem.integration;
  IntegrationOptions& o = one.integration;
  o.cycle = "single", o.integrator = {options.reference_integrator}, o.substeps = {1};
  o.distribution = "equal", o.shares = {}, o.macro_step = step;
  StudyRunOptions run{options.duration, sampling_times(options.duration, options.samples)};
  run.timed_runs = 0, run.go_on = go_on;
  return study_run(problem_of(problem, one), run);
}

// Hits every sampling time; at half the step, and half of that, where it does not come to its end
StudyRun run_below(const Problem& problem, const StudyOptions& options, double longest_step,
                   const std::function<bool(double)>& go_on) {
  const double interval = options.duration / options.samples;
  double step = interval / std::ceil(interval / longest_step - 1e-9);
  for (int halvings = 0;; ++halvings, step /= 2) {
    StudyRun result = run_at(problem, options, step, go_on);
    if (result.status != "diverged" && result.status != "refused") return result;
    if (halvings == most_halvings)
      throw InputError("study: the reference, single/" + options.reference_integrator + " at " +
                       std::to_string(1e3 * step) + " ms, is not to be had: " + result.reason);
  }
}

Pair run_both(const Problem& problem, const StudyOptions& options, double critical_step, double& wall_time,
              const std::function<bool(double)>& go_on) {
  const auto part = [&go_on](double from, double size) {
    return [&go_on, from, size](double p) { return !go_on || go_on(from + size * p); };
  };
  Pair runs;
  runs.coarse = run_below(problem, options, options.reference_step * critical_step, part(0, 1.0 / 7));
  if (!runs.stopped()) runs.fine = run_below(problem, options, runs.coarse.macro_step / 2, part(1.0 / 7, 2.0 / 7));
  wall_time = runs.coarse.wall_time + runs.fine.wall_time;
  if (runs.stopped()) return runs;
  expect_motion(runs.fine.trajectory, problem.body.levels.front());
  if (errors_of(runs.coarse.trajectory, runs.fine.trajectory).displacement <= options.reference_error) return runs;
  runs.coarse = std::move(runs.fine);
  runs.fine = run_below(problem, options, runs.coarse.macro_step / 2, part(3.0 / 7, 4.0 / 7));
  wall_time += runs.fine.wall_time;
  return runs;
}

// Half the length, half the limit, about
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
  const Embedding finest = embed(problem.body.levels.front().vertices, *options.finer, Outside::clamp);
  reference.finer = interpolated(run.trajectory, finest);
  reference.space_error = errors_of(reference.trajectory, *reference.finer).displacement;
}

}  // namespace

StudyReference make_reference(const Problem& problem, const StudyOptions& options, double critical_step,
                              const std::function<bool(double)>& go_on) {
  StudyReference reference;
  reference.method = "single/" + options.reference_integrator;
  reference.critical_step = critical_step;
  Pair runs = run_both(problem, options, critical_step, reference.wall_time, go_on);
  if (runs.stopped()) return reference;
  const StudyErrors own = errors_of(runs.coarse.trajectory, runs.fine.trajectory);
  reference.macro_step = runs.fine.macro_step;
  reference.own_error = own.displacement, reference.own_error_velocity = own.velocity;
  reference.seconds_per_evaluation = runs.fine.wall_time / static_cast<double>(runs.fine.tet_evaluations);
  reference.trajectory = std::move(runs.fine.trajectory);
  if (options.finer) add_finer(reference, problem, options, go_on);
  return reference;
}

}  // namespace plica
