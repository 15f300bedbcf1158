// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/load.hpp>
#include <plica/core/motion.hpp>
#include <plica/core/path.hpp>
#include <vector>

// What is given as a function of time, on the host: motions and the factors of loads.
namespace plica {

/// A motion for path_at(); its knots go to the end of `knots`.
Path make_path(const Motion& motion, std::vector<PathKnot>& knots);

/// Whether it ever moves.
bool moves(const Motion& motion);

/// What a load's forces are multiplied with at a time [s] >= 0.
double load_factor(const LoadCourse& course, double time);

}  // namespace plica
