// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <functional>
#include <limits>
#include <memory>
#include <plica/core/archive.hpp>
#include <plica/core/implicit_weights.hpp>
#include <plica/core/matrices.hpp>
#include <plica/drivers/contact/contact.hpp>
#include <plica/kernels/contact/contact_list.hpp>
#include <plica/kernels/contact/list_sums.hpp>

namespace plica {

template <class B>
class PairSearch;
template <class B>
struct RecordLater;
struct CarriedImpulse;
template <class B>
struct ExplicitContact;
template <class B>
struct ImplicitContact;

/// Times and factors of contact in an implicit stage. Contact acts over the whole step h.
/// In a stage of weights a, b the impulse of contact is h F. The way of a record is that to the end
/// of the step.
struct ContactStage {
  double span = 0;    ///< h [s]
  double factor = 1;  ///< scales contact's forces: h / b where they are not carried on
  double scale = 1;   ///< scales ways, from the stage to the end of the step
};

/// Sums over contact's forces at a state of an implicit stage.
struct ContactBalance {
  double energy = 0;  ///< incremental potential, times the stage's factor [J]
  double forces = 0;  ///< sum of the forces' sizes [N]
};

/// Contact of one level, implicit in each step: forces on surface points, impulses of obstacles.
/// All work is in kernels, which the device skips where nothing touches.
template <class B>
class ContactResponse {
 public:
  using Exec = typename B::Exec;
  using Real = typename B::Real;
  /// Finds the vertices' accelerations by the records' last forces, where anything touches.
  using Respond = std::function<void()>;

  ContactResponse() = default;
  ContactResponse(std::shared_ptr<const Contact<B>> contact, const LevelData<B>& level,
                  bool implicit);

  /// Adds contact's forces on a state at `time` [s] to f, which has all other forces [N].
  /// The inverse mass A is that of lumped masses. A step of span 0: contact of a state at rest.
  void add_forces(const Exec& exec, const LevelData<B>& level, const State<B>& state, double time,
                  const ContactStep& step, const Vectors<B>& f);
  /// Finds the forces of the records for any other inverse mass A.
  /// `free`: accelerations without contact [m/s^2]. respond() fills `answer`, the accelerations by
  /// the records' last forces [m/s^2]. On its first call these are unit forces, for which absolute
  /// weights bound the sum.
  void resolve(const Exec& exec, const LevelData<B>& level, const State<B>& state, double time,
               const ContactStep& step, const Vectors<B>& free, const Vectors<B>& answer,
               const Respond& respond);

  /// Sets the part of a macro step that each next step takes: 1, or less for a shorter step.
  /// A shorter step gets the forces of a whole one. Sweeps leave a contact softer the longer the
  /// step is. With its own forces a short step would push out at once the overlap that was at rest.
  void set_part(double part) { part_ = part; }

  /// Counts the records that touch on all ranks, for an inverse mass that couples their parts. Else
  /// each rank counts its own.
  void count_on_all_ranks() { counts_on_all_ = true; }

  /// Finds deepest places of triangles to rounding. Forces then change with the state without small
  /// jumps, so that they can balance to any part.
  void find_precisely() { records_.precise = true; }

  /// Sets the impulses of all obstacles and bodies to 0.
  void forget_impulse(const Exec& exec) const;
  /// Adds the last forces times `weight` [s] to the impulse of each obstacle and body.
  void add_impulse(const Exec& exec, const LevelData<B>& level, const State<B>& state, double time,
                   double weight) const;
  /// Adds the last forces to the impulses, for a method that carries forces from step to step.
  void add_impulse(const Exec& exec, const LevelData<B>& level, const State<B>& state, double time,
                   const CarriedImpulse& of) const;
  /// Finishes the sums of a macro step over all ranks: impulses, and the work of friction.
  void finish_sums(const Exec& exec) const { sums_of_records_.finish(exec); }
  /// Returns the impulses and angular impulses: [6 obstacles, then 6 bodies] N s and N m s.
  const Doubles<B>& impulse() const { return impulse_; }
  /// Returns the energy stored in all contact of the level's state [J]. Waits.
  /// It is that of the last forces, and without a last step that of the depths.
  double energy(const Exec& exec, const LevelData<B>& level, double time) const;
  /// Returns the energy that the law's springs have at the depths of the level's state [J]. Waits.
  double energy_by_depth(const Exec& exec, const LevelData<B>& level, double time) const;
  /// Returns the work of friction in all steps so far [J]. Waits.
  double friction_work(const Exec& exec) const;
  /// Returns for each obstacle which part of its touching records slips, 0 to 1. Waits.
  std::vector<double> slipping(const Exec& exec) const;
  /// Returns the largest depth in each obstacle, then in pairs [m]. Waits.
  /// See Simulation::contact_depths().
  std::vector<double> depths(const Exec& exec, const LevelData<B>& level, double time) const;
  /// Returns the sum of the last normal forces at each surface point, without ties [N]. Waits.
  std::vector<double> normal_forces(const Exec& exec) const;
  /// Grasps the points near an obstacle.
  void grasp(const Exec& exec, const LevelData<B>& level, double time, int obstacle) const {
    contact_->grasp(exec, level, time, obstacle, records_);
  }

  // For implicit levels only, see kernels/contact/implicit_contact.hpp:

  /// Finds the records of a step from a state at `time`.
  void begin_stage(const Exec& exec, const LevelData<B>& level, const State<B>& state, double time,
                   const ContactStage&);
  /// Adds the records' forces to f and makes their blocks for a system of these weights. Waits.
  /// The way of a record is taken `ahead` [s] of the state, with its velocities. `secant`: see
  /// LineariseContact.
  ContactBalance linearise(const Exec& exec, const LevelData<B>& level, const State<B>& state,
                           const ImplicitWeights&, double ahead, const Vectors<B>& f,
                           bool secant = false);
  /// Returns the sums over contact's forces at a state; the caps of friction stay. Waits.
  ContactBalance balance(const Exec& exec, const LevelData<B>& level, const State<B>& state);
  /// Sets the caps of friction to mu times the normal forces at a state.
  void update_caps(const Exec& exec, const LevelData<B>& level, const State<B>& state) const;
  /// Ends the step in a state: stores the forces there as the last ones, and the carried stretches.
  void end_stage(const Exec& exec, const LevelData<B>& level, const State<B>& state) const;
  /// Adds the last forces to the vertices: f += W^T F, times the stage's factor.
  void add_last_forces(const Exec& exec, const LevelData<B>& level, const Vectors<B>& f) const {
    scatter(exec, level, f, stage_.factor);
  }
  const ContactStage& stage() const { return stage_; }
  /// Returns the energy in the contact that a step from a state at `time` would start with [J].
  /// The records stay those of the last step. Waits.
  double energy_found(const Exec& exec, const LevelData<B>& level, const State<B>& state,
                      double time);
  /// Adds a product: q += W^T C W p. `beside`: only of records that add_matrix() leaves out.
  void add_product(const Exec& exec, const LevelData<B>& level, const Vectors<B>& p, bool beside,
                   const Vectors<B>& q) const;
  /// Adds the vertex blocks of W^T C W. `beside`: only of records that add_matrix() leaves out.
  void add_diagonal(const Exec& exec, const LevelData<B>& level, bool beside,
                    const Blocks<B>& diagonal) const;
  /// Adds to a matrix: A += scale W^T C W, of points that touch obstacles.
  void add_matrix(const Exec& exec, const LevelData<B>& level, double scale,
                  const BlockMatrix<B>& A) const;

  const ContactRecords<B>& records() const { return records_; }
  /// Goes on with the work of friction of a response before it.
  void take_work(const Exec& exec, const ContactResponse& before) const {
    copy(exec, work_, before.work_);
  }
  /// Forgets what a step takes from the last.
  void reset_history(const Exec& exec);
  /// Names what is carried from step to step. Where that is restored, lists the records again.
  void name_fields(Archive<B>& archive, const std::string& name, const Exec& exec,
                   const LevelData<B>& level);
  /// Names what a snapshot of the state needs. Where that is put back, lists the records again.
  void name_kept(Archive<B>& archive, const Exec& exec, const LevelData<B>& level);

 private:
  std::shared_ptr<const Contact<B>> contact_;
  /// own_ owns the arrays; records_ is the copy for kernels, with the span of the last step
  ContactRecords<B> own_, records_;
  Vectors<B> product_;                           ///< [slots][3] on implicit levels
  std::shared_ptr<const PairSearch<B>> search_;  ///< only where the surface may touch itself
  ListMaker<B> maker_;
  BlockSums<B> blocks_;  ///< block sums of this rank's own records
  BlockSums<B> common_;  ///< block sums of all ranks' records
  ListSums<B> sums_of_records_;
  Vectors<B> free_, answer_;  ///< [vertices][3] m/s^2, accelerations on explicit levels
  Doubles<B> sums_, impulse_, carried_impulse_, work_;
  ContactStage stage_;
  KeptValues<B> aside_;          ///< copy of the last step's records, in energy_found()
  double part_ = 1, found_ = 0;  ///< found_: time of the state that the records are of [s]
  bool counts_on_all_ = false;   ///< see count_on_all_ranks()
  bool fresh_ = true;            ///< true: no last step is known

  void solve(const Exec& exec, const LevelData<B>& level, const State<B>& state, double time,
             const ContactStep& step, ExplicitContact<B> contact, const Respond& respond,
             const std::function<void()>& free);
  void find(const Exec& exec, const LevelData<B>& level, const State<B>& state, double time);
  void look(const Exec& exec, const LevelData<B>& level, const State<B>& state, double time) const;
  RecordLater<B> later(const Exec& exec, const LevelData<B>& level, double time) const;
  double energy(const Exec& exec, const LevelData<B>& level, double time, bool by_force) const;
  template <class End>
  void end(const Exec& exec, const char* label, const End& kernel) const;
  void scatter(const Exec& exec, const LevelData<B>& level, const Vectors<B>& f,
               double factor = 1) const;
  ImplicitContact<B> at(const LevelData<B>& level, const State<B>& state, double ahead) const;
  ContactBalance read_balance(const Exec& exec) const;
  void name_records(Archive<B>& archive, const std::string& name) const;
};

}  // namespace plica
