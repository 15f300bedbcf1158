// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <optional>
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

/// |u - r| / |r| over all sampling times of one vertex; none where it stays at rest in the reference.
std::optional<double> error_at(const Trajectory& trajectory, const Trajectory& reference, std::size_t vertex);

/// How far it is behind the reference on the mean [s], < 0: ahead. The s that makes u = r - s v most true, by least squares over
/// all vertices and sampling times, with the reference's velocity v: means something while small beside the motion's period.
double delay_of(const Trajectory& trajectory, const Trajectory& reference);

}  // namespace plica
