// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/solver/integrators/integrator.hpp>
#include <plica/kernels/explicit/updates.hpp>
#include <plica/kernels/motion/prescribe.hpp>

namespace plica {

/// Explicit Runge-Kutta methods whose stages each start from the one before. A tableau has
///   stages, weight[stages]   how much of each stage's slope the step takes
///   ahead[stages - 1]        where the next stage is: at start + ahead h slope, and at that part of the step
template <class B, class Tableau>
class RungeKutta : public Integrator<B> {
  using Real = typename B::Real;

 public:
  RungeKutta(const Level<B>& level, const IntegratorParts<B>&)
      : start_("runge_kutta.start", level.model.vertices),
        stage_("runge_kutta.stage", level.model.vertices),
        sum_("runge_kutta.sum", level.model.vertices) {}

  void advance(const typename B::Exec& exec, Level<B>& level, LevelForces<B>& forces, double time, double h,
               int steps) override {
    for (int s = 0; s < steps; ++s) {
      start_.copy(exec, level.state);
      stage_.copy(exec, level.state);
      sum_.copy(exec, level.state);
      double at = 0;
      for (int k = 0; k < Tableau::stages; ++k) {
        const bool last = k + 1 == Tableau::stages;
        const double ahead = last ? 0 : Tableau::ahead[k];
        forces.evaluate(level, stage_, time + (s + at) * h, level.f);
        update_vertices<B>(exec, "plica::runge_kutta", level.model.vertices,
                           RungeKuttaStage<B>{level.model, level.f, start_, stage_, sum_, static_cast<Real>(h),
                                              static_cast<Real>(Tableau::weight[k]), static_cast<Real>(ahead)});
        at = ahead;
        if (!last) prescribe(exec, level, stage_, time + (s + at) * h);
      }
      level.state.copy(exec, sum_);
      prescribe(exec, level, level.state, time + (s + 1) * h);
    }
  }

  std::size_t bytes() const override { return 3 * 6 * sizeof(Real) * start_.u.extent(0); }

 private:
  State<B> start_, stage_, sum_;
};

}  // namespace plica
