// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <plica/drivers/solver/set_up/plan_steps.hpp>
#include <plica/drivers/solver/stepper.hpp>

namespace plica {

/// What the paper's cycles have in common: the macro step is shared out among the levels, and each integrates its share.
///
/// The limit of an explicit level is that of its state at rest. A body that is pressed or struck stiffens, and has a shorter one. So where the
/// number of sub-steps was left to the plan, repair() cuts the explicit levels' sub-steps in half, for good.
template <class B>
class SharedStep : public Stepper<B> {
 public:
  /// Shares, sub-steps and the macro step, see plan_steps(); then what the cycle itself needs.
  void plan(StepperSetup<B>& setup) override {
    std::vector<LevelLimits> limits;
    for (const LevelReport& r : setup.reports)
      limits.push_back(
          {r.tets, r.integrator, r.explicit_integrator, r.critical_step, r.stiffest.front(), r.typical_element});
    const StepPlan steps = plan_steps(setup.problem.integration, limits);
    setup.macro_step = steps.macro_step;
    for (int i = 0; i < setup.hierarchy.count(); ++i) {
      const auto k = static_cast<std::size_t>(i);
      setup.hierarchy[i].share = setup.reports[k].share = steps.share[k];
      setup.hierarchy[i].substeps = setup.reports[k].substeps = steps.substeps[k];
      is_explicit_.push_back(setup.reports[k].explicit_integrator);
    }
    const IntegrationOptions& o = setup.problem.integration;
    const bool is_automatic = std::ranges::all_of(o.substeps, [](int n) { return n == 0; });
    shortens_ =
        is_automatic && !o.allow_unstable && o.retry.halvings == 0 && std::ranges::count(is_explicit_, true) > 0;
    allocate(setup.hierarchy);
  }

  bool can_repair() const override { return shortens_; }
  bool repairs(const Diagnosis& bad) const override { return shortens_ && bad.kind != "solver"; }

  bool repair(Hierarchy<B>&, double) override {
    if (halvings_ == most_halvings) return false;
    ++halvings_;
    return true;
  }
  int parts() const override { return 1 << halvings_; }

  std::map<std::string, long> counters() const override {
    if (!shortens_) return {};
    return {{"substep_halvings", halvings_}};
  }

  void persist(StateArchive<B>& archive) override {
    if (shortens_) archive.number(halvings_);
  }

 protected:
  /// Fields that this cycle keeps on the levels, and no others.
  virtual void allocate(Hierarchy<B>& hierarchy) = 0;

  /// Where motions are given, all levels are at the same time before any of them is looked at.
  static void prescribe_levels(Hierarchy<B>& h, double time) {
    for (SolverLevel<B>& level : h.levels) prescribe(h.exec(), level, level.state, time);
  }

  /// Level i's own part of a macro step of t [s], from `time` [s]; returns the time it ends at.
  double integrate(Hierarchy<B>& h, int i, double time, double t) const {
    SolverLevel<B>& level = h[i];
    const double span = level.share * t;
    level.book("integrate", [&] {
      prescribe(h.exec(), level, level.state, time);
      if (h.count() > 1) level.integrator->forget();  // other levels have changed the state
      const int substeps = level.substeps * (is_explicit_[static_cast<std::size_t>(i)] ? parts() : 1);
      level.integrator->advance(level, time, span / substeps, substeps);
    });
    return time + span;
  }

 private:
  static constexpr int most_halvings = 5;
  std::vector<bool> is_explicit_;  ///< of the levels
  bool shortens_ = false;
  int halvings_ = 0;
};

}  // namespace plica
