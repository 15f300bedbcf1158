// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/app/scene/scene.hpp>
#include <plica/drivers/solver/simulation.hpp>
#include <string>
#include <vector>

namespace plica::app {

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
