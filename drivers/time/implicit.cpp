// SPDX-License-Identifier: BSD-3-Clause
// Implicit integrators. Each sets the base (u~, v~) of a stage, which the stage solver then solves
// (stage_solver.hpp). ImplicitStep treats steps that are not solved.
#include <plica/drivers/time/implicit_step.hpp>
#include <plica/drivers/time/rest_step.hpp>
#include <plica/kernels/time/stage_kernels.hpp>

namespace plica {

namespace {

/// Computes the base of backward Euler over h [s].
template <class B>
void backward_euler_base(const Level<B>& level, double h, const State<B>& base) {
  base.copy(level.exec(), level.state);
  add<B>(level.exec(), "plica::implicit_euler_base", static_cast<typename B::Real>(h), base.v,
         base.u);
}

/// Backward Euler: order 1, dissipative at every step, no stability limit on the linear problem
/// (L-stable).
///
/// The linear solver v_cycle approximates the inverse of the system A = M + h^2 K. It is exactly
/// one V-cycle C of multigrid over the body's meshes. On the linear problem the eigenvalues
/// of C A are in (0, 1]. A mode with the eigenvalue k < 1 of h^2 C K then has |eigenvalue|^2 = 1 -
/// k per step: there is no limit on the step. Motion that the cycle does not resolve moves as if it
/// were heavier. If a body stiffens, C does not follow until it is fitted again.
template <class B>
class ImplicitEulerStep final : public ImplicitStep<B> {
 public:
  using ImplicitStep<B>::ImplicitStep;

 protected:
  bool step(Level<B>& level, double time, double h) override {
    backward_euler_base(level, h, this->stages().base());
    return this->stages().solve(level, time, h, {h * h, h}, {.span = h});
  }
};

/// Computes the base of the trapezoidal rule over h [s] from the level's state at `time`. It is
/// half a step of forward Euler, and the drift of the implicit half. Contact is no part of it:
/// contact acts at the end of a step (C. Kane, E. A. Repetto, M. Ortiz, J. E. Marsden, Comput.
/// Methods Appl. Mech. Engrg. 180, 1999). Averaged over a step it would gain energy. Overwrites
/// level.f.
template <class B>
void trapezoidal_base(Level<B>& level, double time, double h, const State<B>& base) {
  using Real = typename B::Real;
  level.evaluate_without_contact(level.state, time, level.f);
  update_vertices<B>(level.exec(), "plica::accelerations", level.model.vertices,
                     Accelerations<B>{level.model, level.f, level.state.v, level.f});
  update_vertices<B>(level.exec(), "plica::trapezoidal_base", level.model.vertices,
                     ExtrapolateState<B>{level.state, level.f, base, static_cast<Real>(h),
                                         static_cast<Real>(h * h / 4), static_cast<Real>(h / 2)});
}

/// Newmark's method with beta = 1/4, gamma = 1/2: the trapezoidal rule, half a step of forward
/// Euler, then half a step of backward Euler. It has order 2. On the linear problem it is stable at
/// every step (A-stable) and conserves energy, so that motion too fast for the step does not decay.
/// With large strains energy oscillates and may grow (Hughes, The Finite Element Method, 9.1). With
/// one Newton iteration per step energy is lost.
template <class B>
class NewmarkStep final : public ImplicitStep<B> {
 public:
  using ImplicitStep<B>::ImplicitStep;

 protected:
  bool step(Level<B>& level, double time, double h) override {
    trapezoidal_base(level, time, h, this->stages().base());
    return this->stages().solve(level, time, h, {h * h / 4, h / 2}, {.span = h, .factor = 2});
  }
};

/// Backward differentiation formula of order 2, for a step that is w times the last one:
///
///   v = v_n + w^2/(1 + 2w) (v_n - v_{n-1}) + b a,  b = h (1 + w)/(1 + 2w)
///   u = u_n + w^2/(1 + 2w) (u_n - u_{n-1}) + b v
///
/// On the linear problem it is stable at every constant step, and fast motion decays (L-stable).
/// Slow motion loses energy in proportion to h^4 (Hairer & Wanner, Solving ODEs II, V.1). With
/// changing steps it is stable for w < 1 + sqrt 2 (Solving ODEs I, III.5).
///
/// The first step has no step before it; neither has a step on a level of a cycle, which replaces
/// the state. Such a step is half a step of the trapezoidal rule, then the formula over the two
/// halves (Bank et al. 1985), as stable and as accurate. With contact it is backward Euler.
template <class B>
class Bdf2Step final : public ImplicitStep<B> {
  using Real = typename B::Real;

 public:
  Bdf2Step(const LevelData<B>& level, const IntegratorParts<B>& parts)
      : ImplicitStep<B>(level, parts),
        start_("bdf2.start", level.model.vertices),
        increment_("bdf2.increment", level.model.vertices) {}

  void reset_history() override { last_step_ = 0; }
  void name_fields(Archive<B>& archive) override {
    ImplicitStep<B>::name_fields(archive);
    archive.number(last_step_);
    archive.state("bdf2's increment", increment_);
    archive.owns(start_);
  }

 protected:
  bool step(Level<B>& level, double time, double h) override {
    constexpr double most_growth = 2.0 + 1e-9;  // maximum ratio of a step to the last one
    start_.copy(level.exec(), level.state);
    const double growth = last_step_ > 0 ? h / last_step_ : 0;
    ratio_ = growth <= most_growth ? growth : 0;
    return ratio_ > 0        ? formula(level, time, h, ratio_, {.span = h})
           : level.contact() ? euler(level, time, h)
                             : first(level, time, h / 2);
  }
  void finish(Level<B>& level, double h) override {
    accept_state(level);
    last_step_ = h;
  }
  /// Returns the impulse; a part of the last change of momentum is carried on.
  CarriedImpulse impulse(double h) const override {
    return ratio_ > 0 ? CarriedImpulse{implicit_part(ratio_) * h, carried_part(ratio_)}
                      : CarriedImpulse{h};
  }

 private:
  State<B> start_, increment_;
  double last_step_ = 0;  // step before [s]; 0: none
  double ratio_ = 0;      // ratio of the last step to the one before; 0: it did not use the formula

  static double carried_part(double ratio) { return ratio * ratio / (1 + 2 * ratio); }
  static double implicit_part(double ratio) { return (1 + ratio) / (1 + 2 * ratio); }

  bool formula(Level<B>& level, double time, double h, double ratio,
               const ContactStage& contact = {}) {
    const double b = implicit_part(ratio) * h;
    const State<B>& base = this->stages().base();
    combine<B>(level.exec(), "plica::bdf2_base", static_cast<Real>(carried_part(ratio)), increment_,
               1, level.state, base);
    add<B>(level.exec(), "plica::bdf2_drift", static_cast<Real>(b), base.v, base.u);
    return this->stages().solve(level, time, h, {b * b, b}, contact);
  }
  /// Computes a step of backward Euler: the trapezoidal rule oscillates where contact sets in.
  bool euler(Level<B>& level, double time, double h) {
    backward_euler_base(level, h, this->stages().base());
    return this->stages().solve(level, time, h, {h * h, h}, {.span = h});
  }
  bool first(Level<B>& level, double time, double h) {
    trapezoidal_base(level, time, h, this->stages().base());
    const bool solved = this->stages().solve(level, time, h, {h * h / 4, h / 2});
    last_step_ = 0,
    accept_state(level);  // stores the first half, also where the step is not accepted
    prescribe(level.exec(), level, level.state, time + h, h);
    return formula(level, time + h, h, 1) && solved;
  }
  void accept_state(const Level<B>& level) const {
    combine<B>(level.exec(), "plica::bdf2_increment", -1, start_, 1, level.state, increment_);
  }
};

/// Generalised alpha method of Chung & Hulbert (1993): order 2, stable at every step on the linear
/// problem. The amplitude of the fastest motion is multiplied by rho_infinity per step. With 1 it
/// is conserved (the implicit midpoint rule), with 0 it vanishes. Balance is met at t + (1 -
/// alpha_f) h with the acceleration alpha_m a_n + (1 - alpha_m) a_{n+1}. The method carries an
/// acceleration from step to step. Where a cycle replaces the state, the acceleration is computed
/// anew.
template <class B>
class GeneralizedAlphaStep final : public ImplicitStep<B> {
  using Real = typename B::Real;

 public:
  GeneralizedAlphaStep(const LevelData<B>& level, const IntegratorParts<B>& parts)
      : ImplicitStep<B>(level, parts),
        start_("generalized_alpha.start", level.model.vertices),
        acceleration_("plica::generalized_alpha.acceleration", level.model.vertices) {
    const double rho = parts.implicit.rho_infinity.value();
    mass_ = (2 * rho - 1) / (rho + 1), force_ = rho / (rho + 1);
    gamma_ = 0.5 - mass_ + force_, beta_ = 0.25 * (1 - mass_ + force_) * (1 - mass_ + force_);
  }

  void reset_history() override { carried_ = false; }
  void name_fields(Archive<B>& archive) override {
    ImplicitStep<B>::name_fields(archive);
    archive.number(carried_);
    archive.field("the acceleration", acceleration_, RowItems::vertices);
    archive.owns(start_);
  }

 protected:
  bool step(Level<B>& level, double time, double h) override {
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

  /// Returns the impulse of contact, h ((1 - gamma) A_n + gamma A_{n+1}). A is contact's part of m
  /// a, with alpha_m A_n + (1 - alpha_m) A_{n+1} = F. It is carried from step to step as a is, and
  /// is 0 before the first step.
  CarriedImpulse impulse(double h) const override {
    const double again = started_ ? -mass_ / (1 - mass_) : 0;
    return {1 / (1 - mass_), again, gamma_ * h, started_ ? (1 - gamma_) * h : 0};
  }

  void finish(Level<B>& level, double h) override {
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
  double mass_, force_, beta_, gamma_;      // alpha_m, alpha_f, Newmark's beta and gamma
  double velocity_of_ = 0;                  // velocity per acceleration in the last stage, cv [s]
};

/// Singly diagonally implicit Runge-Kutta method of two stages (R. Alexander, SIAM J. Numer. Anal.
/// 14, 1977), c = 1 - 1/sqrt 2:
///
///   v_1 = v_n + c h a_1,  v_{n+1} = v_n + (1 - c) h a_1 + c h a_2
///   u_1 = u_n + c h v_1,  u_{n+1} = u_n + (1 - c) h v_1 + c h v_{n+1}
///
/// It has order 2, is stable at every step on the linear problem, and fast motion decays
/// (L-stable). It needs no step before. Both stages have one system matrix on the linear problem.
/// Contact is solved in both stages, but acts on the step at its end only, as in Newmark's method:
/// a_1 is without it.
template <class B>
class Sdirk2Step final : public ImplicitStep<B> {
  using Real = typename B::Real;

 public:
  Sdirk2Step(const LevelData<B>& level, const IntegratorParts<B>& parts)
      : ImplicitStep<B>(level, parts), start_("sdirk2.start", level.model.vertices) {}
  void name_fields(Archive<B>& archive) override {
    ImplicitStep<B>::name_fields(archive);
    archive.owns(start_);
  }

 protected:
  bool step(Level<B>& level, double time, double h) override {
    const double part = (1 - std::sqrt(0.5)) * h, rest = h - part;
    const ImplicitWeights weights{part * part, part};
    const State<B>& base = this->stages().base();
    start_.copy(level.exec(), level.state);
    backward_euler_base(level, part, base);
    const bool first = this->stages().solve(level, time, part, weights, {.span = part});
    fill(level.exec(), level.f, Real(0));
    if (level.contact())
      level.timed("contact", [&] {
        level.response().end_stage(level.exec(), level, level.state);
        level.response().add_last_forces(level.exec(), level, level.f);
        hold_sliding(level.exec(), level, level.f);
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
std::unique_ptr<Integrator<B>> Sdirk2::make(const LevelData<B>& level,
                                            const IntegratorParts<B>& parts) {
  return std::make_unique<Sdirk2Step<B>>(level, parts);
}
template <class B>
std::unique_ptr<Integrator<B>> ImplicitEuler::make(const LevelData<B>& level,
                                                   const IntegratorParts<B>& parts) {
  if (parts.rest > 0) return std::make_unique<RestStep<B>>(level, parts);
  return std::make_unique<ImplicitEulerStep<B>>(level, parts);
}
template <class B>
std::unique_ptr<Integrator<B>> Newmark::make(const LevelData<B>& level,
                                             const IntegratorParts<B>& parts) {
  return std::make_unique<NewmarkStep<B>>(level, parts);
}
template <class B>
std::unique_ptr<Integrator<B>> Bdf2::make(const LevelData<B>& level,
                                          const IntegratorParts<B>& parts) {
  return std::make_unique<Bdf2Step<B>>(level, parts);
}
template <class B>
std::unique_ptr<Integrator<B>> GeneralizedAlpha::make(const LevelData<B>& level,
                                                      const IntegratorParts<B>& parts) {
  return std::make_unique<GeneralizedAlphaStep<B>>(level, parts);
}
template <class B>
std::unique_ptr<Integrator<B>> VCycleEuler::make(const LevelData<B>& level,
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
