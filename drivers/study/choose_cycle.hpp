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

/// A cycle at a macro step that was tried out.
struct CycleTrial {
  std::string cycle;            ///< its name
  double macro_step = 0;        ///< [s]
  double over_critical = 0;     ///< the same over the finest level's critical step
  std::optional<double> error;  ///< of what level 0 is displaced by in the trial, relative (L2);
                                ///< none: there is no number
  /// why it cannot be used, or was taken without an error; empty otherwise
  std::string reason;
  double set_up_time = 0;  ///< [s]
  double step_time = 0;    ///< the median of its macro steps [s]
  double run_time = 0;  ///< of the whole run with it, set-up included, as these two predict it; of
                        ///< a second where it has no end [s]
};

/// What `integration.cycle: auto` has chosen.
struct CycleChoice {
  std::string cycle;         ///< him | single
  double macro_step = 0;     ///< [s]; of single the automatic one
  double over_critical = 0;  ///< the same over the finest level's critical step
  std::string error_class;   ///< that was asked for
  double allowed = 0;        ///< the error it allows
  double duration = 0;       ///< of the trials [s]; 0: nothing was tried
  double start = 0;          ///< of the trials [s]: above 0 shortly before the body first touches
                             ///< something, or where it is deformed most
  /// in their order; level 0 alone, which they are measured against, first
  std::vector<CycleTrial> trials;
  std::string reason;  ///< one sentence
  /// what the run will do, contact above all, was not seen in the trials
  bool provisional = false;
  /// of the run by level 0 alone, as 32 of its steps predict it [s]; 0: not timed
  double single_time = 0;
  double spent = 0;  ///< on timing and trials [s]

  /// The keys of `integration` that repeat the run bit for bit: "cycle: him, macro_step: 0.0025 s".
  std::string keys() const;
};

/// What a choice depends on besides the problem.
struct ChoiceOptions {
  double duration = std::numeric_limits<double>::infinity();  ///< simulated time of the run [s] >
                                                              ///< 0; infinity: not known, and long
  /// time of the day, for costs [s]; none: the machine's
  std::function<double()> clock = {};
};

/// of the run by level 0 alone, that timing and trials may take
inline constexpr double trial_part = 0.1;

/// The problem by level 0 alone, in its automatic step: what is chosen where nothing else pays. The
/// same for any other cycle than auto.
Problem level_0_alone(Problem problem);

/// Chooses for `integration.cycle: auto`; none for any other cycle. Call it before a Simulation is
/// constructed, and construct that of with_choice(). Level 0 alone is taken untried where there is
/// no other level, and where the run is so short that timing and trials could take more than
/// trial_part of it. Else short runs decide, over 128 critical steps: level 0 alone (central
/// differences at 0.45 of the critical step) and cycle `him` at 8 times it, then at 16 and 32
/// times, or at 4 and 2, as long as a trial costs less than it can gain and all of them less than
/// trial_part of the run. They begin shortly before the body first touches something: where it
/// moves rigidly until then, at that place (see first_touch()); else the coarsest level alone looks
/// for it, for 5 % of the run. Without contact they begin where level 0 alone is deformed most in
/// that time. Where contact is to come and the trials see none, steps are at most 4 critical ones,
/// and the choice is provisional. Taken is the least predicted run time, set-up included, among
/// those whose error is within the class. A run that is refused, diverges, makes energy or has to
/// cut its steps is not taken. Run times matter, so the choice may be another one next time: keys()
/// pins it. The trials do not include what a caller changes later (forces, states). Throws
/// InputError for a problem that is not valid, and where level 0 alone cannot be set up.
template <class B>
std::optional<CycleChoice> choose_cycle(const Problem& problem, const ChoiceOptions& options,
                                        const typename B::Exec& exec = {});

/// The same with a simulation of level_0_alone() that has not been stepped, and will not be.
template <class B>
std::optional<CycleChoice> choose_cycle(const Problem& problem, const Simulation<B>& alone,
                                        const ChoiceOptions& options,
                                        const typename B::Exec& exec = {});

/// What cycle auto would try, and why, in a sentence or more; empty for any other cycle. Steps
/// nothing. `alone` is the report of level 0 by itself, `macro_step` its automatic one [s].
std::string trials_ahead(const Problem& problem, double duration, const LevelReport& alone,
                         double macro_step);

/// The same problem with what was chosen, if anything was.
Problem with_choice(Problem problem, const std::optional<CycleChoice>& choice);

}  // namespace plica
