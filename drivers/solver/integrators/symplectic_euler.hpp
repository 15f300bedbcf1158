// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/solver/integrators/integrator.hpp>
#include <plica/kernels/explicit/updates.hpp>
#include <plica/kernels/motion/prescribe.hpp>

namespace plica {

/// Semi-implicit Euler: first order, symplectic, one force per step; stable for h < 2/w.
struct SymplecticEuler {
  static constexpr const char* name = "symplectic_euler";
  static constexpr const char* summary = "explicit, order 1, symplectic; h < 2/w";
  static constexpr bool is_explicit = true;
  static constexpr StabilityLimit limit{.radius = 2};

  template <class B>
  class Step final : public Integrator<B> {
   public:
    Step(const Level<B>&, const IntegratorParts<B>&) {}

    void advance(const typename B::Exec& exec, Level<B>& level, LevelForces<B>& forces, double time, double h,
                 int steps) override {
      using Real = typename B::Real;
      const SymplecticEulerUpdate<B> update{level.model, level.f, level.state.u, level.state.v, static_cast<Real>(h)};
      for (int s = 0; s < steps; ++s) {
        forces.evaluate(level, level.state, time + s * h, level.f);
        update_vertices<B>(exec, "plica::symplectic_euler", level.model.vertices, update);
        prescribe(exec, level, level.state, time + (s + 1) * h);
      }
    }
  };
};

}  // namespace plica
