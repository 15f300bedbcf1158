// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <functional>
#include <limits>
#include <plica/core/problem.hpp>
#include <plica/drivers/run/simulation.hpp>
#include <string>
#include <vector>

// Short runs of cycle auto, timed.
namespace plica {

/// Number of equal parts of a trial; states are compared at the end of each
inline constexpr int trial_quarters = 4;

/// Start of a trial: the scene's own start, or a state of level 0.
struct TrialStart {
  double time = 0;          ///< [s]; 0: the scene's own start
  std::vector<Point> u, v;  ///< displacement and velocity of each vertex [m], [m/s]
};

/// Clock of a trial and its wall-time limit.
struct TrialClock {
  std::function<double()> now;  ///< wall time [s]
  /// wall time at which the trial ends [s]
  double deadline = std::numeric_limits<double>::infinity();
};

/// Result of one trial's run.
struct TrialRun {
  /// `[quarter][vertex] m`: displacements from the trial's start, at the end of each quarter
  std::vector<std::vector<Point>> u;
  std::string reason;      ///< why there is no result, or it is not to be used; else empty
  double set_up_time = 0;  ///< wall time [s]
  double step_time = 0;    ///< median wall time of a macro step [s]
  bool touched = false;    ///< true where an obstacle or a body pushed it
};

/// Returns whether anything has pushed the body in the last macro step.
template <class B>
bool is_pushed(const Simulation<B>& simulation);

/// Runs the problem for `steps` macro steps with the given integration, and times it.
/// @param steps  a multiple of trial_quarters
template <class B>
TrialRun run_trial(Problem problem, const IntegrationOptions& integration, int steps,
                   const TrialStart& start, const TrialClock& clock, const typename B::Exec& exec);

/// Returns the relative error |u - from| / |from - rigid|, L2 over all quarters and vertices.
/// @param rigid  displacement of the whole body as a rigid one, at each quarter's end [m]
double trial_error(const TrialRun& run, const TrialRun& from, const std::vector<Point>& rigid);

/// Returns whether any vertex moves away from the rigid displacement by more than rounding.
bool anything_moves(const TrialRun& run, const std::vector<Point>& rigid, const TetMesh& mesh);

}  // namespace plica
