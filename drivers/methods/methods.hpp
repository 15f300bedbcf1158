// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/problem.hpp>
#include <string>
#include <string_view>

/// What the names of methods mean, and what their options come to where a scene leaves them open.
namespace plica {

/// Whether that cycle uses more meshes than the finest; false for a name it does not know.
bool uses_coarse_levels(std::string_view cycle);
/// Whether coarser levels have states of their own there, and shares of the macro step.
bool integrates_coarse_levels(std::string_view cycle);
/// How many of a body's levels that cycle integrates: those that have a state, from the finest on.
std::size_t integrated_levels(std::string_view cycle, std::size_t levels);

/// Whether that integrator is explicit; true for a name it does not know.
bool is_explicit(std::string_view integrator);

/// How often a macro step that fails is halved, at most: what the options say, and where they leave
/// it open, 6 where Newton's method judges the steps of a level, else 0.
int most_halvings(const Problem& problem);
/// Whether that integrator conserves energy on the linear problem. What a step then leaves unsolved
/// is energy lost or won.
bool conserves_energy(const ImplicitOptions& options, std::string_view integrator);
/// The most Newton iterations that a stage of that integrator takes: those of the options, and
/// where they leave it open, 20; but 1 where a linear solve is a fixed amount of work.
int newton_iterations(const ImplicitOptions& options, std::string_view integrator);

/// What of the fastest motion generalized_alpha leaves after a step: by the options, or where they
/// leave it open 0.8, and with contact 0. Contact sets in and ends within a step, and what is left
/// of that makes its force alternate from step to step, and grow.
double rho_infinity(const ImplicitOptions& options, bool contact);

/// Throws InputError for a list that has not one value for each level, or where `one_for_all` one.
void check_length(const std::string& option, std::size_t size, std::size_t levels,
                  bool one_for_all);

}  // namespace plica
