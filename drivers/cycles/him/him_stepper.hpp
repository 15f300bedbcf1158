// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/level_data.hpp>
#include <plica/drivers/cycles/him/him_body.hpp>
#include <plica/drivers/cycles/regrow_schedule.hpp>
#include <plica/drivers/cycles/stepper.hpp>
#include <plica/kernels/contact/contact_kernels.hpp>

// Symbols of cmake/docs/explanation/him.md: A p is answer(), p is momenta(), F is found in
// HimBody::kick(). t is the time of one step: macro_step_ / 2^halvings_.
namespace plica {

/// Stepper of the hierarchical inverse mass A: one V-cycle and one force evaluation per step.
/// Forces are those of the finest level, and go down to the coarser levels. Each level computes
/// accelerations with the inertia of the motion that it can represent, and these are interpolated
/// back up. Motion that coarse levels represent keeps its own inertia. Finer detail gets more
/// inertia: it is slowed, and so allows the step. Static equilibrium is that of the finest mesh.
/// The scheme is of second order. See cmake/docs/explanation/him.md.
///
/// The momenta p are integrated, and v = A p. The scheme is symplectic Euler of the energy p.A(x)
/// p/2 + V(x). The state is taken half a step after the forces, so that at t_n and t_n+1 it is that
/// of position Verlet. The energy stays bounded. Of a free body sum p = sum m v and sum x x p are
/// conserved; sum x x m v oscillates. A start from given velocities takes p = m v and v = A m v. A
/// state that is set later keeps its v, with p = A^-1 v and the frames of that moment.
///
/// lost_stability() is true where a body has stiffened beyond the stable step. repair() cuts the
/// step and fits the inertia to the present state. Where explicit steps of level 0 alone are
/// cheaper than steps that fit, macro steps are taken in such explicit sub-steps. regrow() takes
/// the longest of the earlier fits that hold in the present state.
template <class B>
class HimStepper final : public Stepper<B> {
  using Real = typename B::Real;
  using Exec = typename B::Exec;
  using Count = Doubles<B>;

 public:
  HimStepper() = default;
  /// Makes a stepper from one body's given parts, for the finest level of this hierarchy.
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
  bool detects_late() const override { return explicit_ > 0; }
  /// Returns true for every diagnosis where repairs are allowed.
  /// An impact strains elements by more than a long step can follow. Where stability is lost fast,
  /// energy that nobody put in shows it first.
  bool repairs(const Diagnosis&) const override { return may_repair_; }
  bool repair(Hierarchy<B>& h, double t) override;
  void regrow(Hierarchy<B>& h, double t, long steps) override;
  int parts() const override { return explicit_ > 0 ? explicit_ : 1 << halvings_; }

  /// Returns the momenta p [vertices][3] kg m/s, 0 where the motion is given.
  const Vectors<B>& momenta() const { return fields_.p; }

  std::map<std::string, long> counters() const override {
    return {{"inertia_refits", repairs_},
            {"him_substeps", parts()},
            {"him_explicit_steps", explicit_steps_},
            {"substeps_regained", regaining_.count()}};
  }
  void name_fields(Archive<B>& archive) override;

 private:
  HimOptions options_;
  std::vector<HimBody<B>> bodies_;
  int n_ = 0;
  HimFields<B> fields_;
  double macro_step_ = 0;
  // level 0 at rest: stable step [s], largest eigenvalue of M^-1 K [1/s^2]
  double explicit_limit_ = 0, eigenvalue_ = 0;
  bool may_repair_ = true;
  bool shared_ = false;      // whether several ranks share the body
  bool has_momenta_ = true;  // false: the next step finds the momenta of the velocities
  int halvings_ = 0;
  // explicit sub-steps of level 0 in a macro step; 0: steps of the inverse mass instead
  int explicit_ = 0;
  long repairs_ = 0, explicit_steps_ = 0;
  double explicit_until_ = 0;  // end of the latest macro step of explicit sub-steps [s]
  RegrowSchedule regaining_;

  /// Makes the bodies from their parts, and the fields that they share.
  void take(const Hierarchy<B>& h, std::vector<HimParts<B>>&& parts, bool contact);
  /// Uses the last fits of all bodies with the present halvings.
  void use_fits();
  /// Fits all bodies in the present state to the macro step after `halvings`.
  /// Returns false where one does not fit.
  bool fit(const Hierarchy<B>& h, int halvings);
  /// Makes steps shorter: by more halvings, to which the inertia fits in the present state, or by
  /// explicit sub-steps of level 0 where these are cheaper.
  void shorten(const Hierarchy<B>& h);
  /// Returns the longest explicit step of level 0 that is safe in the present state [s].
  double explicit_step(const Hierarchy<B>& h) const;
  /// Returns the maximum halvings of the macro step at which explicit steps are not yet cheaper.
  int most_halvings(double explicit_step) const;

  /// Sets v = A p. With a `count` on the device, only where that is above 0.
  void answer(const Exec& exec, const Vectors<B>& p, const Vectors<B>& v,
              const Count& count = {}) const {
    // else ranks would send each other what no kernel computes
    if (shared_ && count.extent(0) > 0 && !(host_values(exec, count)[0] > 0)) return;
    for (const HimBody<B>& body : bodies_) body.answer(exec, p, v, count);
  }
  /// Forgets what the next step would take from the last, except momenta.
  void reset_history(const Exec& exec);
  /// Finds the momenta of the velocities, p = A^-1 v, with the present frames.
  void find_momenta(const Exec& exec, const LevelData<B>& level);
  /// Finds contact's forces on the vertices, and the accelerations A f by these.
  void touch(Level<B>& level, double time, double t) const;
  void substep(Hierarchy<B>& h, double time, double t);
  void step_explicitly(Hierarchy<B>& h, double time, double t);
};

}  // namespace plica
