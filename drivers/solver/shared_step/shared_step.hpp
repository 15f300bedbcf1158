// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/solver/set_up/plan_steps.hpp>
#include <plica/drivers/solver/stepper.hpp>

namespace plica {

/// What the paper's cycles have in common: the macro step is shared out among the levels, and each integrates its share.
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
    }
    allocate(setup.hierarchy);
  }

 protected:
  /// Fields that this cycle keeps on the levels, and no others.
  virtual void allocate(Hierarchy<B>& hierarchy) = 0;

  /// Where motions are given, all levels are at the same time before any of them is looked at.
  static void prescribe_levels(Hierarchy<B>& h, double time) {
    for (SolverLevel<B>& level : h.levels) prescribe(h.exec(), level, level.state, time);
  }

  /// Level i's own part of a macro step of t [s], from `time` [s]; returns the time it ends at.
  static double integrate(Hierarchy<B>& h, int i, double time, double t) {
    SolverLevel<B>& level = h[i];
    const double span = level.share * t;
    level.book("integrate", [&] {
      prescribe(h.exec(), level, level.state, time);
      if (h.count() > 1) level.integrator->forget();  // other levels have changed the state
      level.integrator->advance(level, time, span / level.substeps, level.substeps);
    });
    return time + span;
  }
};

}  // namespace plica
