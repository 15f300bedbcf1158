// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/solver/simulation.hpp>
#include <vector>

namespace plica::app {

/// The tetrahedra of one level at one point in time.
struct VolumeSnapshot {
  int level = 0;
  std::vector<Point> positions, velocities;  ///< [m, m/s]
  ElementFields elements;
};

/// The state of a run at one point in time, on the host, numbered as the scene's meshes are.
struct Snapshot {
  double time = 0;                                 ///< [s]
  std::vector<Point> positions, velocities;        ///< of level 0's vertices [m, m/s]
  std::vector<Point> surface, surface_velocities;  ///< of the embedded surface's; empty without one
  std::vector<VolumeSnapshot> volumes;             ///< of the levels that are written
  Energies energies;
  long halvings = 0;  ///< of macro steps so far
};

/// Of macro steps so far; 0 where bad ones are not retried.
template <class B>
long halvings_of(const Simulation<B>& simulation) {
  const auto counters = simulation.counters();
  const auto found = counters.find("halvings");
  return found == counters.end() ? 0 : found->second;
}

template <class B>
Snapshot take_snapshot(const Simulation<B>& simulation, double time, const std::vector<int>& volumes) {
  Snapshot snapshot{time,
                    simulation.positions(),
                    simulation.velocities(),
                    simulation.surface_positions(),
                    simulation.surface_velocities(),
                    {},
                    simulation.energies(),
                    halvings_of(simulation)};
  for (const int level : volumes)
    snapshot.volumes.push_back(
        {level, simulation.positions(level), simulation.velocities(level), simulation.element_fields(level)});
  return snapshot;
}

}  // namespace plica::app
