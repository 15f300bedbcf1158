// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <memory>
#include <plica/core/archive.hpp>
#include <plica/core/level_data.hpp>
#include <plica/core/small.hpp>
#include <plica/core/stage_timer.hpp>
#include <plica/drivers/contact/contact_response.hpp>
#include <plica/drivers/elastic/elasticity.hpp>
#include <plica/drivers/elastic/viscosity.hpp>
#include <plica/drivers/loads/external_forces.hpp>
#include <plica/drivers/loads/force_term.hpp>

namespace plica {

template <class B>
class Integrator;

/// One resolution of the body in a run: its data, all forces on it, its integrator and its part of
/// the macro step. Forces are internal ones, gravity, loads, contact and the caller's; those that
/// the scene does not have are absent. Kernels run in the hierarchy's execution space, whose clock
/// adds their time under this level's number.
template <class B>
class Level : public LevelData<B> {
 public:
  using Exec = typename B::Exec;

  /// Makes a level without forces and integrator. The clock must outlive it.
  Level(LevelData<B>&& data, StageTimer<B>& clock, int number);
  Level(Level&&) noexcept;
  ~Level();

  /// Sets the forces that act on the level from now on. `implicit`: they will be linearised.
  void set_forces(std::shared_ptr<const Elasticity<B>> elasticity, const Point& gravity,
                  std::shared_ptr<const Contact<B>> contact, bool implicit);

  /// Sets the acceleration of everything that is free from now on [m/s^2].
  void set_gravity(const Point& gravity);

  std::vector<std::unique_ptr<ForceTerm<B>>> terms;  ///< see make_force_terms()
  std::unique_ptr<Integrator<B>> integrator;
  std::unique_ptr<Viscosity<B>> viscosity;  ///< only with viscous materials
  double share = 1;                         ///< part of the macro step, from 0 to 1
  int substeps = 1;                         ///< number of sub-steps in the level's share

  const Exec& exec() const { return clock_->exec(); }

  /// Adds the level's state at this time [s] to the history from which stresses relax. To be called
  /// at the start of every step, and wherever else a state is final.
  void accept_state(double time) const {
    if (viscosity) viscosity->accept_state(exec(), *this, *elasticity_, this->state.u, time);
  }

  /// Computes f = all forces on a state of this level at a time [s], without those along directions
  /// that hold sliding vertices; so do the other evaluations. `step`: how contact is taken,
  /// by default that of a state that stays. `weight`: how long the forces act [s], for the impulse
  /// of the obstacles.
  void evaluate(const State<B>& state, double time, const Vectors<B>& f,
                const ContactStep& step = {}, double weight = 0);
  /// Computes f = all forces without contact on a state of this level at a time [s].
  void evaluate_without_contact(const State<B>& state, double time, const Vectors<B>& f);
  /// Computes f = all forces on the level's state at a time [s], on held vertices, too. For reports
  /// between steps: it counts as no evaluation and marks no inverted element. Contact's forces are
  /// those of its last evaluation, and a caller's are left out.
  void measure_forces(double time, const Vectors<B>& f);
  /// Adds the last evaluation's contact force for `weight` more [s] to the impulse of the
  /// obstacles. The evaluation was at the level's state.
  void add_last_impulse(double time, double weight) const {
    response_.add_impulse(exec(), *this, this->state, time, weight);
  }
  /// Adds the contact force at an implicit step's end to the impulse of the obstacles, at the
  /// level's state.
  void count_contact(double time, const CarriedImpulse& of);

  /// Returns volumes and pressures of the level's cavities at its state. Waits.
  std::vector<CavityState> cavities(double time) const;
  /// Returns the energy of the terms at the level's state [J]. Waits where a term has one.
  double term_energy(double time) const;
  /// Adds scale K p to q, with K the stiffness of the terms at the state and time of the last
  /// evaluation; `projected`: see ForceTerm::add_product().
  void add_term_product(const State<B>& state, const Vectors<B>& p, double scale, bool projected,
                        const Vectors<B>& q) const;
  /// Returns whether a term has that kind of stiffness, or any stiffness.
  bool has_terms(TermStiffness kind) const;
  bool has_stiff_terms() const {
    return has_terms(TermStiffness::assembled) || has_terms(TermStiffness::unassembled);
  }
  /// Returns whether the system of a stage has only inertia and the elements' stiffness.
  bool is_stiffness_alone() const {
    return !contact_ && !has_stiff_terms() && !viscosity &&
           this->model.patches.damping.extent(0) == 0;
  }
  /// Returns an upper bound of what the terms add to the squared frequencies at rest [1/s^2].
  double term_frequency() const;

  /// Computes f = the forces that do not depend on the state: gravity, loads, a correction.
  void dead_loads(double time, const Vectors<B>& f) const;

  /// Linearises about a state for an implicit stage. Computes f = all forces without contact, with
  /// loads at a time `ahead` of the state's [s].
  void linearise(const State<B>& state, double time, const ImplicitWeights& weights, double ahead,
                 const Vectors<B>& f);
  /// Computes q = A p, with A = (1 + b c) M + a K + contact at the linearised state; see
  /// ImplicitWeights. `projected`: see Elasticity::tangent. Followers in p are first put where
  /// their masters are, here and in tangent().
  void product(const State<B>& state, const Vectors<B>& p, const ImplicitWeights& weights,
               bool projected, const Vectors<B>& q) const;
  /// Adds to q what contact and a caller's forces add to A p.
  void add_product_beside_elements(const Vectors<B>& p, const ImplicitWeights& weights,
                                   const Vectors<B>& q) const;
  /// Returns whether contact or a caller's forces act on the level.
  bool acts_beside_elements() const {
    return contact_ || external_ || has_terms(TermStiffness::assembled);
  }
  /// Adds to q what assemble() leaves out of A p: pressures that follow the body, and contact that
  /// couples several tetrahedra.
  void add_product_beside_matrix(const State<B>& state, const Vectors<B>& p,
                                 const ImplicitWeights& weights, bool projected,
                                 const Vectors<B>& q) const;
  /// Returns whether assemble() leaves nothing out of A.
  bool is_all_in_matrix() const {
    return !has_terms(TermStiffness::unassembled) && !(contact_ && contact_->couples());
  }
  /// Computes A's vertex blocks without those of contact, [vertices][6] xx yy zz xy xz yz; see
  /// Elasticity::diagonal.
  void diagonal(const State<B>& state, const ImplicitWeights& weights, bool projected,
                const Blocks<B>& blocks) const;
  /// Assembles A in blocks; with nodal elements, that of the linear elements of the same mesh.
  /// `projected`: the elements' tangents are projected to positive semi-definite ones.
  void assemble(const State<B>& state, const ImplicitWeights& weights, bool projected,
                const PatchPairs<B>& pairs, const Blocks9<B>& shares,
                const BlockMatrix<B>& A) const;
  /// Computes and stores the projected tangents of the state that was linearised last, where
  /// elements keep them. Overwrites `partial`.
  void keep_tangents(const State<B>& state);
  /// Computes partial = the shares of -K p at a state; see Elasticity::tangent. On one of several
  /// ranks, shares of others are received.
  void tangent(const State<B>& state, const Vectors<B>& p, double damping_scale = 0,
               bool projected = false) const;

  /// Computes the energy [J] whose derivative gives the elastic forces of the last evaluation, in
  /// the x components of `partial`. On one of several ranks, shares of others are received.
  void incremental_energy(const State<B>& state) const;

  /// Runs work() and adds its time to a stage of this level.
  template <class Work>
  void timed(const char* stage, const Work& work) const {
    clock_->time(stage, number_, work);
  }
  const Elasticity<B>& elasticity() const { return *elasticity_; }
  const Contact<B>* contact() const { return contact_.get(); }
  ContactResponse<B>& response() { return response_; }
  const ContactResponse<B>& response() const { return response_; }
  bool asks_caller() const { return static_cast<bool>(external_); }
  long evaluations() const { return evaluations_; }
  /// Sets the number of evaluations so far, of a level that goes on from another one.
  void set_evaluations(long count) { evaluations_ = count; }
  /// Sets the function that adds a caller's forces from now on; an empty one ends that. `rest`: the
  /// level's vertices at rest [m].
  void set_external(const ExternalForces<B>& forces, const Vectors<B>& rest);
  /// Sets a constant force [N] that is part of every evaluation from now on; an empty one ends
  /// that.
  void set_correction(const Vectors<B>& force) { correction_ = force; }
  void add_correction(const Vectors<B>& f) const;
  /// Forgets what is carried from one macro step to the next, which does not belong to a state that
  /// was replaced.
  void reset_history();
  /// Names to the archive what the level and its integrator carry from one macro step to the next.
  /// `name`: "level 0's ".
  void name_fields(Archive<B>& archive, const std::string& name);
  /// Begins a macro step: numbers evaluations from 1 again, for the element flags, and sets the
  /// impulses to zero. `part`: its length over that of a whole macro step.
  void begin_macro_step(double part = 1) {
    evaluation_ = 0;
    response_.set_part(part);
    if (contact_) response_.forget_impulse(exec());
  }

 private:
  StageTimer<B>* clock_;
  int number_;
  std::shared_ptr<const Elasticity<B>> elasticity_;
  Vec3<typename B::Real> gravity_;
  std::shared_ptr<const Contact<B>> contact_;
  ContactResponse<B> response_;
  bool implicit_ = false;
  ExternalForces<B> external_;
  Vectors<B> rest_;
  Vectors<B> correction_;
  Blocks<B> external_stiffness_;  ///< only on implicit levels
  long evaluations_ = 0;
  int evaluation_ = 0;
  Vectors<B> linearised_;  ///< displacements whose gradients are kept

  void element_force(const State<B>& state, double time, const Vectors<B>& f);
  /// Hands to their masters the forces on followers that are not from elements. Contact has none.
  void collect(const Vectors<B>& f) const;
  /// Returns the displacements from which tangents are computed: none where gradients of them are
  /// kept.
  Vectors<B> state_or_cached(const State<B>& at) const {
    return linearised_.extent(0) > 0 && linearised_.data() == at.u.data() ? Vectors<B>() : at.u;
  }
  void ask_caller(const State<B>& state, double time, double step, double ahead,
                  const Vectors<B>& f);
};

}  // namespace plica
