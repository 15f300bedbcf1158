// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/load.hpp>
#include <plica/core/motion.hpp>
#include <plica/core/path.hpp>
#include <vector>

// Functions of time, on the host: motions and the factors of loads.
namespace plica {

/// Makes a motion for path_at(); its knots go to the end of `knots`.
Path make_path(const Motion& motion, std::vector<PathKnot>& knots);

/// Returns whether a motion ever moves.
bool moves(const Motion& motion);

/// Returns the factor by which a load's forces are multiplied at a time >= 0 [s].
double load_factor(const LoadCourse& course, double time);

}  // namespace plica
