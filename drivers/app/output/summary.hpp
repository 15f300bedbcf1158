// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <plica/drivers/app/output/contact_depth.hpp>
#include <plica/drivers/app/scene/scene.hpp>
#include <plica/drivers/level/part_of_level.hpp>
#include <plica/drivers/run/simulation.hpp>
#include <plica/drivers/study/choose_cycle.hpp>
#include <string>
#include <vector>

namespace plica::app {

/// Returns the smallest number of macro steps [s] that covers a duration [s] up to rounding, at
/// least 1. Throws InputError for more than 1e12.
long steps_to_cover(double duration, double macro_step);
/// Returns steps_to_cover() of a scene's duration. Throws InputError with the location in the
/// scene.
long steps_of(const Scene& scene, double macro_step);

/// Data of a run, as in summary.json. Times are in s, memory in bytes.
struct Summary {
  std::string status;  ///< completed | interrupted | diverged
  /// simulated time reached, and time of the last frame on disk; they differ after divergence [s]
  double simulated_time = 0, last_good_time = 0;
  double macro_step = 0;                 ///< length of a macro step [s]
  long macro_steps = 0;                  ///< number of macro steps
  double wall_time = 0, setup_time = 0;  ///< wall time of the steps, of the set-up [s]
  std::size_t peak_memory = 0, frames = 0;
  std::string precision, backend;
  int threads = 0;
  std::optional<double> wait_share;   ///< see CoreWait::share()
  std::optional<RankReport> ranks;    ///< how ranks shared the body; none: one process
  std::string cycle;                  ///< name of the cycle that ran
  std::optional<CycleChoice> choice;  ///< choice of cycle auto; none: another cycle
  std::vector<LevelReport> levels;
  std::map<std::string, double> stages;  ///< wall time of each stage [s]
  std::map<std::string, long> counters;
  double residual = 0;  ///< largest residual of an implicit solve in the run
  std::optional<Diagnosis> diagnosis;
  std::vector<Wrench> wrenches;          ///< forces and torques over the last macro step
  std::vector<Reaction> reactions;       ///< forces and torques that hold vertices at the end
  std::vector<ToolState> tools;          ///< poses of obstacles with mass at the end
  std::vector<HeldBy> held;              ///< points that obstacles have grasped at the end
  Penetrations penetrations;             ///< largest depths in all frames
  std::optional<CutReport> cuts;         ///< outcome of the scene's cuts; none: it has none
  std::optional<FollowReport> followed;  ///< moves of a part; none: no part follows
  std::vector<std::string> warnings;     ///< warnings about the scene and about the run
  /// last good positions of the corners of the diagnosis' element, or of its vertex [m]
  std::vector<Point> diagnosed;
};

/// Returns the contents of summary.json; `words` is the command line.
std::string summary_json(const Scene& scene, const Summary& summary,
                         const std::vector<std::string>& words);

/// Returns a warning about linear systems, or Newton steps, that were not solved, from a
/// simulation's counters. Empty: all were solved.
std::string unsolved_text(std::map<std::string, long> counters);

/// Returns a warning if cycle him took more than half of the macro steps as explicit steps of level
/// 0. Empty: it did not.
std::string mostly_explicit_text(std::map<std::string, long> counters, long macro_steps);

/// Returns a warning if the run takes more than 1e6 macro steps; empty: it does not. The warning
/// has changes to the scene that would make the steps longer.
std::string many_steps_text(const Scene& scene, const Summary& summary);

/// Returns the most important data of summary.json as a few lines of text.
std::string summary_text(const Scene& scene, const Summary& summary, const std::string& folder);

/// Returns true if a level has elements; false for a coarse space, which has points only.
bool has_elements(const LevelReport& level);
/// Returns the name of the kind of a level in summary.json.
const char* level_kind_name(LevelKind kind);
/// Returns the levels as JSON, as in summary.json and `plica explain --json`.
nlohmann::ordered_json levels_json(const std::vector<LevelReport>& levels);

/// Returns the name of the cycle that runs: the scene's, or the one that cycle auto has chosen.
std::string cycle_name(const Scene& scene, const std::optional<CycleChoice>& choice);

/// Decisions of the set-up of a scene.
struct Plan {
  double macro_step = 0;  ///< length of a macro step [s]
  std::string backend;
  int threads = 0;
  std::string precision;
  std::vector<LevelReport> levels;
  std::optional<HimReport> him;
  std::optional<CycleChoice> choice;
  std::vector<Part> parts;
  std::vector<RankPlan> ranks = {};  ///< share of each of several ranks; empty: not asked for
};

/// Returns the output of `plica explain` as text in 100 columns.
std::string plan_text(const Scene& scene, const Plan& plan);
/// Returns the output of `plica explain` as JSON.
std::string plan_json(const Scene& scene, const Plan& plan);

}  // namespace plica::app
