// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <optional>
#include <plica/meshes/embedding.hpp>
#include <utility>
#include <vector>

namespace plica {

/// Level 0's motion at sampling times: [sample][vertex], displacement from the placed rest mesh [m]
/// and velocity [m/s].
struct Trajectory {
  std::vector<double> times;  ///< [s]
  std::vector<std::vector<Point>> u, v;
};

/// `samples` times, evenly over (0, duration]. [s]
std::vector<double> sampling_times(double duration, int samples);

/// Fills a trajectory from the states of a run with steps of one length, of which it keeps none: a
/// sampling time between two states is interpolated by the polynomial of degree 3 through the two
/// before and the two after it (at the ends the four nearest; fewer where the run has fewer),
/// Lagrange's form. A sampling time that a step hits is that state.
class TrajectorySampler {
 public:
  /// @param times  ascending, none beyond `steps` steps of `step` [s]
  TrajectorySampler(const std::vector<double>& times, double step, long steps);
  bool wants(long step) const { return next_ < terms_.size() && terms_[next_].step == step; }
  /// The state after that many steps; to be called for each that it wants, in order.
  void add(long step, const std::vector<Point>& u, const std::vector<Point>& v);
  Trajectory take() { return std::move(trajectory_); }

 private:
  struct Term {
    long step;
    std::size_t sample;
    double weight;
  };
  std::vector<Term> terms_;  // by step
  std::size_t next_ = 0;
  Trajectory trajectory_;
};

/// Values of points that hang on the field's mesh.
std::vector<Point> interpolated(const std::vector<Point>& field, const Embedding& embedding);

/// The motion of points that hang on the trajectory's mesh.
Trajectory interpolated(const Trajectory& trajectory, const Embedding& embedding);

/// How far one trajectory is from another, as fractions.
struct StudyErrors {
  double displacement = 0;  ///< |u - r| / |r|, both over all vertices and sampling times (L2)
  double velocity = 0;      ///< the same of velocities
  double worst_vertex = 0;  ///< the largest over vertices of |u - r| over time, to the vertices'
                            ///< root mean square of |r|
};

/// InputError where nothing of the body moves by more than rounding: then there is nothing to
/// measure against.
void expect_motion(const Trajectory& trajectory, const TetMesh& mesh);

/// Of trajectories at the same times and vertices.
StudyErrors errors_of(const Trajectory& trajectory, const Trajectory& reference);

/// |a - b| / |size| of displacements, all over all vertices and sampling times (L2).
double difference(const Trajectory& a, const Trajectory& b, const Trajectory& size);

/// |u - r| / |r| over all sampling times of one vertex; none where it stays at rest in the reference.
std::optional<double> error_at(const Trajectory& trajectory, const Trajectory& reference,
                               std::size_t vertex);

/// How far it is behind the reference on the mean [s], < 0: ahead. The s that makes u = r - s v
/// most true, by least squares over all vertices and sampling times, with the reference's velocity
/// v: means something while small beside the motion's period.
double delay_of(const Trajectory& trajectory, const Trajectory& reference);

}  // namespace plica
