// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/keys.hpp>
#include <plica/core/problem.hpp>
#include <string>
#include <string_view>
#include <vector>

/// The families a scene chooses from, as lists to print, beside those of core/keys.hpp. Each walks
/// the family's own list.
namespace plica {

std::vector<Choice> cycles();           ///< ways to share a macro step
std::vector<Choice> obstacle_shapes();  ///< for contact
std::vector<Choice> linear_solvers();   ///< of implicit levels
std::vector<Choice> preconditioners();  ///< of conjugate gradients

/// Gives a problem the options of one of presets(). InputError for another name.
void apply_preset(std::string_view name, Problem& problem);

}  // namespace plica
