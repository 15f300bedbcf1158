// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/solver/integrators/implicit_step.hpp>
#include <plica/kernels/implicit/bases.hpp>

namespace plica {

/// Backward Euler: order 1, dissipative at every step, no stability limit on the linear problem (L-stable).
struct ImplicitEuler {
  static constexpr const char* name = "implicit_euler";
  static constexpr const char* summary = "implicit, order 1, dissipative; no limit";
  static constexpr bool is_explicit = false;
  static constexpr StabilityLimit limit{};

  template <class B>
  class Step final : public ImplicitStep<B> {
   public:
    using ImplicitStep<B>::ImplicitStep;

   protected:
    bool step(const typename B::Exec& exec, Level<B>& level, LevelForces<B>& forces, double time, double h) override {
      const State<B>& base = this->stages().base();
      base.copy(exec, level.state);
      update_vertices<B>(exec, "plica::implicit_euler_base", level.model.vertices,
                         DriftBase<B>{base, static_cast<typename B::Real>(h)});
      return this->stages().solve(exec, level, forces, time, h, {h * h, h});
    }
  };
};

}  // namespace plica
