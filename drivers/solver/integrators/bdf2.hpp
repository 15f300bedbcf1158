// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/solver/integrators/implicit_step.hpp>
#include <plica/drivers/solver/integrators/trapezoidal_base.hpp>

namespace plica {

/// The backward differentiation formula v = (4 v_n - v_{n-1})/3 + 2h/3 a, likewise u: order 2, stable at every step on the
/// linear problem, and fast motion decays (L-stable); slow motion loses energy in proportion to h^4 (Hairer & Wanner, Solving
/// ODEs II, V.1). Where there is no step before it, and so on every level of a cycle, which hands over another state: half a
/// step of the trapezoidal rule, then the formula over the two halves (Bank et al. 1985), as stable and as accurate.
struct Bdf2 {
  static constexpr const char* name = "bdf2";
  static constexpr const char* summary = "implicit, order 2, little dissipation but of fast motion; no limit";
  static constexpr bool is_explicit = false;
  static constexpr StabilityLimit limit{};

  template <class B>
  class Step final : public ImplicitStep<B> {
    using Real = typename B::Real;

   public:
    Step(const Level<B>& level, const IntegratorParts<B>& parts)
        : ImplicitStep<B>(level, parts),
          start_("bdf2.start", level.model.vertices),
          increment_("bdf2.increment", level.model.vertices) {}

    void forget() override { last_step_ = 0; }
    std::size_t bytes() const override { return ImplicitStep<B>::bytes() + 4 * start_.u.span() * sizeof(Real); }
    void persist(StateArchive<B>& archive) override {
      ImplicitStep<B>::persist(archive);
      archive.number(last_step_);
      archive.state("bdf2's increment", increment_);
    }

   protected:
    bool step(const typename B::Exec& exec, Level<B>& level, LevelForces<B>& forces, double time, double h) override {
      start_.copy(exec, level.state);
      const bool solved =
          last_step_ == h ? formula(exec, level, forces, time, h) : first(exec, level, forces, time, h / 2);
      remember(exec, level);
      last_step_ = h;
      return solved;
    }

   private:
    State<B> start_, increment_;
    double last_step_ = 0;  // [s]; 0: none

    bool formula(const typename B::Exec& exec, Level<B>& level, LevelForces<B>& forces, double time, double h) {
      const double b = 2 * h / 3;
      const State<B>& base = this->stages().base();
      update_vertices<B>(exec, "plica::bdf2_base", level.model.vertices,
                         AddIncrements<B>{level.state, increment_, base, Real(1) / 3});
      update_vertices<B>(exec, "plica::bdf2_drift", level.model.vertices, DriftBase<B>{base, static_cast<Real>(b)});
      return this->stages().solve(exec, level, forces, time, h, {b * b, b});
    }
    bool first(const typename B::Exec& exec, Level<B>& level, LevelForces<B>& forces, double time, double h) {
      trapezoidal_base(exec, level, forces, time, h, this->stages().base());
      const bool solved = this->stages().solve(exec, level, forces, time, h, {h * h / 4, h / 2});
      remember(exec, level);
      prescribe(exec, level, level.state, time + h, h);
      return formula(exec, level, forces, time + h, h) && solved;
    }
    void remember(const typename B::Exec& exec, const Level<B>& level) const {
      update_vertices<B>(exec, "plica::bdf2_increment", level.model.vertices,
                         AddIncrements<B>{level.state, start_, increment_, Real(-1)});
    }
  };
};

}  // namespace plica
