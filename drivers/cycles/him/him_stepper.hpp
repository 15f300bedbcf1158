// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/level.hpp>
#include <plica/drivers/cycles/him/him_body.hpp>
#include <plica/drivers/cycles/regaining.hpp>
#include <plica/drivers/cycles/stepper.hpp>
#include <plica/kernels/contact/contact_kernels.hpp>

namespace plica {

/// The hierarchical inverse mass: one V-cycle and one force evaluation, of the finest level, per
/// macro step. Forces go down to the coarser levels. Each level computes accelerations with the
/// inertia of the motion that it can represent, and these are interpolated back up. Motion that
/// coarse levels represent keeps its own inertia. Finer detail gets more inertia: it is slowed, and
/// so allows the step. Static equilibrium is that of the finest mesh. Second order. See
/// cmake/docs/him.md.
///
/// The momenta p are integrated, and v = A p. The scheme is symplectic Euler of the energy p.A(x)
/// p/2 + V(x). The state is taken half a step after the forces, so that at t_n and t_n+1 it is that
/// of position Verlet. The energy stays bounded. Of a free body sum p = sum m v and sum x x p are
/// conserved; sum x x m v oscillates. A start from given velocities takes p = m v and v = A m v. A
/// state that is set later keeps its v, with p = A^-1 v and the axes of that moment.
/// lost_stability() is true where a body has stiffened beyond the stable step; repair() cuts the
/// step and fits the inertia to the present state. Where a step that fits is so short that level 0
/// alone is cheaper, macro steps are taken in explicit sub-steps of that. lengthen() takes the
/// longest of the earlier fits that hold in the present state.
template <class B>
class HimStepper final : public Stepper<B> {
  using Real = typename B::Real;
  using Exec = typename B::Exec;
  using Count = Doubles<B>;

 public:
  HimStepper() = default;
  /// Of one body's parts that were put together by hand, for the finest level of this hierarchy.
  HimStepper(const Hierarchy<B>& h, const HimOptions& options, HimParts<B>&& parts)
      : options_(options) {
    std::vector<HimParts<B>> one;
    one.push_back(std::move(parts));
    take(h, std::move(one), false);
  }

  void plan(StepperSetup<B>& setup) override;
  void start(Hierarchy<B>& h) override;
  void begin(Hierarchy<B>& h) override;
  void step(Hierarchy<B>& h, double time, double t) override;

  bool can_repair() const override { return may_repair_; }
  bool lost_stability(const Hierarchy<B>& h, double kinetic) override;
  bool sees_late() const override { return explicit_ > 0; }  // as other explicit steps
  /// An impact strains elements by more than a long step can follow. Where stability is lost fast,
  /// energy that nobody put in shows it first.
  bool repairs(const Diagnosis&) const override { return may_repair_; }
  bool repair(Hierarchy<B>& h, double t) override;
  void lengthen(Hierarchy<B>& h, double t, long steps) override;
  int parts() const override { return explicit_ > 0 ? explicit_ : 1 << halvings_; }

  /// p [kg m/s], 0 where the motion is given.
  const Vectors<B>& momenta() const { return fields_.p; }

  std::map<std::string, long> counters() const override {
    return {{"inertia_refits", repairs_},
            {"him_substeps", parts()},
            {"him_explicit_steps", explicit_steps_},
            {"substeps_regained", regaining_.count()}};
  }
  std::size_t bytes() const override;
  void persist(StateArchive<B>& archive) override;

 private:
  HimOptions options_;
  std::vector<HimBody<B>> bodies_;
  int n_ = 0;
  HimFields<B> fields_;
  double macro_step_ = 0;
  // of level 0 at rest: stable step [s], of M^-1 K [1/s^2]
  double explicit_limit_ = 0, eigenvalue_ = 0;
  bool may_repair_ = true;
  bool has_momenta_ = true;  // else the next step finds them
  int halvings_ = 0;
  // sub-steps of level 0 in a macro step; 0: none, it is taken by the inverse mass
  int explicit_ = 0;
  long repairs_ = 0, explicit_steps_ = 0;
  double explicit_until_ = 0;  // the end of the latest macro step that was taken so [s]
  Regaining regaining_;

  /// The bodies, and the fields that they share.
  void take(const Hierarchy<B>& h, std::vector<HimParts<B>>&& parts, bool contact);
  /// The fits that there were with the present halvings.
  void use_fits();
  /// Whether all bodies could be fitted to the macro step halved so often, in the state as it is.
  bool fit(const Hierarchy<B>& h, int halvings);
  /// The longest explicit step that is stable with level 0 as it is [s].
  double explicit_step(const Hierarchy<B>& h) const;
  /// How often the macro step may be halved before explicit steps are cheaper.
  int most_halvings(double explicit_step) const;

  /// v = A p; with a count only where that is above 0.
  void answer(const Exec& exec, const Vectors<B>& p, const Vectors<B>& v,
              const Count& count = {}) const {
    for (const HimBody<B>& body : bodies_) body.answer(exec, p, v, count);
  }
  /// What the next step takes from the last, but for momenta.
  void forget(const Exec& exec);
  /// Momenta of the velocities, about the axes as they are.
  void find_momenta(const Exec& exec, const Level<B>& level);
  /// Contact's forces on the vertices, and A's answer to them.
  void touch(SolverLevel<B>& level, double time, double t) const;
  void substep(Hierarchy<B>& h, double time, double t);
  void step_explicitly(Hierarchy<B>& h, double time, double t);
};

}  // namespace plica
