// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/study/trajectory.hpp>

namespace plica {

/// How far one trajectory is from another, as fractions.
struct StudyErrors {
  double displacement = 0;  ///< |u - r| / |r|, both over all vertices and sampling times (L2)
  double velocity = 0;      ///< the same of velocities
  double worst_vertex =
      0;  ///< the largest over vertices of |u - r| over time, to the vertices' root mean square of |r|
};

/// InputError where nothing of the body moves by more than rounding: then there is nothing to measure against.
void expect_motion(const Trajectory& trajectory, const TetMesh& mesh);

/// Of trajectories at the same times and vertices.
StudyErrors errors_of(const Trajectory& trajectory, const Trajectory& reference);

}  // namespace plica
