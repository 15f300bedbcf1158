// SPDX-License-Identifier: BSD-3-Clause
#include <chrono>
#include <plica/core/error.hpp>
#include <plica/core/precision.hpp>
#include <plica/drivers/methods/methods.hpp>
#include <plica/drivers/run/validate.hpp>
#include <plica/drivers/study/cycle_growth.hpp>
#include <plica/drivers/study/small_motion.hpp>
#include <plica/drivers/study/stability.hpp>
#include <plica/drivers/study/study_case.hpp>

namespace plica {

namespace {

/// Runs the problem and returns why it did not complete; none where it did.
template <class B>
std::optional<SceneLimit> failure_of(const Problem& problem, double duration,
                                     const std::function<void()>& go_on) {
  SceneLimit failed;
  failed.failed_step = problem.integration.macro_step;
  try {
    Simulation<B> simulation(problem);
    const long steps = std::lround(std::ceil(duration / simulation.macro_step() - 1e-9));
    for (long n = 0; n < steps; ++n) {
      failed.failed_time = simulation.time();
      failed.failure = simulation.step_checked();
      if (failed.failure) {
        failed.reason = failed.failure->text();
        return failed;
      }
      go_on();
    }
  } catch (const InputError& error) {
    failed.reason = error.what();
    return failed;
  }
  return {};
}

/// Finds the largest macro step at which the problem itself completes `duration` [s], by repeated
/// runs. Explicit sub-steps may be above their limit.
/// @param go_on  called after every macro step; an exception from it ends the search
template <class B>
SceneLimit scene_limit(const Problem& problem, double duration, const StepRange& range,
                       const std::function<void()>& go_on) {
  SceneLimit found;
  Problem p = problem;
  p.integration.allow_unstable = true;
  const LargestStep largest = largest_stable(range, [&](double step) {
    p.integration.macro_step = step;
    const auto failed = failure_of<B>(p, duration, go_on);
    if (failed && (!found.failed_step || step < *found.failed_step)) found = *failed;
    return !failed;
  });
  if (largest.kind != LargestStep::Kind::growing) found.step = largest.step;
  return found;
}

using Clock = std::chrono::steady_clock;
using Exec = Kokkos::DefaultExecutionSpace;
using Kind = LargestStep::Kind;

// macro steps of a run
constexpr long explicit_steps = 400, cycle_steps = 600, implicit_steps = 40;
// longest macro step over the critical step
constexpr double implicit_most = 1000;
// shortest and longest macro step over the finest critical step
constexpr double cycle_least = 0.5, cycle_most = 32;
// growth per macro step up to which a cycle is called stable
constexpr double least_growth = 1e-4;
constexpr double longest_run = 16000;  // maximum macro steps of a run that shows slow growth
constexpr double him_most = 64;        // longest macro step over the finest critical step
// first macro step of the scene's own runs over the limit of small motions
constexpr double scene_at = 0.99;
constexpr double scene_least = 1.0 / 64;  // shortest macro step of these runs over the first

struct Stopped {};  // thrown through the searches where the caller or the budget ends them

/// A method with the problem on which its limit is searched.
struct Sought {
  StudyCase method;
  Problem problem;
  // critical step of its finest level under symplectic Euler, at rest without contact [s]
  double critical = 0;
};

template <class B>
class Search {
 public:
  Search(const Problem& problem, const StudyOptions& options, const StabilityWatch& watch)
      : problem_(problem), options_(options), watch_(watch), growth_(problem) {
    StudyOptions all = options;
    if (all.methods.empty()) all.methods = {"single"};
    if (options.methods.empty() && problem.body.levels.size() > 1)
      all.methods = {"single", "coarse", "cycle"};
    for (const ChosenMethod& chosen : chosen_methods(problem, all))
      add(study_case(problem, all, chosen));
  }

  StabilityResult all() {
    for (const StudyCase& one : methods_) try {
        doing_ = label(one);
        go_on();
        StabilityRow row = row_of(one);
        result_.rows.push_back(std::move(row));
        tell(true);
      } catch (const Stopped&) {
        result_.left_out.push_back(label(one));
      }
    return std::move(result_);
  }

 private:
  void add(const StudyCase& one) {
    // cycle auto chooses among stable steps: it is no method of its own
    if (one.integration.cycle == "auto") return;
    if (one.level == 0) return methods_.push_back(one);
    for (const std::string& integrator : names(integrators()))
      if (is_explicit(integrator))
        methods_.push_back(one), methods_.back().integration.integrator = {integrator};
  }
  static std::string label(const StudyCase& one) {
    const std::string& integrator = one.integration.integrator.front();
    return one.label() +
           (one.level > 0 && integrator != "symplectic_euler" ? ", " + integrator : "");
  }

  void tell(bool new_row) {
    if (watch_ && !watch_({doing_, result_.rows.size(), methods_.size(), &result_, new_row}))
      result_.stopped = true;
  }
  void go_on() {
    if (std::chrono::duration<double>(Clock::now() - told_).count() > 0.05)
      tell(false), told_ = Clock::now();
    if (result_.stopped ||
        (options_.budget &&
         std::chrono::duration<double>(Clock::now() - start_).count() > *options_.budget))
      throw Stopped{};
  }

  BuiltHierarchy<B> built_at(const Sought& s, double macro_step) const {
    Problem p = s.problem;
    p.integration.macro_step = macro_step, p.integration.allow_unstable = true;
    return build_hierarchy<B>(about_rest<B>(p, exec_), exec_);
  }

  bool bounded(BuiltHierarchy<B>& built, double t, long macro_steps) {
    const SmallMotion run =
        small_motion<B>(built, t, {macro_steps, [this] { return go_on(), true; }});
    return run.bounded;
  }

  StabilityRow row_of(const StudyCase& one) {
    StabilityRow row;
    row.method = one.method, row.distribution = one.distribution, row.variant = one.variant;
    if (one.integration.cycle == "single") row.integrator = one.integration.integrator.front();
    try {
      Sought s{one, problem_of(problem_, one)};
      s.problem.body.loads.clear();  // a coarse mesh may have no vertex where one acts
      row.critical_step = study_level(problem_, one.level).critical_step;
      remove_contact(s.problem);
      s.critical = study_level(s.problem, 0).critical_step;
      if (!row.integrator.empty())
        is_explicit(row.integrator) ? find_explicit(row, s) : find_implicit(row, s);
      else
        integrates_coarse_levels(one.integration.cycle) ? find_cycle(row, s) : find_him(row, s);
      if (row.predicted && *row.predicted > 0 && row.measured)
        row.ratio = *row.measured / *row.predicted;
      if (has_own_limit()) add_scene(row, s);
    } catch (const InputError& error) {
      row.status = "refused", row.reason = error.what();
    }
    return row;
  }

  void put(StabilityRow& row, const LargestStep& found) const {
    row.status = found.kind == Kind::limited   ? "limited"
                 : found.kind == Kind::growing ? "growing"
                                               : "unlimited";
    if (found.kind == Kind::unlimited) row.stable_up_to = found.step;
    if (found.kind == Kind::limited) row.measured = found.step;
    if (found.kind == Kind::growing) row.measured = 0;
  }

  void find_explicit(StabilityRow& row, const Sought& s) {
    row.predicted = built_at(s, s.critical).reports.front().critical_step;
    const bool none = !(*row.predicted > 0);
    const double guess = none ? cycle_least * s.critical : *row.predicted;
    put(row,
        largest_stable({guess, none ? guess : guess / 8, 8 * guess, 1.01, 2e-3}, [&](double t) {
          BuiltHierarchy<B> built = built_at(s, t);
          return bounded(built, t, explicit_steps);
        }));
    if (row.status == "growing") add_growth(row, s, guess);
  }

  void find_implicit(StabilityRow& row, const Sought& s) {
    const double most = implicit_most * s.critical;
    put(row, largest_stable({most, s.critical, most, 4, 0.02}, [&](double t) {
          BuiltHierarchy<B> built = built_at(s, t);
          return bounded(built, t, implicit_steps);
        }));
  }

  // Finds the longest step that him's inertia allows; the inertia stays that of its own macro step
  void find_him(StabilityRow& row, const Sought& s) {
    BuiltHierarchy<B> built = build_hierarchy<B>(about_rest<B>(s.problem, exec_), exec_);
    row.predicted = built.macro_step * 2 / std::sqrt(built.him->product);
    put(row, largest_stable({*row.predicted, *row.predicted / 8, 8 * *row.predicted, 1.02, 5e-3},
                            [&](double t) { return bounded(built, t, cycle_steps); }));
  }

  void find_cycle(StabilityRow& row, const Sought& s) {
    const double modes = 3.0 * built_at(s, s.critical).reports.front().vertices;
    const double least = cycle_least * s.critical, most = cycle_most * s.critical;
    if (grows_at(row, s, least, modes)) {
      row.status = "growing", row.predicted = 0;
      return add_growth(row, s, s.critical);
    }
    const double told = 1 + visible_growth(modes, cycle_steps);
    const LargestStep predicted =
        largest_stable({s.critical, least, most, 1.5, 0.02},
                       [&](double t) { return growth_at(s, t, told).radius <= told; });
    if (predicted.kind != Kind::unlimited)
      row.predicted = predicted.kind == Kind::limited ? predicted.step : 0;
    put(row, largest_stable({predicted.step, least, most, 1.05, 0.01}, [&](double t) {
          BuiltHierarchy<B> built = built_at(s, t);
          return bounded(built, t, cycle_steps);
        }));
    add_growth(row, s,
               row.status == "limited" ? std::min(*row.measured, predicted.step) : predicted.step);
  }

  CycleGrowth growth_at(const Sought& s, double t, double told_from) {
    go_on();
    const auto growth = growth_.of(s.method, t, told_from);
    if (!growth) throw InputError("its set-up is refused at " + std::to_string(t) + " s");
    return *growth;
  }

  // Returns whether a cycle grows, by its map, and by a run where one of reasonable length shows it
  bool grows_at(StabilityRow& row, const Sought& s, double t, double modes) {
    const CycleGrowth growth = growth_at(s, t, 1 + least_growth);
    const Body& body = s.problem.body;
    // rigid drift away from the start is no growth
    const bool drifts = body.fixed.empty() && body.prescribed.empty() && !growth.converged;
    const double unsure =
        2 * growth.uncertainty + (drifts ? 3.0 / static_cast<double>(growth.macro_steps) : 0);
    if (growth.radius - unsure <= 1 + least_growth) return false;
    const double steps = std::ceil(1.5 * visible_growth(modes, 1) / std::log(growth.radius));
    if (steps > longest_run) return growth.converged;
    BuiltHierarchy<B> built = built_at(s, t);
    if (bounded(built, t, std::max(cycle_steps, static_cast<long>(steps)))) return false;
    row.measured = 0;
    return true;
  }

  void add_growth(StabilityRow& row, const Sought& s, double t) {
    go_on();
    GrowthOfCycles own(s.problem);
    GrowthOfCycles& of = s.method.level > 0 ? own : growth_;
    StudyCase at = s.method;
    at.integration.allow_unstable = true;
    if (const auto growth = of.of(at, t, 1 + least_growth)) {
      row.growth_step = t, row.spectral_radius = growth->radius,
      row.growth_per_second = growth->per_second;
    }
  }

  // Returns whether the scene may have another limit than small motions about rest
  bool has_own_limit() const {
    return problem_.body.material.model != "linear" || !problem_.contact.obstacles.empty();
  }

  void add_scene(StabilityRow& row, const Sought& s) {
    const double longest = options_.duration / 4;
    double guess = s.critical, most = cycle_most * s.critical;
    if (row.status == "limited") guess = most = scene_at * *row.measured;
    if (row.status == "unlimited") guess = most = *row.stable_up_to;
    if (row.integrator.empty() && !integrates_coarse_levels(s.method.integration.cycle))
      guess = s.problem.integration.macro_step.value_or(s.critical), most = him_most * s.critical;
    guess = std::min(guess, longest), most = std::min(most, longest);
    row.scene = scene_limit<B>(problem_of(problem_, s.method), options_.duration,
                               {guess, guess * scene_least, most, 1.1, 0.03}, [this] { go_on(); });
  }

  const Problem& problem_;
  const StudyOptions& options_;
  const StabilityWatch& watch_;
  Exec exec_;
  GrowthOfCycles growth_;
  std::vector<StudyCase> methods_;
  StabilityResult result_;
  std::string doing_;
  Clock::time_point start_ = Clock::now(), told_{};
};

}  // namespace

std::string StabilityRow::label() const {
  return study_label(method, distribution, variant) +
         (method.starts_with("coarse/") && integrator != "symplectic_euler" ? ", " + integrator
                                                                            : "");
}

StabilityResult stability(const Problem& problem, const StudyOptions& options,
                          const StabilityWatch& watch) {
  validate(problem);
  if (!(options.duration > 0)) throw InputError("stability: the duration is not above 0");
  check_study(problem, options);
  const std::string precision = options.precision.empty() ? "double" : options.precision.front();
  return in_precision<Exec>(precision, [&]<class B>(std::type_identity<B>) {
    return Search<B>(problem, options, watch).all();
  });
}

}  // namespace plica
