// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <memory>
#include <plica/core/level.hpp>
#include <plica/core/small.hpp>
#include <plica/drivers/solver/contact.hpp>
#include <plica/drivers/solver/elasticity.hpp>
#include <plica/drivers/solver/external_forces.hpp>
#include <plica/drivers/solver/stage_clock.hpp>
#include <plica/drivers/solver/state_archive.hpp>

namespace plica {

/// All forces on one level: internal, gravity, loads, contact, the caller's. What the scene does not have is not there.
template <class B>
class LevelForces {
 public:
  using Exec = typename B::Exec;

  LevelForces(std::shared_ptr<const Elasticity<B>> elasticity, const Point& gravity,
              std::shared_ptr<const Contact<B>> contact, bool implicit, StageClock<B>* clock, int level);

  /// f = the forces of a state of this level at a time [s].
  void evaluate(const Level<B>& level, const State<B>& state, double time, const Vectors<B>& f);
  /// The same but for contact.
  void evaluate_without_contact(const Level<B>& level, const State<B>& state, double time, const Vectors<B>& f);

  /// f = those that do not depend on the state: gravity, loads, a correction.
  void dead(const Level<B>& level, double time, const Vectors<B>& f) const;

  /// Linearises about a state for an implicit stage: f as above with loads and contact `ahead` of it [s].
  void linearise(const Level<B>& level, const State<B>& state, double time, const ImplicitWeights& weights,
                 double ahead, const Vectors<B>& f);
  /// q = A p, A = (1 + b c) M + a K + contact at the linearised state; see ImplicitWeights.
  void product(const Level<B>& level, const State<B>& state, const Vectors<B>& p, const ImplicitWeights& weights,
               const Vectors<B>& q) const;
  /// A's vertex blocks, [vertices][6] xx yy zz xy xz yz.
  void diagonal(const Level<B>& level, const State<B>& state, const ImplicitWeights& weights,
                const Blocks<B>& blocks) const;
  /// A itself, in blocks; `positive`: of elements whose tangents are projected to positive semi-definite ones.
  void assemble(const Level<B>& level, const State<B>& state, const ImplicitWeights& weights, bool positive,
                const PatchPairs<B>& pairs, const Blocks9<B>& shares, const BlockMatrix<B>& A) const;
  /// level.partial = the copies of -K p at a state; `over`: with the stiffness that damps times this [1/s].
  void tangent(const Level<B>& level, const State<B>& state, const Vectors<B>& p, double over = 0) const;

  /// Books work() under a stage of this level.
  template <class Work>
  void book(const char* stage, const Work& work) const {
    clock_->time(stage, level_, work);
  }
  const Elasticity<B>& elasticity() const { return *elasticity_; }
  const Contact<B>* contact() const { return contact_.get(); }
  const ContactPoints<B>& points() const { return points_; }
  bool asks_caller() const { return static_cast<bool>(external_); }
  long evaluations() const { return evaluations_; }
  /// Asks `forces` from now on, if there is any function in it; `rest`: the level's vertices at rest [m].
  void set_external(const ExternalForces<B>& forces, const Vectors<B>& rest);
  /// A constant force [N] that is part of every evaluation from now on; an empty one ends that.
  void set_correction(const Vectors<B>& force) { correction_ = force; }
  void add_correction(const Vectors<B>& f) const;
  void persist(StateArchive<B>& archive) { archive.number(evaluations_); }
  /// Evaluations are numbered from 1 in each macro step, for the element flags.
  void begin_macro_step() { evaluation_ = 0; }

 private:
  std::shared_ptr<const Elasticity<B>> elasticity_;
  Vec3<typename B::Real> gravity_;
  std::shared_ptr<const Contact<B>> contact_;
  ContactPoints<B> points_;
  bool implicit_;
  StageClock<B>* clock_;
  int level_;
  ExternalForces<B> external_;
  Vectors<B> rest_;
  Vectors<B> correction_;
  Blocks<B> external_stiffness_;  ///< implicit levels only
  long evaluations_ = 0;
  int evaluation_ = 0;

  void elastic_and_gravity(const Level<B>& level, const State<B>& state, const Vectors<B>& f);
  void ask_caller(const Level<B>& level, const State<B>& state, double time, double step, double ahead,
                  const Vectors<B>& f);
  void add_loads(const Level<B>& level, double time, const Vectors<B>& f) const;
};

}  // namespace plica
