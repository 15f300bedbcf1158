// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/motion.hpp>
#include <plica/core/path.hpp>
#include <vector>

namespace plica {

/// A motion for path_at(); its knots go to the end of `knots`.
Path make_path(const Motion& motion, std::vector<PathKnot>& knots);

/// Whether it ever moves.
bool moves(const Motion& motion);

}  // namespace plica
