// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/problem.hpp>
#include <string>

/// The parts of validate(): InputError for the first value out of its range, named as a scene names it below `option`.
namespace plica {

void validate_selection(const std::string& option, const Selection& selection);
void validate_motion(const std::string& option, const Motion& motion);
void validate_load(const std::string& option, const LoadOptions& load);
void validate_velocities(const InitialOptions& initial);
void validate_obstacle(const std::string& option, const ObstacleOptions& obstacle);

}  // namespace plica
