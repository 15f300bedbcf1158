// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <plica/core/error.hpp>
#include <plica/core/text.hpp>
#include <plica/drivers/run/validate.hpp>
#include <plica/drivers/study/cycle_growth.hpp>
#include <plica/drivers/study/elements.hpp>
#include <plica/drivers/study/study.hpp>
#include <plica/drivers/study/truth.hpp>

namespace plica {

namespace {

using Clock = std::chrono::steady_clock;

class Study {
 public:
  Study(const Problem& problem, const StudyOptions& options, const StudyWatch& watch,
        StudyResult before)
      : problem_(problem), options_(options), watch_(watch), result_(std::move(before)) {
    result_.left_out.clear(), result_.stopped = false;
    for (const std::string& element : elements()) {
      const Problem one = with_element(problem, element);
      levels_[element] = study_levels(one);
      for (StudyCase& added : study_cases(one, options, levels_[element])) {
        added.element = element;
        cases_.push_back(std::move(added));
      }
    }
    const StudyLevel& finest = levels_.at(elements().front()).front();
    std::vector<Point> probe_points;
    for (const auto& [name, point] : options.probes) probe_points.push_back(point);
    probes_ = embed(probe_points, problem.body.levels.front(), Outside::clamp);
    std::erase_if(result_.rows, [&](const StudyRow& row) {
      return std::ranges::none_of(cases_, [&](const StudyCase& c) { return c.key() == row.key; });
    });
    unit_work_ = finest.tets * std::ceil(options.duration / (0.9 * finest.critical_step) - 1e-9);
  }

  StudyResult all() {
    if (!have_reference()) return std::move(result_);
    std::vector<StudyCase> by_rank = cases_;
    std::ranges::stable_sort(by_rank, {}, &StudyCase::rank);
    for (const StudyCase& one : by_rank) {
      if (!has(one)) run(one);
      if (options_.growth && has(one)) find_growth(one);
    }
    finish();
    return std::move(result_);
  }

 private:
  bool tell(const std::string& doing, double part, bool new_reference = false,
            bool new_row = false) {
    if (watch_ && !watch_({doing, result_.rows.size(), cases_.size(), part, &result_, new_reference,
                           new_row}))
      result_.stopped = true;
    return !result_.stopped;
  }
  double elapsed() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
  bool has(const StudyCase& one) const {
    return std::ranges::any_of(result_.rows,
                               [&](const StudyRow& row) { return row.key == one.key(); });
  }

  // Returns the kinds of elements to compare; "": the problem's own
  std::vector<std::string> elements() const {
    if (!options_.elements.empty()) return options_.elements;
    return options_.truth ? element_families() : std::vector<std::string>{""};
  }

  bool have_reference() {
    const StudyReference& there = result_.reference;
    const bool none =
        there.trajectory.u.empty() || there.truth.has_value() != options_.truth.has_value();
    if (none && options_.truth)
      result_.reference = make_truth(
          problem_, options_, options_.budget,
          [this](const std::string& doing, double part) { return tell("truth: " + doing, part); });
    else if (none || (options_.finer && !there.finer))
      result_.reference = make_reference(problem_, options_, study_level(problem_, 0).critical_step,
                                         [this](double part) { return tell("reference", part); });
    if (result_.stopped) return false;
    tell("reference", 1, true);
    return true;
  }

  // Returns the predicted wall time of one run [s], corrected by measured rows of the same kind
  double predicted_once(const StudyCase& one) {
    return one.predicted_evaluations * result_.reference.seconds_per_evaluation * correction(one);
  }
  // Returns the predicted wall time of all runs of a case [s]
  double predicted(const StudyCase& one) {
    const double run = predicted_once(one);
    return run * (1 + timed_runs_of(run, options_.timed_runs));
  }
  double& correction(const StudyCase& one) {
    const std::string kind =
        study_label(one.method, {}, one.variant) + " " + one.element + " " + one.precision;
    return correction_.try_emplace(kind + std::to_string(one.threads), 1.0).first->second;
  }
  bool fits(double seconds) const {
    return !options_.budget || elapsed() + seconds <= *options_.budget;
  }

  // Returns the number of timed runs that the budget allows; none where not even one run fits. A
  // control may have its first run alone (0). The first control is always run, since it says what
  // the budget gives without any cycle.
  std::optional<int> affordable(const StudyCase& one) {
    if (fits(predicted(one))) return options_.timed_runs;
    if (one.control && (one.rank == 0 || fits(predicted_once(one)))) return 0;
    return {};
  }

  void leave_out(const StudyCase& one) { leave_out(one.key(), predicted(one)); }
  void leave_out(const std::string& key, double seconds) {
    const double left = std::max(0.0, *options_.budget - elapsed());
    result_.left_out.push_back(
        {key, text("predicted to take ", number(seconds, 2), " s, with ", number(left, 2),
                   " s left of the budget of ", number(*options_.budget, 3), " s")});
  }

  void run(const StudyCase& one) {
    if (result_.stopped)
      result_.left_out.push_back({one.key(), "the study was stopped before"});
    else if (const auto timed_runs = affordable(one))
      measure(one, *timed_runs);
    else
      leave_out(one);
  }

  void find_growth(const StudyCase& one) {
    const auto row = std::ranges::find(result_.rows, one.key(), &StudyRow::key);
    if (!row->macro_step || row->spectral_radius || one.integration.cycle == "single") return;
    const std::string key = "growth of " + one.key();
    if (result_.stopped || !tell(key, 0))
      return result_.left_out.push_back({key, "the study was stopped before"});
    const double seconds = growth_.predicted_evaluations(one, *row->macro_step, options_.duration) *
                           result_.reference.seconds_per_evaluation * correction(one);
    if (seconds > 0 && !fits(seconds)) return leave_out(key, seconds);
    if (const auto found = growth_.of(one, *row->macro_step)) {
      row->spectral_radius = found->radius, row->spectral_radius_uncertainty = found->uncertainty;
      row->growth_per_second = found->per_second;
    }
    tell(key, 1, false, true);
  }

  void measure(const StudyCase& one, int timed_runs) {
    if (!tell(one.key(), 0))
      return result_.left_out.push_back({one.key(), "the study was stopped before"});
    StudyRunOptions options{options_.duration, result_.reference.trajectory.times, one.precision,
                            one.threads, timed_runs};
    options.go_on = [&](double part) { return tell(one.key(), part); };
    const StudyRun run = study_run(problem_of(problem_, one), options);
    if (run.status == "stopped")
      return result_.left_out.push_back({one.key(), "the study was stopped before"});
    result_.rows.push_back(row_of(one, run));
    if (run.status == "completed" && one.predicted_evaluations > 0)
      correction(one) =
          run.wall_time / (one.predicted_evaluations * result_.reference.seconds_per_evaluation);
    finish();
    tell(one.key(), 1, false, true);
  }

  StudyRow row_of(const StudyCase& one, const StudyRun& run) const {
    StudyRow row;
    row.method = one.method, row.distribution = one.distribution, row.variant = one.variant,
    row.key = one.key();
    row.element = one.element.empty()
                      ? name_of(element_of(problem_.body, static_cast<std::size_t>(one.level)))
                      : one.element;
    row.precision = one.precision, row.status = run.status, row.reason = run.reason;
    row.threads = one.threads > 0 ? one.threads : Kokkos::DefaultExecutionSpace().concurrency();
    row.automatic = !one.integration.macro_step;
    row.macro_step = one.integration.macro_step;
    if (run.macro_step > 0) row.macro_step = run.macro_step;
    if (row.macro_step)
      row.macro_step_over_critical =
          *row.macro_step / levels_.at(one.element).front().critical_step;
    if (run.status != "refused") row.setup_time = run.setup_time;
    if (run.status == "diverged") {
      row.reached = run.reached;
      if (one.predicted_evaluations > 0) row.work = one.predicted_evaluations / unit_work_;
    }
    if (run.status == "completed") add_measures(row, one, run);
    return row;
  }

  void add_measures(StudyRow& row, const StudyCase& one, const StudyRun& run) const {
    const Trajectory& reference = result_.reference.trajectory;
    Trajectory found = run.trajectory;
    if (one.level > 0) {
      const auto& levels = problem_.body.levels;
      found = interpolated(
          found,
          embed(levels[0].vertices, levels[static_cast<std::size_t>(one.level)], Outside::clamp));
    }
    const StudyErrors errors = errors_of(found, reference);
    if (!std::isfinite(errors.displacement + errors.velocity)) {
      row.status = "diverged", row.reason = "a sampled value is not finite";
      return;
    }
    row.error = errors.displacement, row.error_velocity = errors.velocity,
    row.error_worst_vertex = errors.worst_vertex;
    if (result_.reference.finer)
      row.error_finer = errors_of(found, *result_.reference.finer).displacement;
    if (result_.reference.truth) add_parts(row, one, found);
    add_probes(row, found);
    row.energy_drift = run.energy_drift;
    if (run.energy_drift) row.phase = delay_of(found, reference);
    row.wall_time = run.wall_time, row.wall_time_spread = run.wall_time_spread,
    row.timed_runs = run.timed_runs;
    row.work = static_cast<double>(run.tet_evaluations) / unit_work_;
  }

  // Splits the error against the truth. The row's mesh and elements, converged in time, separate
  // the error in space from that in time
  void add_parts(StudyRow& row, const StudyCase& one, const Trajectory& found) const {
    for (const MeshReference& mesh : result_.reference.meshes) {
      if (mesh.element != row.element || mesh.level != one.level) continue;
      row.total_error = row.error, row.space_error = mesh.error_space;
      row.error = difference(found, mesh.trajectory, result_.reference.trajectory);
    }
  }

  void add_probes(StudyRow& row, const Trajectory& found) const {
    const Trajectory at = interpolated(found, probes_);
    const Trajectory& truth = result_.reference.probes;
    const Trajectory reference =
        truth.u.empty() ? interpolated(result_.reference.trajectory, probes_) : truth;
    std::size_t i = 0;
    for (const auto& [name, point] : options_.probes)
      row.error_probes[name] = error_at(at, reference, i++);
  }

  void finish() {
    const auto place = [&](const StudyRow& row) {
      return std::ranges::find_if(cases_, [&](const StudyCase& c) { return c.key() == row.key; }) -
             cases_.begin();
    };
    std::ranges::stable_sort(result_.rows, {}, place);
    mark_pareto(result_.rows);
  }

  const Problem& problem_;
  const StudyOptions& options_;
  const StudyWatch& watch_;
  Clock::time_point start_ = Clock::now();
  StudyResult result_;
  std::map<std::string, std::vector<StudyLevel>> levels_;  // by kind of elements
  std::vector<StudyCase> cases_;
  Embedding probes_;
  GrowthOfCycles growth_{problem_};
  std::map<std::string, double> correction_;
  double unit_work_ = 1;
};

void check(const StudyOptions& o) {
  if (!(o.duration > 0))
    throw InputError("study: the duration is " + std::to_string(o.duration) + "; expected > 0");
  if (o.samples < 1)
    throw InputError("study.samples: " + std::to_string(o.samples) + "; expected >= 1");
  if (o.precision.empty()) throw InputError("study.precision: expected float, double, or both");
  for (const std::string& precision : o.precision)
    if (precision != "float" && precision != "double")
      throw InputError("study.precision: " +
                       unknown_name("precision", precision, {"float", "double"}));
  for (const int threads : o.threads) check_threads(threads);
  for (const auto& step : o.macro_steps)
    if (step && !(*step > 0))
      throw InputError("study.macro_steps: " + std::to_string(*step) + "; expected > 0");
  if (o.truth && o.truth->refinements && *o.truth->refinements < 1)
    throw InputError("study.truth.refinements: " + std::to_string(*o.truth->refinements) +
                     "; expected >= 1");
  for (const std::string& element : o.elements) check_element(element);
  if (!(o.reference_step > 0)) throw InputError("study: the reference's step is not above 0");
}

}  // namespace

StudyResult study(const Problem& problem, const StudyOptions& options, const StudyWatch& watch,
                  StudyResult before) {
  validate(problem);
  check(options);
  check_study(problem, options);
  return Study(problem, options, watch, std::move(before)).all();
}

namespace {

constexpr double resolution = 0.1;  // largest own error of the reference over an error it resolves

bool completed(const StudyRow& row) {
  return row.status == "completed" && row.judged() && row.wall_time;
}

bool dominates(const StudyRow& a, const StudyRow& b) {
  const bool as_good = *a.judged() <= *b.judged() && *a.wall_time <= *b.wall_time;
  return as_good && (*a.judged() < *b.judged() || *a.wall_time < *b.wall_time);
}

}  // namespace

void mark_pareto(std::vector<StudyRow>& rows) {
  for (StudyRow& row : rows)
    row.pareto = completed(row) && std::ranges::none_of(rows, [&](const StudyRow& other) {
                   return completed(other) && dominates(other, row);
                 });
}

bool grows(const StudyRow& row) {
  return row.spectral_radius &&
         *row.spectral_radius > 1 + 1e-6 + row.spectral_radius_uncertainty.value_or(0);
}

std::optional<double> smallest_error(const std::vector<StudyRow>& rows) {
  std::optional<double> smallest;
  for (const StudyRow& row : rows)
    if (completed(row) && (!smallest || *row.judged() < *smallest)) smallest = row.judged();
  return smallest;
}

bool resolves(const StudyReference& reference, double error) {
  return reference.own_error <= resolution * error;
}

bool good_enough(const StudyResult& result) {
  const auto smallest = smallest_error(result.rows);
  return !smallest || resolves(result.reference, *smallest);
}

const StudyRow* fastest_below(const std::vector<StudyRow>& rows, double error) {
  const StudyRow* fastest = nullptr;
  for (const StudyRow& row : rows)
    if (completed(row) && *row.judged() < error &&
        (fastest == nullptr || *row.wall_time < *fastest->wall_time))
      fastest = &row;
  return fastest;
}

}  // namespace plica
