// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/problem.hpp>

/// The cycle `rest`: the equilibrium of a body under its loads, by load steps. Time only says how
/// far the loads and given motions have come.
namespace plica {

/// Returns whether a run looks for equilibrium, and has no motion.
bool seeks_rest(const IntegrationOptions& options);

/// Returns the time function of loads that have none, where the run looks for equilibrium.
LoadCourse course_to_rest(const RestOptions& options);

/// Returns the problem with what the cycle `rest` means, put into the other options. Load steps are
/// macro steps, ten up to the whole loads if nothing else is given, and stages of backward Euler
/// solve them. Nothing is damped. Loads grow by course_to_rest(). Stresses that relax are relaxed.
/// Another cycle: returns the problem as it is.
Problem problem_at_rest(Problem problem);

}  // namespace plica
