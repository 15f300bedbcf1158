// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <plica/drivers/cycles/plan_steps.hpp>
#include <plica/drivers/cycles/regrow_schedule.hpp>
#include <plica/drivers/cycles/stepper.hpp>
#include <plica/drivers/elastic/largest_eigenvalue.hpp>
#include <plica/drivers/methods/integrators.hpp>

namespace plica {

/// Base of the cycles in which each level integrates its own share of the macro step.
///
/// The plan takes the limit of an explicit level at rest. A body that is pressed or struck
/// stiffens, and its limit is shorter. So where the number of sub-steps was left to the plan,
/// repair() halves the explicit levels' sub-steps. regrow() doubles them again where the largest
/// eigenvalue allows it. Beyond the limit the fastest motion grows by a factor in every step. Where
/// kinetic energy has grown much, lost_stability() computes the eigenvalue of the motion that there
/// is.
template <class B>
class SharedStep : public Stepper<B> {
 public:
  /// Sets shares, sub-steps and the macro step, see plan_steps(), and allocates the cycle's fields.
  void plan(StepperSetup<B>& setup) override {
    std::vector<LevelLimits> limits;
    for (const LevelReport& r : setup.reports)
      limits.push_back({r.tets, r.integrator, r.explicit_integrator, r.critical_step,
                        r.stiffest.front(), r.typical_element});
    const StepPlan steps =
        plan_steps(setup.problem.integration, limits, !setup.problem.cuts.empty());
    setup.macro_step = steps.macro_step;
    for (int i = 0; i < setup.hierarchy.count(); ++i) {
      const auto k = static_cast<std::size_t>(i);
      setup.hierarchy[i].share = setup.reports[k].share = steps.share[k];
      setup.hierarchy[i].substeps = setup.reports[k].substeps = steps.substeps[k];
      is_explicit_.push_back(setup.reports[k].explicit_integrator);
      Integrators::visit(setup.reports[k].integrator,
                         [&](auto kind) { radius_.push_back(kind.limit.radius); });
    }
    macro_step_ = steps.macro_step;
    const IntegrationOptions& o = setup.problem.integration;
    safety_ = o.safety;
    const bool is_automatic = std::ranges::all_of(o.substeps, [](int n) { return n == 0; });
    shortens_ = is_automatic && !o.allow_unstable &&
                o.on_failure.halvings == FailureOptions::automatic &&
                std::ranges::count(is_explicit_, true) > 0;
    allocate(setup.hierarchy);
  }

  bool lost_stability(const Hierarchy<B>& h, double kinetic) override {
    constexpr double much = 16;
    if (!shortens_) return false;
    const bool grew = kinetic > much * calm_;
    calm_ = grew ? kinetic : std::min(calm_, kinetic);
    for (int i = 0; grew && i < h.count(); ++i) {
      const Level<B>& level = h[i];
      const double most = most_at(h, i, halvings_);
      if (most > 0 &&
          excited_eigenvalue<B>(h.exec(), stiffness_at(level, most), level.state.v) > most * most)
        return true;
    }
    return false;
  }
  bool detects_late() const override { return true; }
  bool can_repair() const override { return shortens_; }
  bool repairs(const Diagnosis& bad) const override { return shortens_ && bad.kind != "solver"; }

  bool repair(Hierarchy<B>&, double) override {
    if (halvings_ == most_halvings) return false;
    ++halvings_, ++cuts_;
    regaining_.cut();
    return true;
  }
  void regrow(Hierarchy<B>& h, double, long steps) override {
    if (halvings_ == 0 || !regaining_.due(steps)) return;
    const int before = halvings_;
    while (halvings_ > 0 && is_stable(h, halvings_ - 1)) --halvings_;
    regaining_.tried(steps, halvings_ < before);
  }
  int parts() const override { return 1 << halvings_; }

  std::map<std::string, long> counters() const override {
    if (!shortens_) return {};
    return {{"substep_halvings", cuts_}, {"substeps_regained", regaining_.count()}};
  }

  void name_fields(Archive<B>& archive) override {
    if (!shortens_) return;
    archive.number(halvings_), archive.number(cuts_), archive.number(calm_);
    regaining_.name_fields(archive);
  }

 protected:
  /// Allocates the fields that this cycle keeps on the levels.
  virtual void allocate(Hierarchy<B>& hierarchy) = 0;

  /// Sets given motions on all levels to the same time [s], before any state is mapped.
  static void prescribe_levels(Hierarchy<B>& h, double time) {
    for (Level<B>& level : h.levels) prescribe(h.exec(), level, level.state, time);
  }

  /// Integrates level i over its share of a macro step of t [s], from `time` [s].
  /// Returns the time at the end [s].
  double integrate(Hierarchy<B>& h, int i, double time, double t) const {
    Level<B>& level = h[i];
    const double span = level.share * t;
    level.timed("integrate", [&] {
      prescribe(h.exec(), level, level.state, time);
      if (h.count() > 1) level.integrator->reset_history();  // other levels have changed the state
      const int substeps =
          level.substeps * (is_explicit_[static_cast<std::size_t>(i)] ? parts() : 1);
      level.integrator->advance(level, time, span / substeps, substeps);
    });
    return time + span;
  }

 private:
  static constexpr int most_halvings = 5;
  std::vector<bool> is_explicit_;  ///< [levels]
  std::vector<double> radius_;     ///< [levels] see StabilityLimit; 0: implicit
  double macro_step_ = 0;
  double safety_ = 0;
  bool shortens_ = false;
  int halvings_ = 0;
  long cuts_ = 0;
  RegrowSchedule regaining_;
  double calm_ = 0;  ///< reference that kinetic energy is compared with [J]

  /// Returns the largest stable angular frequency on level i with `halvings` [1/s]; 0: no limit.
  double most_at(const Hierarchy<B>& h, int i, int halvings) const {
    const Level<B>& level = h[i];
    return radius_[static_cast<std::size_t>(i)] * level.substeps * (1 << halvings) /
           (level.share * macro_step_);
  }

  static StiffnessAt<B> stiffness_at(const Level<B>& level, double over) {
    return {level, level.elasticity(), level.state.u, over};
  }

  /// Returns true where all levels in their present states are below their limits with `halvings`.
  /// The room below a limit must be at least half of that at rest.
  bool is_stable(const Hierarchy<B>& h, int halvings) const {
    for (int i = 0; i < h.count(); ++i) {
      const double most = most_at(h, i, halvings), enough = (1 + safety_) / 2 * most;
      if (most > 0 && largest_eigenvalue<B>(h.exec(), stiffness_at(h[i], most)) > enough * enough)
        return false;
    }
    return true;
  }
};

}  // namespace plica
