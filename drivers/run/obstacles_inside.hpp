// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/run/simulation.hpp>
#include <vector>

namespace plica {

/// Returns the numbers of the obstacles that came through the surface. Their middle is inside the
/// body as it is now, and the surface is nowhere inside them, so that nothing pushes them out.
/// Planes, bowls and sampled surfaces are not examined, since their middle says nothing. Waits;
/// copies all positions of level 0 and goes through its tetrahedra.
/// @param problem  problem that the simulation was made of
/// @param depths   contact_depths() of the simulation [m]
template <class B>
std::vector<int> obstacles_inside(const Simulation<B>& simulation, const Problem& problem,
                                  const std::vector<double>& depths);

}  // namespace plica
