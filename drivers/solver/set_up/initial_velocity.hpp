// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/problem.hpp>
#include <vector>

namespace plica {

/// Per vertex of level 0 at rest, before it is placed, as if all were free [m/s]; `middle` is the point its angular velocity is
/// about. Throws InputError where a part has no vertex.
std::vector<Point> initial_velocity(const InitialOptions& options, const TetMesh& mesh, const Point& middle);

}  // namespace plica
