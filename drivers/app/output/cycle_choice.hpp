// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <plica/drivers/study/choose_cycle.hpp>
#include <string>

namespace plica::app {

/// What cycle auto has come to, and the trials: a table for people, in 100 columns.
std::string choice_text(const CycleChoice& choice);

/// The same in a line: the keys that repeat the run, and why.
std::string choice_line(const CycleChoice& choice);

/// For programs, and for a run that goes on; null: the scene names its cycle.
nlohmann::ordered_json choice_json(const std::optional<CycleChoice>& choice);
std::optional<CycleChoice> choice_of(const nlohmann::ordered_json& json);

}  // namespace plica::app
