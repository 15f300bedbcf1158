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

inline constexpr int trial_quarters = 4;  ///< of a trial, at whose ends states are compared

/// Where a trial starts: from the scene's own start, or from a state of level 0.
struct TrialStart {
  double time = 0;          ///< [s]; 0: the scene's own start
  std::vector<Point> u, v;  ///< [m], [m/s]
};

struct TrialClock {
  std::function<double()> now;                                ///< [s]
  double deadline = std::numeric_limits<double>::infinity();  ///< the trial ends there
};

/// What became of one.
struct TrialRun {
  /// [quarter][vertex], displacements from where it started [m]
  std::vector<std::vector<Point>> u;
  std::string reason;      ///< why there is none, or why it is not to be used
  double set_up_time = 0;  ///< [s]
  double step_time = 0;    ///< the median [s]
  bool touched = false;    ///< an obstacle or a body pushed it
};

/// Whether anything has pushed the body in the last macro step.
template <class B>
bool is_pushed(const Simulation<B>& simulation);

/// So many macro steps, a multiple of trial_quarters, of the problem with that integration.
template <class B>
TrialRun run_trial(Problem problem, const IntegrationOptions& integration, int steps,
                   const TrialStart& start, const TrialClock& clock, const typename B::Exec& exec);

/// |u - from| / |from - rigid|, over all quarters: `rigid` is what every vertex is displaced by at each quarter's end in any case [m]
double trial_error(const TrialRun& run, const TrialRun& from, const std::vector<Point>& rigid);

/// Whether it moves by more than rounding in any other way.
bool anything_moves(const TrialRun& run, const std::vector<Point>& rigid, const TetMesh& mesh);

}  // namespace plica
