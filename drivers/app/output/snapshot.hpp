// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/solver/simulation.hpp>
#include <vector>

namespace plica::app {

/// The state of a run at one point in time, on the host.
struct Snapshot {
  double time = 0;                                 ///< [s]
  std::vector<Point> positions, velocities;        ///< of level 0's vertices [m, m/s]
  std::vector<Point> surface, surface_velocities;  ///< of the embedded surface's; empty without one
  Energies energies;
};

template <class B>
Snapshot take_snapshot(const Simulation<B>& simulation, double time) {
  return {time,
          simulation.positions(),
          simulation.velocities(),
          simulation.surface_positions(),
          simulation.surface_velocities(),
          simulation.energies()};
}

}  // namespace plica::app
