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
};

template <class B>
Snapshot take_snapshot(const Simulation<B>& simulation, double time, const std::vector<int>& volumes) {
  Snapshot snapshot{time,
                    simulation.positions(),
                    simulation.velocities(),
                    simulation.surface_positions(),
                    simulation.surface_velocities(),
                    {},
                    simulation.energies()};
  for (const int level : volumes)
    snapshot.volumes.push_back(
        {level, simulation.positions(level), simulation.velocities(level), simulation.element_fields(level)});
  return snapshot;
}

}  // namespace plica::app
