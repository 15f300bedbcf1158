// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <functional>
#include <plica/drivers/study/study_run.hpp>
#include <string>

namespace plica {

/// Function called with the name of the run and the part of it that is done; false stops.
using TruthWatch = std::function<bool(const std::string& doing, double part)>;

/// Returns the best known motion of the body, at level 0's vertices and the options' probes.
///
/// It is Richardson's limit of the motion on uniform refinements of level 0's mesh. The steps are
/// refined like the edges, so that the errors in space and time shrink together. Where level 0 is a
/// refinement of level 1, level 1 is one of these meshes. The elements are the last of
/// element_families(). The limit of the first of element_families(), or with a jitter that of a
/// jittered mesh, checks the result. The result also has every level with every kind of elements,
/// converged in time.
///
/// Contact is as stiff as on level 0. Vertices that a scene selects by place (loads, parts,
/// regions) are selected again on each mesh; named sets follow the mesh. A round body is the one
/// that level 0's facets enclose.
///
/// Throws InputError where not even one refinement fits the budget. It also does where a run does
/// not complete at an eighth of its step.
///
/// @param problem  problem to be simulated
/// @param options  settings of the study; StudyOptions::truth must be set
/// @param budget   wall time for all of it [s]; none: no limit. The second of two refinements is
///                 left out where both take more than half of the budget
/// @param watch    function called with the progress; empty: none
/// @return         own error: Truth::error(); the trajectory is empty where the watch stopped it
StudyReference make_truth(const Problem& problem, const StudyOptions& options,
                          std::optional<double> budget, const TruthWatch& watch);

}  // namespace plica
