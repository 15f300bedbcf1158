// SPDX-License-Identifier: BSD-3-Clause
// The implicit integrators. Each sets the base (u~, v~) of a stage, which the stage solver then
// solves (stage_solver.hpp); what becomes of a step that is not solved, ImplicitStep says.
#include <plica/drivers/time/implicit_step.hpp>
#include <plica/kernels/time/stage_kernels.hpp>

namespace plica {

namespace {

/// Base of backward Euler over h [s].
template <class B>
void backward_euler_base(const SolverLevel<B>& level, double h, const State<B>& base) {
  base.copy(level.exec(), level.state);
  add<B>(level.exec(), "plica::implicit_euler_base", static_cast<typename B::Real>(h), base.v,
         base.u);
}

/// Backward Euler: order 1, dissipative at every step, no stability limit on the linear problem
/// (L-stable).
///
/// With the linear solver v_cycle, the system A = M + h^2 K is answered by exactly one V-cycle C of
/// multigrid over the body's meshes. On the linear problem, with C A in (0, 1], motion against k =
/// h^2 C K < 1 has |eigenvalue|^2 = 1 - k: no limit on the step. What the cycle does not resolve
/// moves as if it were heavier. Of a body that stiffens, C stays behind until it is fitted again.
template <class B>
class ImplicitEulerStep final : public ImplicitStep<B> {
 public:
  using ImplicitStep<B>::ImplicitStep;

 protected:
  bool step(SolverLevel<B>& level, double time, double h) override {
    backward_euler_base(level, h, this->stages().base());
    return this->stages().solve(level, time, h, {h * h, h}, {.span = h});
  }
};

/// Base of the trapezoidal rule over h [s] from the level's state at `time`: half a step of forward
/// Euler, and the drift of the implicit half. Contact is no part of it: it acts at the end of a
/// step (C. Kane, E. A. Repetto, M. Ortiz, J. E. Marsden, Comput. Methods Appl. Mech. Engrg. 180,
/// 1999), and averaged over a step it would gain energy. Uses level.f.
template <class B>
void trapezoidal_base(SolverLevel<B>& level, double time, double h, const State<B>& base) {
  using Real = typename B::Real;
  level.evaluate_without_contact(level.state, time, level.f);
  update_vertices<B>(level.exec(), "plica::accelerations", level.model.vertices,
                     Accelerations<B>{level.model, level.f, level.state.v, level.f});
  update_vertices<B>(level.exec(), "plica::trapezoidal_base", level.model.vertices,
                     ExtrapolateState<B>{level.state, level.f, base, static_cast<Real>(h),
                                         static_cast<Real>(h * h / 4), static_cast<Real>(h / 2)});
}

/// Newmark's method with beta = 1/4, gamma = 1/2: the trapezoidal rule, half a step of forward
/// Euler, then half a step of backward Euler. Order 2; on the linear problem stable at every step
/// (A-stable) and without loss of energy, so that motion too fast for the step rings on; with large
/// strains energy wavers and may grow (Hughes, The Finite Element Method, 9.1), and with one Newton
/// iteration per step it is lost.
template <class B>
class NewmarkStep final : public ImplicitStep<B> {
 public:
  using ImplicitStep<B>::ImplicitStep;

 protected:
  bool step(SolverLevel<B>& level, double time, double h) override {
    trapezoidal_base(level, time, h, this->stages().base());
    return this->stages().solve(level, time, h, {h * h / 4, h / 2}, {.span = h, .factor = 2});
  }
};

/// The backward differentiation formula of a step that is w times the last one,
///
///   v = v_n + w^2/(1 + 2w) (v_n - v_{n-1}) + b a,  b = h (1 + w)/(1 + 2w),  likewise u:
///
/// order 2, stable at every constant step on the linear problem, and fast motion decays (L-stable);
/// slow motion loses energy in proportion to h^4 (Hairer & Wanner, Solving ODEs II, V.1; of steps
/// that change: Solving ODEs I, III.5, stable for w < 1 + sqrt 2). Where there is no step before
/// it, and so on every level of a cycle, which hands over another state: half a step of the
/// trapezoidal rule, then the formula over the two halves (Bank et al. 1985), as stable and as
/// accurate; with contact, backward Euler.
template <class B>
class Bdf2Step final : public ImplicitStep<B> {
  using Real = typename B::Real;

 public:
  Bdf2Step(const Level<B>& level, const IntegratorParts<B>& parts)
      : ImplicitStep<B>(level, parts),
        start_("bdf2.start", level.model.vertices),
        increment_("bdf2.increment", level.model.vertices) {}

  void forget() override { last_step_ = 0; }
  std::size_t bytes() const override {
    return ImplicitStep<B>::bytes() + 4 * start_.u.span() * sizeof(Real);
  }
  void persist(StateArchive<B>& archive) override {
    ImplicitStep<B>::persist(archive);
    archive.number(last_step_);
    archive.state("bdf2's increment", increment_);
  }

 protected:
  bool step(SolverLevel<B>& level, double time, double h) override {
    constexpr double most_growth = 2.0 + 1e-9;  // of a step
    start_.copy(level.exec(), level.state);
    const double growth = last_step_ > 0 ? h / last_step_ : 0;
    ratio_ = growth <= most_growth ? growth : 0;
    return ratio_ > 0        ? formula(level, time, h, ratio_, {.span = h})
           : level.contact() ? euler(level, time, h)
                             : first(level, time, h / 2);
  }
  void finish(SolverLevel<B>& level, double h) override {
    remember(level);
    last_step_ = h;
  }
  /// A part of the last change of momentum is carried on.
  CarriedImpulse impulse(double h) const override {
    return ratio_ > 0 ? CarriedImpulse{implicit_part(ratio_) * h, carried_part(ratio_)}
                      : CarriedImpulse{h};
  }

 private:
  State<B> start_, increment_;
  double last_step_ = 0;  // [s]; 0: none
  double ratio_ = 0;      // of the last step to the one before it; 0: not by the formula

  static double carried_part(double ratio) { return ratio * ratio / (1 + 2 * ratio); }
  static double implicit_part(double ratio) { return (1 + ratio) / (1 + 2 * ratio); }

  bool formula(SolverLevel<B>& level, double time, double h, double ratio,
               const ContactStage& contact = {}) {
    const double b = implicit_part(ratio) * h;
    const State<B>& base = this->stages().base();
    combine<B>(level.exec(), "plica::bdf2_base", static_cast<Real>(carried_part(ratio)), increment_,
               1, level.state, base);
    add<B>(level.exec(), "plica::bdf2_drift", static_cast<Real>(b), base.v, base.u);
    return this->stages().solve(level, time, h, {b * b, b}, contact);
  }
  /// Backward Euler: where contact sets in the trapezoidal rule rings.
  bool euler(SolverLevel<B>& level, double time, double h) {
    backward_euler_base(level, h, this->stages().base());
    return this->stages().solve(level, time, h, {h * h, h}, {.span = h});
  }
  bool first(SolverLevel<B>& level, double time, double h) {
    trapezoidal_base(level, time, h, this->stages().base());
    const bool solved = this->stages().solve(level, time, h, {h * h / 4, h / 2});
    last_step_ = 0, remember(level);  // of the half, also where the step is not accepted
    prescribe(level.exec(), level, level.state, time + h, h);
    return formula(level, time + h, h, 1) && solved;
  }
  void remember(const SolverLevel<B>& level) const {
    combine<B>(level.exec(), "plica::bdf2_increment", -1, start_, 1, level.state, increment_);
  }
};

/// The generalised alpha method of Chung & Hulbert (1993): order 2, stable at every step on the
/// linear problem, and the fastest motion keeps rho_infinity of its amplitude per step: 1 conserves
/// (the implicit midpoint rule), 0 annihilates. Balance is met at t + (1 - alpha_f) h with the
/// acceleration alpha_m a_n + (1 - alpha_m) a_{n+1}. It carries an acceleration from step to step;
/// where a cycle hands over another state, that is the acceleration there.
template <class B>
class GeneralizedAlphaStep final : public ImplicitStep<B> {
  using Real = typename B::Real;

 public:
  GeneralizedAlphaStep(const Level<B>& level, const IntegratorParts<B>& parts)
      : ImplicitStep<B>(level, parts),
        start_("generalized_alpha.start", level.model.vertices),
        acceleration_("plica::generalized_alpha.acceleration", level.model.vertices) {
    const double rho = parts.implicit.rho_infinity.value();
    mass_ = (2 * rho - 1) / (rho + 1), force_ = rho / (rho + 1);
    gamma_ = 0.5 - mass_ + force_, beta_ = 0.25 * (1 - mass_ + force_) * (1 - mass_ + force_);
  }

  void forget() override { carried_ = false; }
  std::size_t bytes() const override {
    return ImplicitStep<B>::bytes() + 3 * start_.u.span() * sizeof(Real);
  }
  void persist(StateArchive<B>& archive) override {
    ImplicitStep<B>::persist(archive);
    archive.number(carried_);
    archive.field("the acceleration", acceleration_);
  }

 protected:
  bool step(SolverLevel<B>& level, double time, double h) override {
    const auto& exec = level.exec();
    const int n = level.model.vertices;
    const State<B>& base = this->stages().base();
    started_ = carried_;
    if (!carried_) {
      level.evaluate_without_contact(level.state, time, level.f);
      update_vertices<B>(exec, "plica::accelerations", n,
                         Accelerations<B>{level.model, level.f, level.state.v, acceleration_});
    }
    start_.copy(exec, level.state);
    // u = u~ + cu A and v = v~ + cv A at the stage, A = alpha_m a_n + (1 - alpha_m) a_{n+1}
    const double span = (1 - force_) * h, cu = span * h * beta_ / (1 - mass_),
                 cv = span * gamma_ / (1 - mass_);
    update_vertices<B>(exec, "plica::generalized_alpha_base", n,
                       ExtrapolateState<B>{start_, acceleration_, base, static_cast<Real>(span),
                                           static_cast<Real>(span * h * (0.5 - beta_) - cu * mass_),
                                           static_cast<Real>(span * (1 - gamma_) - cv * mass_)});
    velocity_of_ = cv;
    return this->stages().solve(level, time, span, {cu, cv},
                                {.span = h, .scale = 1 / (1 - force_)});
  }

  /// Contact's part A of m a goes on as a does, from 0 where no step was before: alpha_m A_n + (1 -
  /// alpha_m) A_{n+1} = F, and the impulse is h ((1 - gamma) A_n + gamma A_{n+1}).
  CarriedImpulse impulse(double h) const override {
    const double again = started_ ? -mass_ / (1 - mass_) : 0;
    return {1 / (1 - mass_), again, gamma_ * h, started_ ? (1 - gamma_) * h : 0};
  }

  void finish(SolverLevel<B>& level, double h) override {
    carried_ = true;
    update_vertices<B>(
        level.exec(), "plica::generalized_alpha_end", level.model.vertices,
        GeneralizedAlphaEnd<B>{start_, this->stages().base(), level.state, acceleration_,
                               static_cast<Real>(h), static_cast<Real>(velocity_of_),
                               static_cast<Real>(mass_), static_cast<Real>(beta_),
                               static_cast<Real>(gamma_)});
  }

 private:
  State<B> start_;
  Vectors<B> acceleration_;
  bool carried_ = false, started_ = false;  // started_: the last step had one before it
  double mass_, force_, beta_, gamma_;      // alpha_m, alpha_f, Newmark's
  double velocity_of_ = 0;                  // of an acceleration in the last stage [s]
};

/// A singly diagonally implicit Runge-Kutta method of two stages (R. Alexander, SIAM J. Numer.
/// Anal. 14, 1977), c = 1 - 1/sqrt 2:
///
///   v_1 = v_n + c h a_1,  v_{n+1} = v_n + (1 - c) h a_1 + c h a_2,  likewise u:
///
/// order 2, stable at every step on the linear problem, and fast motion decays (L-stable); it needs
/// no step before. Both stages have one system. Contact is met in both, and acts on the step at its
/// end alone, as in Newmark's method: a_1 is without it.
template <class B>
class Sdirk2Step final : public ImplicitStep<B> {
  using Real = typename B::Real;

 public:
  Sdirk2Step(const Level<B>& level, const IntegratorParts<B>& parts)
      : ImplicitStep<B>(level, parts), start_("sdirk2.start", level.model.vertices) {}
  std::size_t bytes() const override {
    return ImplicitStep<B>::bytes() + 2 * start_.u.span() * sizeof(Real);
  }

 protected:
  bool step(SolverLevel<B>& level, double time, double h) override {
    const double part = (1 - std::sqrt(0.5)) * h, rest = h - part;
    const ImplicitWeights weights{part * part, part};
    const State<B>& base = this->stages().base();
    start_.copy(level.exec(), level.state);
    backward_euler_base(level, part, base);
    const bool first = this->stages().solve(level, time, part, weights, {.span = part});
    fill(level.exec(), level.f, Real(0));
    if (level.contact())
      level.book("contact", [&] {
        level.response().end_stage(level.exec(), level, level.state);
        level.response().add_last_forces(level.exec(), level, level.f);
      });
    prescribe(level.exec(), level, level.state, time + part, part);
    update_vertices<B>(level.exec(), "plica::sdirk2_base", level.model.vertices,
                       Sdirk2Base<B>{level.model, start_, level.state, level.f, base,
                                     static_cast<Real>(part), static_cast<Real>(rest)});
    return this->stages().solve(level, time + part, rest, weights,
                                {.span = rest, .factor = h / part}) &&
           first;
  }

 private:
  State<B> start_;
};

}  // namespace

template <class B>
std::unique_ptr<Integrator<B>> Sdirk2::make(const Level<B>& level,
                                            const IntegratorParts<B>& parts) {
  return std::make_unique<Sdirk2Step<B>>(level, parts);
}
template <class B>
std::unique_ptr<Integrator<B>> ImplicitEuler::make(const Level<B>& level,
                                                   const IntegratorParts<B>& parts) {
  return std::make_unique<ImplicitEulerStep<B>>(level, parts);
}
template <class B>
std::unique_ptr<Integrator<B>> Newmark::make(const Level<B>& level,
                                             const IntegratorParts<B>& parts) {
  return std::make_unique<NewmarkStep<B>>(level, parts);
}
template <class B>
std::unique_ptr<Integrator<B>> Bdf2::make(const Level<B>& level, const IntegratorParts<B>& parts) {
  return std::make_unique<Bdf2Step<B>>(level, parts);
}
template <class B>
std::unique_ptr<Integrator<B>> GeneralizedAlpha::make(const Level<B>& level,
                                                      const IntegratorParts<B>& parts) {
  return std::make_unique<GeneralizedAlphaStep<B>>(level, parts);
}
template <class B>
std::unique_ptr<Integrator<B>> VCycleEuler::make(const Level<B>& level,
                                                 const IntegratorParts<B>& parts) {
  return std::make_unique<ImplicitEulerStep<B>>(level, parts);
}

#define PLICA_INSTANTIATE(Real, Exec)                          \
  PLICA_MAKE_INTEGRATOR(ImplicitEuler, Backend<Real, Exec>)    \
  PLICA_MAKE_INTEGRATOR(Newmark, Backend<Real, Exec>)          \
  PLICA_MAKE_INTEGRATOR(Bdf2, Backend<Real, Exec>)             \
  PLICA_MAKE_INTEGRATOR(Sdirk2, Backend<Real, Exec>)           \
  PLICA_MAKE_INTEGRATOR(GeneralizedAlpha, Backend<Real, Exec>) \
  PLICA_MAKE_INTEGRATOR(VCycleEuler, Backend<Real, Exec>)
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
