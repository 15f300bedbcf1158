// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <functional>
#include <limits>
#include <optional>
#include <plica/core/problem.hpp>
#include <plica/drivers/run/simulation.hpp>
#include <string>
#include <vector>

namespace plica {

/// Result of one trial: a cycle at one macro step.
struct CycleTrial {
  std::string cycle;         ///< name of the cycle
  double macro_step = 0;     ///< [s]
  double over_critical = 0;  ///< macro step over the finest level's critical step
  /// relative error (L2) of level 0's displacement in the trial; none: there is no number
  std::optional<double> error;
  /// why the trial cannot be used, or was taken without an error; empty otherwise
  std::string reason;
  double set_up_time = 0;  ///< [s]
  double step_time = 0;    ///< median wall time of a macro step [s]
  /// predicted wall time of the whole run, set-up included [s]. Where the run has no end: that of
  /// one simulated second
  double run_time = 0;
};

/// Cycle and macro step that `integration.cycle: auto` has chosen.
struct CycleChoice {
  std::string cycle;         ///< him | single
  double macro_step = 0;     ///< [s]; with `single` the automatic macro step
  double over_critical = 0;  ///< macro step over the finest level's critical step
  std::string error_class;   ///< error class that the problem asks for
  double allowed = 0;        ///< error that the error class allows, relative
  double duration = 0;       ///< simulated time of a trial [s]; 0: nothing was tried
  /// simulated time at which the trials begin [s]. Above 0 it is shortly before the body first
  /// touches something, or at its largest deformation
  double start = 0;
  /// trials in the order they were run; first level 0 alone, which gives the reference
  std::vector<CycleTrial> trials;
  std::string reason;  ///< why this was chosen, one sentence
  /// true where the trials did not see what the run will do, above all contact
  bool provisional = false;
  /// wall time of the run by level 0 alone, predicted from 32 of its steps [s]; 0: not timed
  double single_time = 0;
  double spent = 0;  ///< wall time spent on timing and trials [s]

  /// Returns the keys of `integration` that repeat the run bit for bit, for example
  /// "cycle: him, macro_step: 0.0025 s".
  std::string keys() const;
};

/// Run length and clock on which a choice depends besides the problem.
struct ChoiceOptions {
  /// simulated time of the run [s] > 0; infinity: not known, and long
  double duration = std::numeric_limits<double>::infinity();
  /// clock that measures wall times [s]; none: the machine's
  std::function<double()> clock = {};
};

/// Fraction of the wall time of the run by level 0 alone that timing and trials may take
inline constexpr double trial_part = 0.1;

/// Returns the problem solved by level 0 alone, in its automatic step. This is the choice where
/// nothing else pays. Returns a problem with any other cycle than auto unchanged.
Problem level_0_alone(Problem problem);

/// Chooses cycle and macro step for `integration.cycle: auto`; none for any other cycle. Call it
/// before a Simulation is constructed, and construct the Simulation with the problem that
/// with_choice() returns.
///
/// Level 0 alone is taken without trials where there is no other level, and where him cannot step
/// the problem: see refused_by_him(). It is also taken where the run is so short that timing and
/// trials could take more than trial_part of it.
///
/// Else short runs over 128 critical steps decide. Level 0 alone (central differences at 0.45 of
/// the critical step) is the reference. Cycle `him` is tried at 8 critical steps, then at 16 and
/// 32, or at 4 and 2. Trials go on as long as a trial costs less than it can gain and all of them
/// cost less than trial_part of the run.
///
/// The trials begin shortly before the body first touches something. Where it moves rigidly until
/// then, first_touch() gives the time, and the place is known. Else the coarsest level alone looks
/// for the touch, for 5 % of the run. Without contact the trials begin where the deformation of
/// level 0 alone is largest in that time. Where contact is expected and the trials see none, macro
/// steps are at most 4 critical steps, and the choice is provisional.
///
/// The trial with the least predicted run time, set-up included, is taken among those whose error
/// is within the error class. A run that is refused, diverges, makes energy or has to cut its steps
/// is not taken. Wall times matter, so a second call may choose differently: CycleChoice::keys()
/// pins the choice. The trials do not include what a caller changes later (forces, states).
///
/// Throws InputError for a problem that is not valid, and where level 0 alone cannot be set up.
template <class B>
std::optional<CycleChoice> choose_cycle(const Problem& problem, const ChoiceOptions& options,
                                        const typename B::Exec& exec = {});

/// Chooses cycle and macro step for `integration.cycle: auto`, with a given simulation; none for
/// any other cycle.
/// @param problem  problem to be simulated
/// @param alone    simulation of level_0_alone() that has not been stepped; it is not stepped here
/// @param options  run length and clock
/// @param exec     execution space instance that runs the trials
template <class B>
std::optional<CycleChoice> choose_cycle(const Problem& problem, const Simulation<B>& alone,
                                        const ChoiceOptions& options,
                                        const typename B::Exec& exec = {});

/// Returns sentences that say what cycle auto would try, and why; empty for any other cycle. Steps
/// nothing.
/// @param problem     problem to be simulated
/// @param duration    simulated time of the run [s]
/// @param alone       report of level 0 without the other levels
/// @param macro_step  automatic macro step of level 0 alone [s]
std::string trials_ahead(const Problem& problem, double duration, const LevelReport& alone,
                         double macro_step);

/// Returns the problem with the chosen cycle and macro step; without a choice, unchanged.
Problem with_choice(Problem problem, const std::optional<CycleChoice>& choice);

}  // namespace plica
