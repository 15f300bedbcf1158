// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/solver/integrators/implicit_step.hpp>
#include <plica/drivers/solver/integrators/trapezoidal_base.hpp>

namespace plica {

/// Newmark's method with beta = 1/4, gamma = 1/2: the trapezoidal rule, half a step of forward Euler, then half a step of
/// backward Euler. Order 2; on the linear problem stable at every step (A-stable) and without loss of energy, so that motion
/// too fast for the step rings on; with large strains energy wavers and may grow (Hughes, The Finite Element Method, 9.1), and
/// with one Newton iteration per step it is lost.
struct Newmark {
  static constexpr const char* name = "newmark";
  static constexpr const char* summary = "implicit, order 2 (trapezoidal), keeps the energy of linear motion; no limit";
  static constexpr bool is_explicit = false;
  static constexpr StabilityLimit limit{};
  static constexpr bool conserves(const ImplicitOptions&) { return true; }

  template <class B>
  class Step final : public ImplicitStep<B> {
   public:
    using ImplicitStep<B>::ImplicitStep;

   protected:
    bool step(const typename B::Exec& exec, Level<B>& level, LevelForces<B>& forces, double time, double h) override {
      trapezoidal_base(exec, level, forces, time, h, this->stages().base());
      return this->stages().solve(exec, level, forces, time, h, {h * h / 4, h / 2});
    }
  };
};

}  // namespace plica
