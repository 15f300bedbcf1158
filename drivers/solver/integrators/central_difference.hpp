// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/solver/integrators/integrator.hpp>
#include <plica/kernels/explicit/updates.hpp>
#include <plica/kernels/motion/prescribe.hpp>

namespace plica {

/// The central difference method, u_{n+1} - 2 u_n + u_{n-1} = h^2 a_n with v_n = (u_{n+1} - u_{n-1})/2h, as total Lagrangian
/// explicit dynamics has it (Miller et al. 2007), in displacement and velocity: half a kick, a drift, a force, half a kick. Order 2,
/// symplectic: the energy of undamped motion wavers and does not drift; one force per step, which the next begins with unless
/// the state, or what acts on it, has been changed since. Stable for h < 2/w, with any mass damping, which it takes
/// at v_n.
struct CentralDifference {
  static constexpr const char* name = "central_difference";
  static constexpr const char* summary = "explicit, order 2, symplectic; h < 2/w";
  static constexpr bool is_explicit = true;
  static constexpr StabilityLimit limit{.radius = 2};

  template <class B>
  class Step final : public Integrator<B> {
    using Real = typename B::Real;

   public:
    Step(const Level<B>& level, const IntegratorParts<B>&) : f_("plica::central_difference.f", level.model.vertices) {}

    void advance(const typename B::Exec& exec, Level<B>& level, LevelForces<B>& forces, double time, double h,
                 int steps) override {
      const int n = level.model.vertices;
      const auto half = static_cast<Real>(h / 2);
      if (!current_ || forces.asks_caller()) forces.evaluate(level, level.state, time, f_);
      current_ = true;
      for (int s = 0; s < steps; ++s) {
        update_vertices<B>(exec, "plica::kick_and_drift", n, HalfKickAndDrift<B>{level.model, f_, level.state, half});
        prescribe(exec, level, level.state, time + (s + 1) * h);
        forces.evaluate(level, level.state, time + (s + 1) * h, f_);
        update_vertices<B>(exec, "plica::kick", n, HalfKick<B>{level.model, f_, level.state.v, half});
      }
    }

    void forget() override { current_ = false; }
    std::size_t bytes() const override { return f_.span() * sizeof(Real); }
    void persist(StateArchive<B>& archive) override {
      archive.number(current_);
      archive.field("the central difference's force", f_);
    }

   private:
    Vectors<B> f_;          // at the state
    bool current_ = false;  // whether it is
  };
};

}  // namespace plica
