// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <plica/drivers/app/scene/scene.hpp>
#include <plica/drivers/solver/cycle_choice.hpp>
#include <string>

namespace plica::app {

/// The cycle that runs: the scene's, or what auto has come to.
std::string cycle_name(const Scene& scene, const std::optional<CycleChoice>& choice);

/// What auto has come to, and the trials: a table for people, in 100 columns, and for programs (null: the scene names its cycle).
std::string choice_text(const CycleChoice& choice);
nlohmann::ordered_json choice_json(const std::optional<CycleChoice>& choice);

}  // namespace plica::app
