// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/solver/integrators/integrator.hpp>
#include <plica/kernels/explicit/updates.hpp>
#include <plica/kernels/motion/prescribe.hpp>

namespace plica {

/// Forward Euler: first order. |1 + h s|^2 = 1 - h c + h^2 w^2: an undamped mode grows at every step, one with mass damping
/// c is stable for h < c / w^2 and h < 2 / c.
struct ForwardEuler {
  static constexpr const char* name = "euler";
  static constexpr const char* summary = "explicit, order 1; undamped it grows at every step";
  static constexpr bool is_explicit = true;
  static constexpr StabilityLimit limit{.growth = 1, .power = 2, .damping = 2};

  template <class B>
  class Step final : public Integrator<B> {
   public:
    Step(const Level<B>&, const IntegratorParts<B>&) {}

    void advance(const typename B::Exec& exec, Level<B>& level, LevelForces<B>& forces, double time, double h,
                 int steps) override {
      using Real = typename B::Real;
      const ForwardEulerUpdate<B> update{level.model, level.f, level.state.u, level.state.v, static_cast<Real>(h)};
      for (int s = 0; s < steps; ++s) {
        forces.evaluate(level, level.state, time + s * h, level.f);
        update_vertices<B>(exec, "plica::euler", level.model.vertices, update);
        prescribe(exec, level, level.state, time + (s + 1) * h);
      }
    }
  };
};

}  // namespace plica
