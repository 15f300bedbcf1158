// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/run/simulation.hpp>
#include <vector>

namespace plica {

/// Numbers of the obstacles that came through the surface: their middle is inside the body as it is
/// now, and the surface nowhere inside them, so that nothing pushes them out. Not looked at:
/// planes, bowls, sampled surfaces, whose middle says nothing. Waits; copies all positions of level
/// 0 and goes through its tetrahedra.
/// @param problem  what the simulation was made of
/// @param depths   of the simulation, see contact_depths()
template <class B>
std::vector<int> obstacles_inside(const Simulation<B>& simulation, const Problem& problem,
                                  const std::vector<double>& depths);

}  // namespace plica
