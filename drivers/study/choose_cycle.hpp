// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <optional>
#include <plica/core/problem.hpp>
#include <string>
#include <vector>

namespace plica {

/// A cycle at a macro step that was tried out.
struct CycleTrial {
  std::string cycle;         ///< its name
  double macro_step = 0;     ///< [s]
  double over_critical = 0;  ///< the same over the finest level's critical step
  std::optional<double>
      error;           ///< of what level 0 is displaced by in the trial, relative (L2); none: there is no number
  std::string reason;  ///< why it cannot be used, or was taken without an error; empty otherwise
};

/// What `integration.cycle: auto` has chosen.
struct CycleChoice {
  std::string cycle;         ///< him | single
  double macro_step = 0;     ///< [s]
  double over_critical = 0;  ///< the same over the finest level's critical step
  std::string error_class;   ///< that was asked for
  double allowed = 0;        ///< the error it allows
  double duration = 0;       ///< of the trials [s]; 0: there was nothing to try
  double start = 0;          ///< of the trials [s]: above 0 shortly before the body first touches an obstacle
  std::vector<CycleTrial>
      trials;          ///< the longest step first, up to the one within the class; level 0 alone last where none is
  std::string reason;  ///< one sentence
};

inline constexpr double him_step_cost = 1.8;      ///< of one force evaluation of level 0, about
inline constexpr double trial_evaluations = 800;  ///< of level 0, by the trials of cycle auto that end at 8, about

/// Chooses for `integration.cycle: auto`; none for any other cycle. Call it before a Simulation is constructed, and construct that
/// of with_choice(). Short runs decide: level 0's displacements in cycle `him` at 32, 16, 8, 4 and 2 times the finest level's critical step against
/// level 0 alone (rk4 at half its limit), over 128 critical steps, at their quarters. They begin at the problem's own
/// start; with obstacles shortly before the body first touches one, as the coarsest level alone finds it. The longest step whose error is within the
/// class is taken; where there is none, or no coarser level, level 0 alone at 0.9 of its limit. A run that is refused, diverges
/// or needs its inertia fitted again is not taken. Run times do not matter, so the choice is the same on any number of threads. The
/// trials do not include what a caller changes later (forces, states). Throws InputError for a problem that is not
/// valid, and where level 0 alone cannot be set up.
template <class B>
std::optional<CycleChoice> choose_cycle(const Problem& problem, const typename B::Exec& exec = {});

/// The same problem with what was chosen, if anything was.
Problem with_choice(Problem problem, const std::optional<CycleChoice>& choice);

}  // namespace plica
