// SPDX-License-Identifier: BSD-3-Clause
#include <Kokkos_Profiling_ScopedRegion.hpp>
#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <plica/core/error.hpp>
#include <plica/core/text.hpp>
#include <plica/drivers/cycles/him/advice.hpp>
#include <plica/drivers/methods/integrators.hpp>
#include <plica/drivers/methods/steppers.hpp>
#include <plica/drivers/run/diagnose.hpp>
#include <plica/drivers/run/validate.hpp>
#include <plica/drivers/spaces/coarse_spaces.hpp>
#include <plica/drivers/study/choose_cycle.hpp>
#include <plica/drivers/study/cycle_trial.hpp>
#include <plica/drivers/study/elements.hpp>
#include <plica/drivers/study/first_touch.hpp>
#include <plica/drivers/study/trajectory.hpp>
#include <plica/meshes/embedding.hpp>

namespace plica {

namespace {

constexpr int trial_steps = 128;            // length of a trial in critical steps
constexpr int usual_factor = 8;             // macro step over critical step, tried first
constexpr int longer_factors[] = {16, 32};  // tried while the shorter ones are good
constexpr int shorter_factors[] = {4, 2};   // tried until one is good
// maximum macro step over critical step where contact is expected that the trials do not show
constexpr int unseen_factor = 4;
// step of the reference over the critical step; central differences, of order 2
constexpr double reference_step = 0.45;
constexpr int timed_steps = 32;        // steps of level 0 alone that are timed
constexpr double worth = 20;           // least wall time of a run over that of timing it
constexpr double looking_part = 0.05;  // largest part of the run that looking ahead takes
// time from a trial's start to the touch, over the trial's duration
constexpr double before_touching = 0.125;
// run time over single's below which another cycle is taken
constexpr double clearly_less = 0.9;
// set-up time of him without its dense part, over that of level 0 alone, about
constexpr double him_set_ups = 5;
// dense part of him's set-up time, over the cube of the coarsest level's number of vertices [s]
constexpr double him_dense = 2.3e-8;
// elastic energy over its maximum so far, below which looking ahead ends
constexpr double past_the_peak = 0.5;
// wall time of a step of him over one of level 0 alone, about; used until him has been timed
constexpr double him_step = 3;
constexpr long most_looking = 20000;  // maximum number of steps of looking ahead

double reference_forces() { return trial_steps / reference_step; }
// Steps of level 0 alone below which a run is certainly too short for trials
double fewest_steps() { return std::max(worth * timed_steps, reference_forces() / trial_part); }

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::string as_percent(double part) { return number(100 * part, 2) + " %"; }
std::string as_seconds(double time) { return number(time, 2) + " s"; }

std::string too_short(double steps) {
  return text("the run is short: ", number(std::ceil(steps), 9),
              " steps of level 0 alone, and trials pay from ", number(std::ceil(fewest_steps()), 9),
              " on");
}

std::string without_him(const std::string& why) { return "him is refused: " + why; }

IntegrationOptions stepped(IntegrationOptions o, const char* integrator,
                           std::optional<double> step) {
  o.cycle = "single", o.integrator = {integrator}, o.macro_step = step;
  return o;
}

/// Returns the problem with one of its levels alone.
Problem only_level(Problem problem, std::size_t level) {
  keep_levels(problem.body, level, 1);
  return problem;
}

template <class B>
class CycleTrials {
  using Exec = typename B::Exec;

 public:
  CycleTrials(const Problem& problem, const ChoiceOptions& options, const Simulation<B>& alone,
              const Exec& exec)
      : problem_(problem),
        options_(options),
        exec_(exec),
        now_(options.clock ? options.clock : seconds_now) {
    begun_ = now_();
    choice_.error_class = problem.integration.error_class;
    ErrorClasses::visit(choice_.error_class,
                        [&](auto chosen) { choice_.allowed = decltype(chosen)::error; });
    critical_ = alone.levels().front().critical_step, edge_ = alone.levels().front().mean_edge;
    take("single", alone.macro_step(), "there is no coarser level");
    steps_ = options.duration / alone.macro_step();
  }

  CycleChoice all() {
    if (!has_coarse_levels(problem_.integration.cycle, problem_.body)) return std::move(choice_);
    if (const std::string why = refused_by_him(problem_); !why.empty())
      return choice_.reason = without_him(why), std::move(choice_);
    try_out();
    if (choice_.single_time > 0) choice_.spent = now_() - begun_;
    return std::move(choice_);
  }

 private:
  void take(const std::string& cycle, double macro_step, const std::string& reason) {
    choice_.cycle = cycle, choice_.reason = reason;
    choice_.macro_step = macro_step, choice_.over_critical = macro_step / critical_;
  }

  void try_out() {
    if (steps_ < fewest_steps()) return void(choice_.reason = too_short(steps_));
    time_alone();
    budget_ = trial_part * choice_.single_time;
    trials_time_ = reference_forces() * step_time_ + him_set_up() +
                   trial_steps / usual_factor * him_step * step_time_;
    if (choice_.single_time < worth * (now_() - begun_) || now_() - begun_ + trials_time_ > budget_)
      return void(choice_.reason =
                      text("trials would take ", as_seconds(now_() - begun_ + trials_time_),
                           ", more than ", as_percent(trial_part), " of the run by level 0 alone, ",
                           as_seconds(choice_.single_time)));
    choice_.duration = trial_steps * critical_;
    find_start();
    const TrialRun reference = run_reference();
    if (!reference.reason.empty())
      return void(choice_.reason = "level 0 alone, which is what errors are measured against, " +
                                   reference.reason);
    CycleTrial& alone =
        choice_.trials.emplace_back(CycleTrial{"single",
                                               choice_.macro_step,
                                               choice_.over_critical,
                                               {},
                                               "what the others are measured against"});
    alone.set_up_time = set_up_time_, alone.step_time = reference.step_time;
    alone.run_time = run_time_of(alone);
    // a body in contact or deformed takes longer to step than the body at rest that was timed
    budget_ = std::max(budget_, trial_part * alone.run_time);
    try_him(reference);
    choose();
  }

  // Times set-up and steps of level 0 alone, and predicts its run time
  void time_alone() {
    const Kokkos::Profiling::ScopedRegion region("plica: cycle auto: level 0 alone is timed");
    const TrialRun timed =
        run_trial<B>(level_0_alone(problem_), level_0_alone(problem_).integration, timed_steps, {},
                     {now_}, exec_);
    set_up_time_ = timed.set_up_time, step_time_ = timed.step_time;
    choice_.single_time = set_up_time_ + steps_ * step_time_;
  }

  double him_set_up() const {
    if (him_set_up_time_ > 0) return him_set_up_time_;
    const auto& levels = problem_.body.levels;
    double coarsest = static_cast<double>(levels.back().vertices.size());
    if (levels.size() == 1) {  // coarse spaces are made of level 0
      const SizeRule rule = has_contact(problem_) ? him_sizes_with_contact : him_sizes;
      coarsest = std::clamp<double>(rule.last * coarsest, rule.fewest, rule.most);
    }
    return him_set_ups * set_up_time_ + him_dense * coarsest * coarsest * coarsest;
  }

  double run_time_of(const CycleTrial& trial) const {
    if (!std::isfinite(options_.duration)) return trial.step_time / trial.macro_step;
    return trial.set_up_time + options_.duration / trial.macro_step * trial.step_time;
  }

  // Sets the start of the trials shortly before the first touch; else where the body is deformed
  // most. Contact decides which macro step is accurate enough
  void find_start() {
    touch_ = first_touch(problem_, options_.duration);
    const std::optional<RigidMotion> rigid = rigid_motion(problem_);
    const double early = before_touching * choice_.duration;
    if (rigid && touch_.expected() && touch_.time > early) {
      const double t = touch_.time - early;
      const std::size_t vertices = problem_.body.levels.front().vertices.size();
      start_ = {t, std::vector<Point>(vertices, rigid->displacement_at(t)),
                std::vector<Point>(vertices, rigid->velocity_at(t))};
    }
    if (touch_.expected() ? !touch_.exact : !rigid) look_ahead();
    choice_.start = start_.time;
  }

  void look_ahead() {
    const Kokkos::Profiling::ScopedRegion region(
        "plica: cycle auto: the coarsest level looks ahead");
    // The state of largest deformation is computed on level 0 itself. A state that is interpolated
    // between meshes has kinks, and him follows these badly
    const std::size_t last = touch_.expected() ? problem_.body.levels.size() - 1 : 0;
    Problem coarsest = only_level(problem_, last);
    coarsest.integration = stepped(problem_.integration, SymplecticEuler::name, {});
    const double left =
        std::min(looking_part * choice_.single_time, budget_ - trials_time_ - (now_() - begun_));
    const double until = now_() + left, early = before_touching * choice_.duration;
    try {
      Simulation<B> simulation(coarsest, exec_);
      simulation.share_cores();
      if (start_.time > 0) {
        const std::size_t vertices = coarsest.body.levels.front().vertices.size();
        simulation.set_state(std::vector<Point>(vertices, start_.u.front()),
                             std::vector<Point>(vertices, start_.v.front()));
        simulation.set_time(start_.time);
      }
      TrialStart before, now, hardest;
      double most = 0;
      for (long n = 0; n < most_looking && simulation.time() < options_.duration && now_() < until;
           ++n) {
        if (simulation.step_checked()) break;
        if (touch_.expected() && (is_pushed(simulation) || simulation.pair_depth() > 0)) {
          if (before.time > 0) start_ = on_level_0(before);
          return;
        }
        if (simulation.time() < now.time + early) continue;
        before = std::move(now);
        now = {simulation.time(), to_host<B>(exec_, simulation.displacement()),
               to_host<B>(exec_, simulation.velocity())};
        const double elastic = simulation.energies().elastic;
        if (elastic > most) most = elastic, hardest = now;
        if (!touch_.expected() && elastic < past_the_peak * most) break;
      }
      if (most > 0 && last == 0 && start_.time == 0) start_ = hardest;
      // An error of the coarsest level alone is ignored here: a run that uses the level reports it
    } catch (const InputError&) {
    }
  }

  TrialStart on_level_0(const TrialStart& coarse) const {
    if (problem_.body.levels.size() == 1) return coarse;
    const Embedding rows =
        embed(problem_.body.levels.front().vertices, problem_.body.levels.back(), Outside::clamp);
    return {coarse.time, interpolated(coarse.u, rows), interpolated(coarse.v, rows)};
  }

  // Runs level 0 alone, in steps that end exactly at the trial's quarters
  TrialRun run_reference() {
    const double quarter = choice_.duration / trial_quarters;
    const int steps = static_cast<int>(std::ceil(quarter / (reference_step * critical_)));
    const IntegrationOptions o =
        stepped(problem_.integration, CentralDifference::name, quarter / steps);
    TrialRun run =
        run_trial<B>(only_level(problem_, 0), o, trial_quarters * steps, start_, {now_}, exec_);
    const std::optional<RigidMotion> rigid = run.touched ? rigid_motion(problem_) : std::nullopt;
    for (int j = 1; j <= trial_quarters; ++j)
      rigid_.push_back(rigid ? Point(rigid->displacement_at(start_.time + j * quarter) -
                                     rigid->displacement_at(start_.time))
                             : Point::Zero());
    return run;
  }

  void try_him(const TrialRun& reference) {
    const bool moves = anything_moves(reference, rigid_, problem_.body.levels.front());
    const bool unseen = touch_.expected() && !reference.touched;
    choice_.provisional = unseen || !moves;
    const TrialRun* from = moves ? &reference : nullptr;
    if (unseen) {
      for (const int factor : shorter_factors)
        if (factor <= unseen_factor && try_factor(factor, from)) return;
    } else if (try_factor(usual_factor, from)) {
      for (const int factor : longer_factors)
        if (!moves || !try_factor(factor, from)) return;
    } else {
      for (const int factor : shorter_factors)
        if (try_factor(factor, from)) return;
    }
  }

  // Runs him at a factor of the critical step, unless the trial costs more than it can gain. A step
  // of him takes about the same wall time at any length. Returns whether its error is allowed
  bool try_factor(int factor, const TrialRun* reference) {
    if (given_up_) return false;
    const CycleTrial& alone = choice_.trials.front();
    const double step_time = him_step_time_ > 0 ? him_step_time_ : him_step * alone.step_time,
                 spent = now_() - begun_;
    CycleTrial trial{"him",        factor * critical_, static_cast<double>(factor), {}, {},
                     him_set_up(), step_time};
    double best = alone.run_time;
    for (const CycleTrial& before : choice_.trials)
      if (before.error) best = std::min(best, before.run_time);
    const double gain = best - run_time_of(trial),
                 cost = trial.set_up_time + trial_steps / factor * step_time;
    const bool pays = std::isfinite(options_.duration) ? gain > cost : gain > 0;
    if (!pays || spent + cost > budget_) {
      given_up_ = true;
      note_ = !pays ? text("; him at ", factor, " x was not tried: it could gain ",
                           as_seconds(std::max(0., gain)))
                    : text("; him at ", factor, " x was not tried: trials had taken ",
                           as_seconds(spent));
      return false;
    }
    IntegrationOptions o = problem_.integration;
    o.cycle = "him", o.macro_step = trial.macro_step;
    TrialRun run;
    run.reason = too_fast_for_him(problem_, *o.macro_step, edge_);
    if (run.reason.empty())
      run =
          run_trial<B>(problem_, o, trial_steps / factor, start_, {now_, begun_ + budget_}, exec_);
    if (run.set_up_time > 0) him_set_up_time_ = run.set_up_time;
    if (run.step_time > 0) him_step_time_ = run.step_time;
    trial.set_up_time = run.set_up_time, trial.step_time = run.step_time, trial.reason = run.reason;
    trial.run_time = run.step_time > 0 ? run_time_of(trial) : 0;
    if (run.reason.empty())
      trial.error = reference != nullptr ? trial_error(run, *reference, rigid_) : 0;
    if (trial.error && !std::isfinite(*trial.error))
      trial.error.reset(), trial.reason = "diverges: a displacement is not finite";
    choice_.trials.push_back(trial);
    return trial.error && *trial.error <= choice_.allowed;
  }

  void choose() {
    const CycleTrial& alone = choice_.trials.front();
    const CycleTrial* best = nullptr;
    bool within = false;
    for (const CycleTrial& trial : choice_.trials) {
      if (!trial.error || *trial.error > choice_.allowed) continue;
      within = true;
      if (trial.run_time < (best != nullptr ? best->run_time : clearly_less * alone.run_time))
        best = &trial;
    }
    if (best == nullptr) {
      choice_.provisional = false;
      choice_.reason = (within                       ? "no trial was clearly faster"
                        : choice_.trials.size() == 1 ? "no longer step was tried"
                                                     : "no step tried is known to be within " +
                                                           as_percent(choice_.allowed)) +
                       note_;
      return;
    }
    // a whole number of steps to the end of the run, so that this macro step alone repeats the run
    const double steps = std::ceil(options_.duration / best->macro_step * (1 - 1e-9));
    const double macro_step = std::isfinite(steps) ? options_.duration / steps : best->macro_step;
    std::string reason =
        "the least run time of those within " + as_percent(choice_.allowed) + note_;
    if (choice_.provisional)
      reason += touch_.expected()
                    ? "; provisional: contact with " + touch_.what + " was not seen in the trials"
                    : "; provisional: nothing moves in the trials";
    take(best->cycle, macro_step, reason);
  }

  const Problem& problem_;
  const ChoiceOptions& options_;
  const Exec& exec_;
  std::function<double()> now_;
  double begun_ = 0, budget_ = 0, steps_ = 0;
  double critical_ = 0, edge_ = 0;
  double set_up_time_ = 0, step_time_ = 0;          // level 0 alone [s]
  double him_set_up_time_ = 0, him_step_time_ = 0;  // [s]; 0: not timed
  double trials_time_ = 0;                          // estimate for the first trials [s]
  FirstTouch touch_;
  TrialStart start_;
  std::vector<Point> rigid_;  // rigid displacement of the body at each quarter's end [m]
  bool given_up_ = false;
  std::string note_;
  CycleChoice choice_;
};

}  // namespace

std::string CycleChoice::keys() const {
  if (cycle == "single") return "cycle: single, macro_step: auto";
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), macro_step).ptr;
  return "cycle: " + cycle + ", macro_step: " + std::string(digits.data(), end) + " s";
}

template <class B>
std::optional<CycleChoice> choose_cycle(const Problem& problem, const Simulation<B>& alone,
                                        const ChoiceOptions& options,
                                        const typename B::Exec& exec) {
  if (problem.integration.cycle != "auto") return {};
  return CycleTrials<B>(problem, options, alone, exec).all();
}

template <class B>
std::optional<CycleChoice> choose_cycle(const Problem& problem, const ChoiceOptions& options,
                                        const typename B::Exec& exec) {
  if (problem.integration.cycle != "auto") return {};
  validate(problem);
  const Simulation<B> alone(level_0_alone(problem), exec);
  return choose_cycle<B>(problem, alone, options, exec);
}

std::string trials_ahead(const Problem& problem, double duration, const LevelReport& alone,
                         double macro_step) {
  if (problem.integration.cycle != "auto") return {};
  if (!has_coarse_levels("auto", problem.body))
    return "a run takes single: there is no coarser level";
  if (const std::string why = refused_by_him(problem); !why.empty())
    return "a run takes single: " + without_him(why);
  const double steps = duration / macro_step;
  if (steps < fewest_steps()) return "a run takes single: " + too_short(steps);
  const double early = before_touching * trial_steps * alone.critical_step;
  const FirstTouch touch = first_touch(problem, duration);
  std::string from = "from the start, or where the body is deformed most";
  if (rigid_motion(problem)) from = "from the start";
  if (touch.expected())
    from = touch.exact
               ? text("from ", number(std::max(0., touch.time - early), 3),
                      " s on, shortly before ", touch.what, " is first touched")
               : text("shortly before ", touch.what, " is first touched, which is not before ",
                      number(touch.time, 3), " s");
  return text("a run times ", timed_steps, " of the ", number(std::ceil(steps), 9),
              " steps of level 0 alone, and takes single unless trials cost less than ",
              as_percent(trial_part), " of it; it tries him at ", usual_factor, " critical steps, ",
              number(usual_factor * alone.critical_step, 3),
              " s, then at 16 and 32, or at 4 and 2, ", from);
}

Problem level_0_alone(Problem problem) {
  if (problem.integration.cycle == "auto") problem.integration.cycle = "single";
  return problem;
}

Problem with_choice(Problem problem, const std::optional<CycleChoice>& choice) {
  if (!choice) return problem;
  problem.integration.cycle = choice->cycle;
  if (choice->cycle != "single") problem.integration.macro_step = choice->macro_step;
  return problem;
}

#define PLICA_INSTANTIATE(Real, Exec)                                    \
  template std::optional<CycleChoice> choose_cycle<Backend<Real, Exec>>( \
      const Problem&, const ChoiceOptions&, const Exec&);                \
  template std::optional<CycleChoice> choose_cycle<Backend<Real, Exec>>( \
      const Problem&, const Simulation<Backend<Real, Exec>>&, const ChoiceOptions&, const Exec&);
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
