// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <functional>
#include <limits>
#include <memory>
#include <plica/core/implicit_weights.hpp>
#include <plica/core/matrices.hpp>
#include <plica/core/state_archive.hpp>
#include <plica/drivers/contact/contact.hpp>
#include <plica/kernels/contact/contact_list.hpp>

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

/// How an implicit stage takes contact, which acts over the whole step h: in a stage of weights a,
/// b the contact's impulse is h F, and its way is that to the end of the step.
struct ContactStage {
  double span = 0;    ///< h [s]
  double factor = 1;  ///< of contact's forces in the stage: h / b where they are not carried on
  double scale = 1;   ///< of ways, from the stage to the end of the step
};

/// What contact's forces are at a state of an implicit stage.
struct ContactBalance {
  double energy = 0;   ///< of the incremental potential, times the stage's factor [J]
  double lacking = 0;  ///< what friction's caps are away from mu times the normal forces [N]
  double forces = 0;   ///< sum of their sizes [N]
};

/// Contact of one level in steps that take it implicitly: the forces on its surface points, and
/// what obstacles do to it. Kernels alone, which the device leaves out where nothing touches.
template <class B>
class ContactResponse {
 public:
  using Exec = typename B::Exec;
  using Real = typename B::Real;
  /// Answers the points' forces by accelerations of the vertices, where `count` is above 0.
  using Respond = std::function<void()>;

  ContactResponse() = default;
  ContactResponse(std::shared_ptr<const Contact<B>> contact, const Level<B>& level, bool implicit);

  /// f += contact's forces on a state at `time`, which f are all other forces on; A is the inverse
  /// of the lumped masses.
  void add_forces(const Exec& exec, const Level<B>& level, const State<B>& state, double time,
                  const ContactStep& step, const Vectors<B>& f);
  /// The forces of the records, for any other A: `free` are the accelerations without contact,
  /// respond() makes those by the records' last forces, in `answer`; `bounding`: of unit forces, by
  /// absolute weights.
  void resolve(const Exec& exec, const Level<B>& level, const State<B>& state, double time,
               const ContactStep& step, const Vectors<B>& free, const Vectors<B>& answer,
               const Respond& respond);

  /// Of which part of a macro step the next ones are: a shorter step takes the forces that a whole
  /// one would. Sweeps leave a contact softer the longer the step, so that in a short one overlap
  /// that was at rest would be pushed out at once.
  void set_part(double part) { part_ = part; }

  /// The impulse of each obstacle: forgotten, and the last forces times `weight` [s] added to it,
  /// or as a method carries them on.
  void forget_impulse(const Exec& exec) const;
  void add_impulse(const Exec& exec, const Level<B>& level, const State<B>& state, double time,
                   double weight) const;
  void add_impulse(const Exec& exec, const Level<B>& level, const State<B>& state, double time,
                   const CarriedImpulse& of) const;
  /// [6 obstacles, then bodies] N s and N m s
  const Doubles<B>& impulse() const { return impulse_; }
  /// Stored in all contact of the level's state [J]. Waits.
  double energy(const Exec& exec, const Level<B>& level, double time) const;
  /// Done by friction in all steps so far [J]. Waits.
  double friction_work(const Exec& exec) const;
  /// Of each obstacle the part of what touches it that slips. Waits.
  std::vector<double> slipping(const Exec& exec) const;
  /// Of each obstacle, then of pairs; see Simulation::contact_depths(). Waits.
  std::vector<double> depths(const Exec& exec, const Level<B>& level, double time) const;
  /// Takes hold of what is near an obstacle.
  void grasp(const Exec& exec, const Level<B>& level, double time, int obstacle) const {
    contact_->grasp(exec, level, time, obstacle, records_);
  }

  // Of implicit levels, see kernels/contact/implicit_contact.hpp:

  /// Finds the records of a step from a state at `time`.
  void begin_stage(const Exec& exec, const Level<B>& level, const State<B>& state, double time,
                   const ContactStage&);
  /// f += the records' forces at a state, `ahead` of it [s], and their blocks for a system of these
  /// weights; `secant`: see LineariseContact. Waits.
  ContactBalance linearise(const Exec& exec, const Level<B>& level, const State<B>& state,
                           const ImplicitWeights&, double ahead, const Vectors<B>& f,
                           bool secant = false);
  /// At a state, with the caps as they are. Waits.
  ContactBalance balance(const Exec& exec, const Level<B>& level, const State<B>& state);
  /// Caps become those of the normal forces at a state.
  void update_caps(const Exec& exec, const Level<B>& level, const State<B>& state) const;
  /// The step ends in a state: its forces are the last, and what is carried goes on.
  void end_stage(const Exec& exec, const Level<B>& level, const State<B>& state) const;
  /// f += W^T of the last forces times the stage's factor
  void add_last_forces(const Exec& exec, const Level<B>& level, const Vectors<B>& f) const {
    scatter(exec, level, f, stage_.factor);
  }
  const ContactStage& stage() const { return stage_; }
  /// Stored in the contact that a step from a state at `time` would start with [J]; the records
  /// stay those of the last step. Waits.
  double energy_found(const Exec& exec, const Level<B>& level, const State<B>& state, double time);
  /// q += W^T C W p; `beside`: of what add_matrix() leaves out alone
  void add_product(const Exec& exec, const Level<B>& level, const Vectors<B>& p, bool beside,
                   const Vectors<B>& q) const;
  /// diagonal += its vertex blocks, likewise
  void add_diagonal(const Exec& exec, const Level<B>& level, bool beside,
                    const Blocks<B>& diagonal) const;
  /// A += scale W^T C W, of points that touch obstacles
  void add_matrix(const Exec& exec, const Level<B>& level, double scale,
                  const BlockMatrix<B>& A) const;

  const ContactRecords<B>& records() const { return records_; }
  std::size_t bytes() const;
  /// What a step takes from the last: forgotten, saved, kept and put back.
  /// @{
  void forget(const Exec& exec);
  void persist(StateArchive<B>& archive, const std::string& name);
  struct Kept {
    std::vector<Indices<B>> indices;
    std::vector<Scalars<B>> reals;
    Doubles<B> work;
    double found = 0;
    bool fresh = true;
    void persist(StateArchive<B>& archive) {
      for (const auto& field : indices) archive.field("kept contact", field);
      for (const auto& field : reals) archive.field("kept contact", field);
      archive.field("kept work of friction", work);
      archive.number(found), archive.number(fresh);
    }
  };
  void keep(const Exec& exec, Kept& to) const;
  void put_back(const Exec& exec, const Level<B>& level, const Kept& from);
  /// @}

 private:
  std::shared_ptr<const Contact<B>> contact_;
  /// records_: own_ as kernels are given it, `span`: of the last step
  ContactRecords<B> own_, records_;
  Vectors<B> product_;                           ///< [slots][3] on implicit levels
  std::shared_ptr<const PairSearch<B>> search_;  ///< with pairs
  ListMaker<B> maker_;
  BlockSums<B> blocks_;
  Vectors<B> free_, answer_;  ///< of the vertices, on explicit levels
  Doubles<B> sums_, impulse_, carried_impulse_, work_;
  ContactStage stage_;
  Kept aside_;                   ///< the last step's records, while others are looked at
  double part_ = 1, found_ = 0;  ///< found_: the time of the state that the records are of [s]
  bool fresh_ = true;            ///< nothing is known of a last step

  void solve(const Exec& exec, const Level<B>& level, const State<B>& state, double time,
             const ContactStep& step, ExplicitContact<B> contact, const Respond& respond,
             const std::function<void()>& free);
  void find(const Exec& exec, const Level<B>& level, const State<B>& state, double time);
  void look(const Exec& exec, const Level<B>& level, const State<B>& state, double time) const;
  RecordLater<B> later(const Exec& exec, const Level<B>& level, double time) const;
  template <class End>
  void end(const Exec& exec, const char* label, const End& kernel) const;
  void scatter(const Exec& exec, const Level<B>& level, const Vectors<B>& f,
               double factor = 1) const;
  ImplicitContact<B> at(const Level<B>& level, const State<B>& state, double ahead) const;
  ContactBalance read_balance(const Exec& exec) const;
  /// use(name, field) for what is carried from step to step.
  template <class Use>
  void each_carried(const Use& use) const;
};

}  // namespace plica
