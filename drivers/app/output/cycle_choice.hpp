// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <plica/drivers/study/choose_cycle.hpp>
#include <string>

namespace plica::app {

/// Returns what cycle auto has chosen and a table of its trials, as text in 100 columns.
std::string choice_text(const CycleChoice& choice);

/// Returns the choice of cycle auto in one line: cycle, reason, and the keys that repeat it.
std::string choice_line(const CycleChoice& choice);

/// Returns a choice as JSON, for programs and for resumed runs; null: the scene names its cycle.
nlohmann::ordered_json choice_json(const std::optional<CycleChoice>& choice);
/// Returns the choice that choice_json() has written.
std::optional<CycleChoice> choice_of(const nlohmann::ordered_json& json);

}  // namespace plica::app
