// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/solver/integrators/implicit_step.hpp>
#include <plica/kernels/implicit/bases.hpp>

namespace plica {

/// The generalised alpha method of Chung & Hulbert (1993): order 2, stable at every step on the linear problem, and the fastest
/// motion keeps rho_infinity of its amplitude per step: 1 conserves (the implicit midpoint rule), 0 annihilates. Balance is met at
/// t + (1 - alpha_f) h with the acceleration alpha_m a_n + (1 - alpha_m) a_{n+1}. It carries an acceleration from step to step; where
/// a cycle hands over another state, that is the acceleration there.
struct GeneralizedAlpha {
  static constexpr const char* name = "generalized_alpha";
  static constexpr const char* summary =
      "implicit, order 2, damps fast motion by integration.implicit.rho_infinity; no limit";
  static constexpr bool is_explicit = false;
  static constexpr StabilityLimit limit{};
  static constexpr bool conserves(const ImplicitOptions& options) { return options.rho_infinity == 1; }

  template <class B>
  class Step final : public ImplicitStep<B> {
    using Real = typename B::Real;

   public:
    Step(const Level<B>& level, const IntegratorParts<B>& parts)
        : ImplicitStep<B>(level, parts),
          start_("generalized_alpha.start", level.model.vertices),
          acceleration_("plica::generalized_alpha.acceleration", level.model.vertices) {
      const double rho = parts.implicit.rho_infinity;
      mass_ = (2 * rho - 1) / (rho + 1), force_ = rho / (rho + 1);
      gamma_ = 0.5 - mass_ + force_, beta_ = 0.25 * (1 - mass_ + force_) * (1 - mass_ + force_);
    }

    void forget() override { carried_ = false; }
    std::size_t bytes() const override { return ImplicitStep<B>::bytes() + 3 * start_.u.span() * sizeof(Real); }
    void persist(StateArchive<B>& archive) override {
      ImplicitStep<B>::persist(archive);
      archive.number(carried_);
      archive.field("the acceleration", acceleration_);
    }

   protected:
    bool step(const typename B::Exec& exec, Level<B>& level, LevelForces<B>& forces, double time, double h) override {
      const int n = level.model.vertices;
      const State<B>& base = this->stages().base();
      if (!carried_) {
        forces.evaluate(level, level.state, time, level.f);
        update_vertices<B>(exec, "plica::accelerations", n,
                           Accelerations<B>{level.model, level.f, level.state.v, acceleration_});
      }
      carried_ = true;
      start_.copy(exec, level.state);
      // u = u~ + cu A and v = v~ + cv A at the stage, A = alpha_m a_n + (1 - alpha_m) a_{n+1}
      const double span = (1 - force_) * h, cu = span * h * beta_ / (1 - mass_), cv = span * gamma_ / (1 - mass_);
      update_vertices<B>(exec, "plica::generalized_alpha_base", n,
                         ExtrapolateState<B>{start_, acceleration_, base, static_cast<Real>(span),
                                             static_cast<Real>(span * h * (0.5 - beta_) - cu * mass_),
                                             static_cast<Real>(span * (1 - gamma_) - cv * mass_)});
      const bool solved = this->stages().solve(exec, level, forces, time, span, {cu, cv});
      update_vertices<B>(
          exec, "plica::generalized_alpha_end", n,
          GeneralizedAlphaEnd<B>{start_, base, level.state, acceleration_, static_cast<Real>(h), static_cast<Real>(cv),
                                 static_cast<Real>(mass_), static_cast<Real>(beta_), static_cast<Real>(gamma_)});
      return solved;
    }

   private:
    State<B> start_;
    Vectors<B> acceleration_;
    bool carried_ = false;
    double mass_, force_, beta_, gamma_;  // alpha_m, alpha_f, Newmark's
  };
};

}  // namespace plica
