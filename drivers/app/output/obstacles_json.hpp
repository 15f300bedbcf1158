// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <plica/core/obstacles.hpp>
#include <vector>

namespace plica::app {

/// The obstacles as the scene names them, so that a picture can show what was hit. Of a surface its box and counts.
nlohmann::ordered_json obstacles_json(const std::vector<ObstacleOptions>& obstacles);

}  // namespace plica::app
