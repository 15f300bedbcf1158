// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <plica/drivers/app/scene/scene.hpp>
#include <plica/drivers/solver/simulation.hpp>
#include <plica/drivers/study/choose_cycle.hpp>
#include <string>
#include <vector>

namespace plica::app {

/// The cycle that runs: the scene's, or what auto has come to.
std::string cycle_name(const Scene& scene, const std::optional<CycleChoice>& choice);

/// What auto has come to, and the trials: a table for people, in 100 columns, and for programs (null: the scene names its cycle).
std::string choice_text(const CycleChoice& choice);
nlohmann::ordered_json choice_json(const std::optional<CycleChoice>& choice);

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
