// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <functional>
#include <plica/drivers/study/study_run.hpp>
#include <string>

namespace plica {

/// Told what is run and how much of it is done; false stops.
using TruthWatch = std::function<bool(const std::string& doing, double part)>;

/// What the body really does, at level 0's vertices and the options' probes: Richardson's limit of
/// its motion on uniform refinements of level 0's mesh, the steps as much finer as the edges, so
/// that the errors in space and time shrink together. Where level 1 is what level 0 is a refinement
/// of, it is one of these meshes. Its elements are the last of element_families(); the limit of the
/// first, or with a jitter that of a jittered mesh, checks it. Beside it every level with every
/// kind of elements, converged in time.
///
/// Contact is as stiff as on level 0. What a scene chooses by place (loads, parts, regions) is
/// chosen anew on each mesh; what the mesh names follows it; round bodies are those that level 0's
/// facets enclose.
///
/// @param budget  wall time for it [s]: of two refinements the second is left out where both take
/// more than half of that; none: no limit
/// @return        its own error is Truth::error(); an empty trajectory where the watch stopped it. InputError where not even one
///                refinement fits the budget, or a run does not come to its end at an eighth of its step
StudyReference make_truth(const Problem& problem, const StudyOptions& options,
                          std::optional<double> budget, const TruthWatch& watch);

}  // namespace plica
