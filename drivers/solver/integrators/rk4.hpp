// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/solver/integrators/integrator.hpp>
#include <plica/kernels/explicit/updates.hpp>
#include <plica/kernels/motion/prescribe.hpp>

namespace plica {

/// The classical Runge-Kutta method: order 4, four forces per step; stable for h < 2.83/w undamped. The radius 2.78 is that
/// of the largest half disc in its stability region, so that it holds with any damping (Hairer & Wanner II, IV.2).
struct Rk4 {
  static constexpr const char* name = "rk4";
  static constexpr const char* summary = "explicit, order 4, four forces a step; h < 2.78/w";
  static constexpr bool is_explicit = true;
  static constexpr StabilityLimit limit{2.78, false, 2.78};

  template <class B>
  class Step final : public Integrator<B> {
   public:
    Step(const Level<B>& level, const IntegratorParts<B>& parts)
        : damping_(parts.mass_damping),
          start_("rk4.start", level.model.vertices),
          stage_("rk4.stage", level.model.vertices),
          sum_("rk4.sum", level.model.vertices) {}

    void advance(const typename B::Exec& exec, Level<B>& level, LevelForces<B>& forces, double time, double h,
                 int steps) override {
      using Real = typename B::Real;
      constexpr double weight[4] = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6}, ahead[4] = {0.5, 0.5, 1, 0},
                       at[4] = {0, 0.5, 0.5, 1};
      for (int s = 0; s < steps; ++s) {
        start_.copy(exec, level.state);
        stage_.copy(exec, level.state);
        sum_.copy(exec, level.state);
        for (int k = 0; k < 4; ++k) {
          forces.evaluate(level, stage_, time + (s + at[k]) * h, level.f);
          update_vertices<B>(exec, "plica::rk4", level.model.vertices,
                             RungeKuttaStage<B>{level.model.inverse_mass, level.f, start_, stage_, sum_,
                                                static_cast<Real>(h), static_cast<Real>(damping_),
                                                static_cast<Real>(weight[k]), static_cast<Real>(ahead[k])});
          if (k < 3) prescribe(exec, level, stage_, time + (s + at[k + 1]) * h);
        }
        level.state.copy(exec, sum_);
        prescribe(exec, level, level.state, time + (s + 1) * h);
      }
    }

    std::size_t bytes() const override { return 3 * 6 * sizeof(typename B::Real) * start_.u.extent(0); }

   private:
    double damping_;
    State<B> start_, stage_, sum_;
  };
};

}  // namespace plica
