// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <memory>
#include <plica/core/level.hpp>
#include <plica/core/small.hpp>
#include <plica/core/stage_clock.hpp>
#include <plica/core/state_archive.hpp>
#include <plica/drivers/contact/contact_response.hpp>
#include <plica/drivers/elastic/elasticity.hpp>
#include <plica/drivers/elastic/viscosity.hpp>
#include <plica/drivers/loads/external_forces.hpp>
#include <plica/kernels/loads/follower_pressure.hpp>

namespace plica {

template <class B>
class Integrator;

/// One resolution of the body at work: its data, all forces on it (internal, gravity, loads,
/// contact, the caller's), what integrates it and its part of the macro step. Forces that the scene
/// does not have are not there. Kernels go to the hierarchy's instance, whose clock books their
/// time under this level's number.
template <class B>
class SolverLevel : public Level<B> {
 public:
  using Exec = typename B::Exec;

  /// A level without forces or integrator yet. The clock must outlive it.
  SolverLevel(Level<B>&& data, StageClock<B>& clock, int number);
  SolverLevel(SolverLevel&&) noexcept;
  ~SolverLevel();

  /// What acts on it from now on. `implicit`: it will be linearised.
  void set_forces(std::shared_ptr<const Elasticity<B>> elasticity, const Point& gravity,
                  std::shared_ptr<const Contact<B>> contact, bool implicit);

  std::unique_ptr<Integrator<B>> integrator;
  std::unique_ptr<Viscosity<B>> viscosity;  ///< of viscous materials only
  double share = 1;                         ///< of the macro step
  int substeps = 1;                         ///< in its share

  const Exec& exec() const { return clock_->exec(); }

  /// The level's state at this time [s] is one that it has been through: what relaxes takes it into
  /// account. At the start of every step, and wherever else a state is final.
  void remember(double time) const {
    if (viscosity) viscosity->remember(exec(), *this, *elasticity_, this->state.u, time);
  }

  /// f = the forces of a state of this level at a time [s], contact as `step` takes it: by default
  /// that of a state that stays. They act for `weight` of the time [s], which is what the
  /// obstacles' impulse counts.
  void evaluate(const State<B>& state, double time, const Vectors<B>& f,
                const ContactStep& step = {}, double weight = 0);
  /// The same but for contact.
  void evaluate_without_contact(const State<B>& state, double time, const Vectors<B>& f);
  /// Counts the last evaluation's contact for `weight` more [s]; at the level's state.
  void add_last_impulse(double time, double weight) const {
    response_.add_impulse(exec(), *this, this->state, time, weight);
  }
  /// Counts the contact of an implicit step's end, at the level's state.
  void count_contact(double time, const CarriedImpulse& of);

  /// Volumes and pressures of its cavities at its state; waits.
  std::vector<CavityState> cavities(double time) const;
  /// Of pressures that follow it, at its state [J]: what their forces are the negative derivative
  /// of, where their triangles enclose a volume; waits there.
  double follower_energy(double time) const;
  /// q += scale K p, K the stiffness of the pressures that follow the body, at the state and time
  /// of the last evaluation: its symmetric part, with `positive` that of the fluids alone.
  void add_follower_product(const State<B>& state, const Vectors<B>& p, double scale, bool positive,
                            const Vectors<B>& q) const;

  /// f = those that do not depend on the state: gravity, loads, a correction.
  void dead(double time, const Vectors<B>& f) const;

  /// Linearises about a state for an implicit stage: f as above with loads `ahead` of it [s],
  /// without contact.
  void linearise(const State<B>& state, double time, const ImplicitWeights& weights, double ahead,
                 const Vectors<B>& f);
  /// q = A p, A = (1 + b c) M + a K + contact at the linearised state; see ImplicitWeights.
  /// `positive`: see Elasticity::tangent.
  void product(const State<B>& state, const Vectors<B>& p, const ImplicitWeights& weights,
               bool positive, const Vectors<B>& q) const;
  /// q += what contact and a caller's forces add to it
  void add_product_beside_elements(const Vectors<B>& p, const ImplicitWeights& weights,
                                   const Vectors<B>& q) const;
  bool acts_beside_elements() const { return contact_ || external_; }
  /// q += what of that assemble() leaves out: pressures that follow the body, and contact that
  /// couples several tetrahedra.
  void add_product_beside_matrix(const State<B>& state, const Vectors<B>& p,
                                 const ImplicitWeights& weights, bool positive,
                                 const Vectors<B>& q) const;
  bool is_all_in_matrix() const {
    return this->followers.empty() && !(contact_ && contact_->couples());
  }
  /// A's vertex blocks but for contact's, [vertices][6] xx yy zz xy xz yz; see
  /// Elasticity::diagonal.
  void diagonal(const State<B>& state, const ImplicitWeights& weights, bool positive,
                const Blocks<B>& blocks) const;
  /// A itself, in blocks, with nodal elements that of linear ones; `positive`: of elements whose
  /// tangents are projected to positive semi-definite ones.
  void assemble(const State<B>& state, const ImplicitWeights& weights, bool positive,
                const PatchPairs<B>& pairs, const Blocks9<B>& shares,
                const BlockMatrix<B>& A) const;
  /// Projected tangents of the state that was linearised last, where elements keep them.
  void keep_tangents();
  /// partial = the shares of -K p at a state; see Elasticity::tangent.
  void tangent(const State<B>& state, const Vectors<B>& p, double over = 0,
               bool positive = false) const;

  /// The energy [J] whose derivative the elastic forces of the last evaluation are, in the x
  /// components of `partial`.
  void incremental_energy(const State<B>& state) const;

  /// Books work() under a stage of this level.
  template <class Work>
  void book(const char* stage, const Work& work) const {
    clock_->time(stage, number_, work);
  }
  const Elasticity<B>& elasticity() const { return *elasticity_; }
  const Contact<B>* contact() const { return contact_.get(); }
  ContactResponse<B>& response() { return response_; }
  const ContactResponse<B>& response() const { return response_; }
  bool asks_caller() const { return static_cast<bool>(external_); }
  long evaluations() const { return evaluations_; }
  /// Asks `forces` from now on, if there is any function in it; `rest`: the level's vertices at
  /// rest [m].
  void set_external(const ExternalForces<B>& forces, const Vectors<B>& rest);
  /// A constant force [N] that is part of every evaluation from now on; an empty one ends that.
  void set_correction(const Vectors<B>& force) { correction_ = force; }
  void add_correction(const Vectors<B>& f) const;
  /// What it carries from one macro step to the next, where the state was set.
  void forget();
  /// Names what it carries from one macro step to the next, its integrator's included; `name`:
  /// "level 0's ".
  void persist(StateArchive<B>& archive, const std::string& name);
  /// Evaluations are numbered from 1 in each macro step, for the element flags; impulses are
  /// counted anew. `part`: of a whole step.
  void begin_macro_step(double part = 1) {
    evaluation_ = 0;
    response_.set_part(part);
    if (contact_) response_.forget_impulse(exec());
  }

 private:
  StageClock<B>* clock_;
  int number_;
  std::shared_ptr<const Elasticity<B>> elasticity_;
  Vec3<typename B::Real> gravity_;
  std::shared_ptr<const Contact<B>> contact_;
  ContactResponse<B> response_;
  bool implicit_ = false;
  ExternalForces<B> external_;
  Vectors<B> rest_;
  Vectors<B> correction_;
  Blocks<B> external_stiffness_;  ///< implicit levels only
  long evaluations_ = 0;
  int evaluation_ = 0;
  BlockSums<B> volumes_;      ///< of cavities
  Doubles<B> rate_;           ///< [1] likewise
  double follower_time_ = 0;  ///< when pressures were last asked for [s]
  Vectors<B> linearised_;     ///< what gradients are kept of

  void elastic_and_gravity(const State<B>& state, double time, const Vectors<B>& f);
  /// A state as tangents take it: none where gradients of it are kept.
  Vectors<B> unless_kept(const State<B>& at) const {
    return linearised_.extent(0) > 0 && linearised_.data() == at.u.data() ? Vectors<B>() : at.u;
  }
  void ask_caller(const State<B>& state, double time, double step, double ahead,
                  const Vectors<B>& f);
  void add_loads(double time, const Vectors<B>& f) const;
  /// Pressures that follow the state.
  void add_followers(const State<B>& state, double time, const Vectors<B>& f);
  GivenPressure<B> given_pressure(const FollowerLoad<B>& load, double time) const;
  void measure(const FollowerLoad<B>& load, const Vectors<B>& u) const;
  /// at its state, up to a constant [m^3]
  double enclosed_volume(const FollowerLoad<B>& load) const;
  /// Of the volume that was last measured.
  FluidPressure<B> last_pressure(const FollowerLoad<B>& load, double time) const;
  /// Of a cavity, up to its caps [m^3].
  double volume_given(const FollowerLoad<B>& load, double time) const;
};

}  // namespace plica
