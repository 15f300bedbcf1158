// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/problem.hpp>
#include <string>
#include <string_view>

/// Meaning of the names of methods, and values of their options where a scene leaves them open.
namespace plica {

/// Returns whether a cycle uses more meshes than the finest; false for an unknown name.
bool uses_coarse_levels(std::string_view cycle);
/// Returns whether a cycle gives coarser levels states of their own and shares of the macro step;
/// false for an unknown name.
bool integrates_coarse_levels(std::string_view cycle);
/// Returns how many of a body's levels a cycle integrates, from the finest on. These have a state.
std::size_t integrated_levels(std::string_view cycle, std::size_t levels);

/// Returns whether an integrator is explicit; true for an unknown name.
bool is_explicit(std::string_view integrator);

/// Returns the maximum number of times that a failing macro step is halved, as the options say.
/// Where they leave it open, it is 6 if Newton's method judges the steps of a level, else 0.
int most_halvings(const Problem& problem);
/// Returns whether an integrator conserves energy on the linear problem. If so, what a step leaves
/// unsolved is energy lost or won.
bool conserves_energy(const ImplicitOptions& options, std::string_view integrator);
/// Returns the maximum number of Newton iterations in a stage of an integrator, as the options say.
/// Where they leave it open, it is 20. It is 1 where a linear solve is a fixed amount of work and
/// the integrator does not conserve energy.
int newton_iterations(const ImplicitOptions& options, std::string_view integrator);

/// Returns which part of the fastest motion generalized_alpha leaves after a step, as the options
/// say. Where they leave it open, it is 0.8 without contact, and 0 with it. Contact sets in and
/// ends within a step. The fast motion that is left of that makes the contact force alternate from
/// step to step, and grow.
double rho_infinity(const ImplicitOptions& options, bool contact);

/// Throws InputError for a list without exactly one value for each level. With `one_for_all`, one
/// value for all levels is allowed too.
void check_length(const std::string& option, std::size_t size, std::size_t levels,
                  bool one_for_all);

}  // namespace plica
