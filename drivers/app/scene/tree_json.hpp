// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <nlohmann/json.hpp>
#include <plica/drivers/app/scene/tree.hpp>

namespace plica::app {

/// A scene as JSON, its values as the words that stand there, and back; places are lost but for the file.
nlohmann::ordered_json json_of(const Tree& tree);
Tree tree_of(const nlohmann::ordered_json& json, const std::string& file);

/// Where two scenes first differ: "body.material.density: '1000' became '900'"; empty where they say the same in whatever
/// order. A key of the top level may be left out of this.
std::string first_difference(const Tree& before, const Tree& now, const std::string& but_for = {});

}  // namespace plica::app
