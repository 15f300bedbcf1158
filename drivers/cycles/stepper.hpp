// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <map>
#include <plica/core/reports.hpp>
#include <plica/drivers/contact/contact.hpp>
#include <plica/drivers/cycles/hierarchy.hpp>
#include <plica/drivers/elastic/level_constants.hpp>
#include <plica/drivers/methods/steppers.hpp>
#include <plica/meshes/embedding.hpp>

namespace plica {

/// What set-up hands to a stepper's plan, level by level, finest first; and what the plan decides.
template <class B>
struct StepperSetup {
  const Problem& problem;
  /// its levels that are integrated, with forces and integrators
  Hierarchy<B>& hierarchy;
  const std::vector<TetMesh>& meshes;               ///< placed, of all levels in use
  const std::vector<LevelConstants>& constants;     ///< of these meshes
  const std::vector<Embedding>& up;                 ///< [i]: level i-1's vertices in level i
  std::shared_ptr<const Elasticity<B>> elasticity;  ///< of the finest level
  /// largest_eigenvalue() of the finest level at rest [1/s^2]
  double eigenvalue;
  std::shared_ptr<const Contact<B>> contact;  ///< none without obstacles
  std::vector<LevelReport>& reports;          ///< of all levels in use; completed by the plan
  double macro_step = 0;                      ///< [s], by the plan
  std::optional<HimReport> him = {};          ///< by the plan of that stepper
};

/// How the levels take a macro step together. The paper's cycles share it out among the levels
/// (shared_step/), the hierarchical inverse mass (him/) steps the finest level, with an inertia
/// that all levels contribute to. The code that holds a stepper does not depend on which one it is.
/// In the order of a run:
///
///   plan     at set-up: the macro step, what each level does in it, work arrays
///   start    once, from the state that set-up has made
///   step     macro steps
///   check    lost_stability(), which may be true before the state is bad; repair() makes the next steps stable, lengthen() takes
///            that back
///   report   counters(), bytes(); persist() for checkpoints
template <class B>
class Stepper {
 public:
  virtual ~Stepper() = default;

  /// Decides the macro step and each level's part of it, allocates what that needs and completes
  /// the reports. InputError with the numbers where no such step is stable.
  virtual void plan(StepperSetup<B>& setup) = 0;

  /// Makes the coarser levels' states follow level 0's, which was just set.
  virtual void begin(Hierarchy<B>& hierarchy) = 0;
  /// The same at the very start, where it may also change level 0's velocities into what it can
  /// carry.
  virtual void start(Hierarchy<B>& hierarchy) { begin(hierarchy); }
  /// From `time` over `t` [s].
  virtual void step(Hierarchy<B>& hierarchy, double time, double t) = 0;

  /// Whether steps so far have lost stability, after macro steps. Waits. `kinetic`: level 0's
  /// energy of motion about its mean [J]
  virtual bool lost_stability(const Hierarchy<B>&, double /*kinetic*/) { return false; }
  /// Whether that is seen only when it has been going on for a while.
  virtual bool sees_late() const { return false; }
  /// Whether repair() can ever help.
  virtual bool can_repair() const { return false; }
  /// Whether it may where a check has found this.
  virtual bool repairs(const Diagnosis&) const { return false; }
  /// Makes steps of `t` [s] stable again, by shorter ones within them, starting from the present
  /// state; false where it cannot.
  virtual bool repair(Hierarchy<B>&, double) { return false; }
  /// Takes back what repair() has cut as far as the present state, which has passed its check, does
  /// not need it any more. `steps`: macro steps of the run so far. It is tried now and then, see
  /// Regaining; waits then.
  virtual void lengthen(Hierarchy<B>&, double /*t*/, long /*steps*/) {}
  /// Into how many parts repairs have cut the plan's sub-steps.
  virtual int parts() const { return 1; }

  virtual std::map<std::string, long> counters() const { return {}; }
  /// Device memory of its own.
  virtual std::size_t bytes() const { return 0; }
  /// Names what it carries from one macro step to the next, besides the levels' states.
  virtual void persist(StateArchive<B>&) {}
};

}  // namespace plica
