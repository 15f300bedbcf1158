// SPDX-License-Identifier: BSD-3-Clause
// Explicit integrators. Each asks the level for the forces of a state, updates that state, and then
// sets the vertices whose motion is given.
#include <plica/drivers/time/integrator_parts.hpp>
#include <plica/kernels/loads/boundary_conditions.hpp>
#include <plica/kernels/time/updates.hpp>

namespace plica {

namespace {

// Contact in these methods, see ContactStep. In the displacements alone symplectic Euler and the
// central difference are one method, leapfrog. There the next displacement follows from the force
// of the step, and contact is evaluated at its end. Forward Euler moves by the velocity at the
// start: contact is evaluated one step after the state that this leads to. A Runge-Kutta stage
// evaluates contact one step after its own state, which damps it.

/// Euler's method with one force per step, from which Update computes the next state. It is
/// semi-implicit Euler, which is symplectic, or forward Euler. Both are of first order.
template <class B, class Update>
class EulerStep final : public Integrator<B> {
 public:
  void advance(Level<B>& level, double time, double h, int steps) override {
    const Update update{level.model, level.f, level.state.u, level.state.v,
                        static_cast<typename B::Real>(h)};
    for (int s = 0; s < steps; ++s) {
      level.accept_state(time + s * h);
      level.evaluate(level.state, time + s * h, level.f, Update::contact(h), h);
      update_vertices<B>(level.exec(), Update::label, level.model.vertices, update);
      prescribe(level.exec(), level, level.state, time + (s + 1) * h);
    }
  }
};

/// Central difference method, as in total Lagrangian explicit dynamics (Miller et al. 2007):
/// u_{n+1} - 2 u_n + u_{n-1} = h^2 a_n with v_n = (u_{n+1} - u_{n-1})/2h. In displacement and
/// velocity a step is half a kick, a drift, a force, half a kick. It has order 2 and is symplectic:
/// the energy of undamped motion oscillates and does not drift. It computes one force per step. The
/// next step begins with this force, unless the state, or what acts on it, has been changed since.
/// Mass damping is evaluated at v_n.
template <class B>
class CentralDifferenceStep final : public Integrator<B> {
  using Real = typename B::Real;

 public:
  explicit CentralDifferenceStep(const LevelData<B>& level)
      : f_("plica::central_difference.f", level.model.vertices) {}

  void advance(Level<B>& level, double time, double h, int steps) override {
    const int n = level.model.vertices;
    const auto half = static_cast<Real>(h / 2);
    const ContactStep contact{.span = h, .damped = h / 2};
    level.accept_state(time);
    if (!current_ || level.asks_caller())
      level.evaluate(level.state, time, f_, contact, h / 2);
    else if (level.contact())
      level.add_last_impulse(time, h / 2);
    current_ = true;
    for (int s = 0; s < steps; ++s) {
      update_vertices<B>(level.exec(), "plica::kick_and_drift", n,
                         HalfKickAndDrift<B>{level.model, f_, level.state, half});
      prescribe(level.exec(), level, level.state, time + (s + 1) * h);
      level.accept_state(time + (s + 1) * h);
      level.evaluate(level.state, time + (s + 1) * h, f_, contact, s + 1 < steps ? h : h / 2);
      update_vertices<B>(level.exec(), "plica::kick", n,
                         HalfKick<B>{level.model, f_, level.state.v, half});
      follow_masters(level.exec(), level.model, level.state.v);
    }
  }

  void reset_history() override { current_ = false; }
  void name_fields(Archive<B>& archive) override {
    archive.number(current_);
    archive.field("the central difference's force", f_, RowItems::vertices);
  }

 private:
  Vectors<B> f_;          // forces at the end of the last step
  bool current_ = false;  // whether f_ are the forces at the present state
};

/// Explicit Runge-Kutta method in which each stage uses only the slope of the stage before. A
/// tableau has
///   stages, weight[stages]   weight of each stage's slope in the step
///   ahead[stages - 1]        next stage: state start + ahead h slope, at time + ahead h
template <class B, class Tableau>
class RungeKuttaStep final : public Integrator<B> {
  using Real = typename B::Real;

 public:
  explicit RungeKuttaStep(const LevelData<B>& level)
      : start_("runge_kutta.start", level.model.vertices),
        stage_("runge_kutta.stage", level.model.vertices),
        sum_("runge_kutta.sum", level.model.vertices) {}

  void advance(Level<B>& level, double time, double h, int steps) override {
    const auto& exec = level.exec();
    for (int s = 0; s < steps; ++s) {
      level.accept_state(time + s * h);
      start_.copy(exec, level.state);
      stage_.copy(exec, level.state);
      sum_.copy(exec, level.state);
      double at = 0;
      for (int k = 0; k < Tableau::stages; ++k) {
        const bool last = k + 1 == Tableau::stages;
        const double ahead = last ? 0 : Tableau::ahead[k];
        level.evaluate(stage_, time + (s + at) * h, level.f, {.span = h, .ends = last},
                       Tableau::weight[k] * h);
        update_vertices<B>(
            exec, "plica::runge_kutta", level.model.vertices,
            RungeKuttaStage<B>{level.model, level.f, start_, stage_, sum_, static_cast<Real>(h),
                               static_cast<Real>(Tableau::weight[k]), static_cast<Real>(ahead)});
        at = ahead;
        if (!last) prescribe(exec, level, stage_, time + (s + at) * h);
      }
      level.state.copy(exec, sum_);
      prescribe(exec, level, level.state, time + (s + 1) * h);
    }
  }

  void name_fields(Archive<B>& archive) override { archive.owns(start_, stage_, sum_); }

 private:
  State<B> start_, stage_, sum_;
};

/// Tableau of the midpoint rule.
struct MidpointTableau {
  static constexpr int stages = 2;
  static constexpr double weight[2] = {0, 1}, ahead[1] = {0.5};
};

/// Tableau of the classical method of order 4.
struct ClassicalTableau {
  static constexpr int stages = 4;
  static constexpr double weight[4] = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6},
                          ahead[3] = {0.5, 0.5, 1};
};

}  // namespace

template <class B>
std::unique_ptr<Integrator<B>> SymplecticEuler::make(const LevelData<B>&,
                                                     const IntegratorParts<B>&) {
  return std::make_unique<EulerStep<B, SymplecticEulerUpdate<B>>>();
}
template <class B>
std::unique_ptr<Integrator<B>> CentralDifference::make(const LevelData<B>& level,
                                                       const IntegratorParts<B>&) {
  return std::make_unique<CentralDifferenceStep<B>>(level);
}
template <class B>
std::unique_ptr<Integrator<B>> ForwardEuler::make(const LevelData<B>&, const IntegratorParts<B>&) {
  return std::make_unique<EulerStep<B, ForwardEulerUpdate<B>>>();
}
template <class B>
std::unique_ptr<Integrator<B>> Rk2::make(const LevelData<B>& level, const IntegratorParts<B>&) {
  return std::make_unique<RungeKuttaStep<B, MidpointTableau>>(level);
}
template <class B>
std::unique_ptr<Integrator<B>> Rk4::make(const LevelData<B>& level, const IntegratorParts<B>&) {
  return std::make_unique<RungeKuttaStep<B, ClassicalTableau>>(level);
}

#define PLICA_INSTANTIATE(Real, Exec)                           \
  PLICA_MAKE_INTEGRATOR(SymplecticEuler, Backend<Real, Exec>)   \
  PLICA_MAKE_INTEGRATOR(CentralDifference, Backend<Real, Exec>) \
  PLICA_MAKE_INTEGRATOR(ForwardEuler, Backend<Real, Exec>)      \
  PLICA_MAKE_INTEGRATOR(Rk2, Backend<Real, Exec>)               \
  PLICA_MAKE_INTEGRATOR(Rk4, Backend<Real, Exec>)
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
