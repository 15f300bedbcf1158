// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/keys.hpp>
#include <plica/core/problem.hpp>
#include <string>
#include <string_view>
#include <vector>

/// Lists of names that a scene chooses from, to print; core/keys.hpp has more of them. Each is made
/// from the list of types of its family.
namespace plica {

std::vector<Choice> cycles();           ///< ways to share a macro step among the levels
std::vector<Choice> obstacle_shapes();  ///< shapes of obstacles, for contact
std::vector<Choice> linear_solvers();   ///< linear solvers of implicit levels
std::vector<Choice> preconditioners();  ///< preconditioners of conjugate gradients
std::vector<Choice> diagnosis_kinds();  ///< reasons for which a run stops: kinds of Diagnosis

/// Gives a problem the options of one of presets(). Throws InputError for another name.
void apply_preset(std::string_view name, Problem& problem);

}  // namespace plica
