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

/// Input of a stepper's plan, level by level, finest first, and the results of the plan.
template <class B>
struct StepperSetup {
  const Problem& problem;
  /// levels that are integrated, with forces and integrators
  Hierarchy<B>& hierarchy;
  const std::vector<TetMesh>& meshes;               ///< placed meshes of all levels in use
  const std::vector<LevelConstants>& constants;     ///< constants of each of the meshes
  const std::vector<Embedding>& up;                 ///< [i]: level i-1's vertices in level i
  std::shared_ptr<const Elasticity<B>> elasticity;  ///< elasticity of the finest level
  /// largest_eigenvalue() of the finest level at rest [1/s^2]
  double eigenvalue;
  std::shared_ptr<const Contact<B>> contact;  ///< none without obstacles
  std::vector<LevelReport>& reports;          ///< all levels in use; completed by the plan
  /// True: the body goes on after a cut. Where the given macro step is not stable any more, a
  /// stepper that can repair plans shorter steps within it
  bool goes_on = false;
  double macro_step = 0;              ///< [s], set by the plan
  std::optional<HimReport> him = {};  ///< set by the plan of the stepper `him`
};

/// Method by which the levels take a macro step together.
/// The cycles of shared_step.hpp give each level a share of the macro step. The hierarchical
/// inverse mass (him/) steps the finest level, with an inertia that all levels contribute to. Code
/// that uses a stepper does not depend on which one it is. The functions in the order of a run:
///
///   plan     at set-up: the macro step, what each level does in it, work arrays
///   start    once, from the state that set-up has made
///   step     macro steps
///   check    lost_stability(), which may be true before the state is bad; repair() makes the
///            next steps stable, and regrow() takes that back
///   report   counters(); name_fields() for checkpoints and the memory
template <class B>
class Stepper {
 public:
  virtual ~Stepper() = default;

  /// Decides the macro step and each level's part of it, allocates fields, completes the reports.
  /// Throws InputError with the numbers where no such step is stable.
  virtual void plan(StepperSetup<B>& setup) = 0;

  /// Sets the coarser levels' states by level 0's state, which was set before.
  virtual void begin(Hierarchy<B>& hierarchy) = 0;
  /// Sets the coarser levels' states by level 0's at the start of a run.
  /// May also change level 0's velocities into motion that the stepper can represent.
  virtual void start(Hierarchy<B>& hierarchy) { begin(hierarchy); }
  /// Takes a macro step of `t` [s] from `time` [s].
  virtual void step(Hierarchy<B>& hierarchy, double time, double t) = 0;

  /// Returns true where the steps so far have lost stability; called after macro steps. Waits.
  /// `kinetic`: level 0's energy of motion about its mean [J].
  virtual bool lost_stability(const Hierarchy<B>&, double /*kinetic*/) { return false; }
  /// Returns true where lost_stability() detects an instability only some time after it began.
  virtual bool detects_late() const { return false; }
  /// Returns true where repair() can ever help.
  virtual bool can_repair() const { return false; }
  /// Returns true where repair() may help against what a check has found.
  virtual bool repairs(const Diagnosis&) const { return false; }
  /// Makes macro steps of `t` [s] stable again, by shorter steps within them, from the present
  /// state. Returns false where it cannot.
  virtual bool repair(Hierarchy<B>&, double) { return false; }
  /// Makes steps that repair() has cut longer again, as far as the present state allows it.
  /// That state has passed its check. `steps`: macro steps of the run so far. Tries only now and
  /// then, see RegrowSchedule, and waits then.
  virtual void regrow(Hierarchy<B>&, double /*t*/, long /*steps*/) {}
  /// Returns into how many parts repairs have cut the plan's sub-steps.
  virtual int parts() const { return 1; }

  virtual std::map<std::string, long> counters() const { return {}; }
  /// Names the stepper's arrays and what it carries from one macro step to the next.
  /// The levels' states are not among these.
  virtual void name_fields(Archive<B>&) {}
};

}  // namespace plica
