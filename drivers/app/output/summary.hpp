// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <plica/drivers/app/output/contact_depth.hpp>
#include <plica/drivers/app/scene/scene.hpp>
#include <plica/drivers/run/simulation.hpp>
#include <plica/drivers/study/choose_cycle.hpp>
#include <string>
#include <vector>

namespace plica::app {

/// The least number of whole macro steps, at least one, that covers a duration [s] but for
/// rounding. InputError where there are more than 1e12.
long steps_to_cover(double duration, double macro_step);

/// A run as summary.json tells it. Times in s, memory in bytes.
struct Summary {
  std::string status;
  /// reached; on disk: another one only after divergence
  double simulated_time = 0, last_good_time = 0;
  double macro_step = 0;
  long macro_steps = 0;
  double wall_time = 0, setup_time = 0;
  std::size_t peak_memory = 0, frames = 0;
  std::string precision, backend;
  int threads = 0;
  std::optional<double> wait_share;   ///< see CoreWait
  std::string cycle;                  ///< that ran
  std::optional<CycleChoice> choice;  ///< of cycle auto
  std::vector<LevelReport> levels;
  std::map<std::string, double> stages;
  std::map<std::string, long> counters;
  double residual = 0;  ///< the worst an implicit solve ended with
  std::optional<Diagnosis> diagnosis;
  std::vector<Wrench> wrenches;       ///< of the last macro step
  std::vector<ToolState> tools;       ///< obstacles with mass, at the end
  std::vector<HeldBy> held;           ///< then, by obstacles that can hold points
  Penetrations penetrations;          ///< the greatest of the run, of its frames
  std::vector<std::string> warnings;  ///< of the scene, and of what the run has shown
  /// where its element's corners, or its vertex, are in the last good state [m]
  std::vector<Point> diagnosed;
};

/// summary.json; `words` is the command line.
std::string summary_json(const Scene& scene, const Summary& summary,
                         const std::vector<std::string>& words);

/// A sentence of systems, or of Newton's steps, that were not solved, of a simulation's counters;
/// empty where all were.
std::string unsolved_text(std::map<std::string, long> counters);

/// A sentence where the cycle him went by explicit steps of level 0 for most of so many macro
/// steps; else empty.
std::string mostly_explicit_text(std::map<std::string, long> counters, long macro_steps);

/// A sentence where the run takes very many macro steps: what would make them longer that the scene
/// does not have yet. Else empty.
std::string many_steps_text(const Scene& scene, const Summary& summary);

/// The same as summary.json in a few lines for people.
std::string summary_text(const Scene& scene, const Summary& summary, const std::string& folder);

/// Whether a level has elements, not points of a coarse space alone.
bool has_elements(const LevelReport& level);
/// As summary.json has it.
const char* level_kind_name(LevelKind kind);
/// The levels as summary.json and `plica explain --json` print them.
nlohmann::ordered_json levels_json(const std::vector<LevelReport>& levels);

/// The cycle that runs: the scene's, or what auto has come to.
std::string cycle_name(const Scene& scene, const std::optional<CycleChoice>& choice);

/// What the set-up of a scene decided.
struct Plan {
  double macro_step = 0;  ///< [s]
  std::string backend;
  int threads = 0;
  std::string precision;
  std::vector<LevelReport> levels;
  std::optional<HimReport> him;
  std::optional<CycleChoice> choice;
  std::vector<Part> parts;
};

/// For `plica explain`: for people, in 100 columns, and for programs.
std::string plan_text(const Scene& scene, const Plan& plan);
std::string plan_json(const Scene& scene, const Plan& plan);

}  // namespace plica::app
