// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <optional>
#include <plica/meshes/embedding.hpp>
#include <utility>
#include <vector>

namespace plica {

/// Motion of level 0 at sampling times.
struct Trajectory {
  std::vector<double> times;  ///< sampling times [s]
  /// `[sample][vertex]`: displacement from the placed rest mesh [m], and velocity [m/s]
  std::vector<std::vector<Point>> u, v;
};

/// Returns `samples` times, evenly over (0, duration] [s].
std::vector<double> sampling_times(double duration, int samples);

/// Builds a trajectory from the states of a run with steps of one length, without keeping them. A
/// sampling time between two states is interpolated by the polynomial of degree 3 through two
/// states before and two after it, in Lagrange's form. At the ends of the run the four nearest
/// states are taken, and fewer where the run has fewer. At a sampling time that a step hits, the
/// state itself is taken.
class TrajectorySampler {
 public:
  /// Plans the interpolation for a run of `steps` steps of `step` [s].
  /// @param times  sampling times, ascending, none beyond the run's end [s]
  TrajectorySampler(const std::vector<double>& times, double step, long steps);
  bool wants(long step) const { return next_ < terms_.size() && terms_[next_].step == step; }
  /// Adds the state after `step` steps; call it for each step that wants() asks for, in order.
  void add(long step, const std::vector<Point>& u, const std::vector<Point>& v);
  Trajectory take() { return std::move(trajectory_); }

 private:
  struct Term {
    long step;
    std::size_t sample;
    double weight;
  };
  std::vector<Term> terms_;  // sorted by step
  std::size_t next_ = 0;
  Trajectory trajectory_;
};

/// Returns the values of a field at points that are embedded in its mesh.
std::vector<Point> interpolated(const std::vector<Point>& field, const Embedding& embedding);

/// Returns the motion of points that are embedded in the trajectory's mesh.
Trajectory interpolated(const Trajectory& trajectory, const Embedding& embedding);

/// Differences of a trajectory (u) from a reference (r), as fractions.
struct StudyErrors {
  double displacement = 0;  ///< |u - r| / |r|, both over all vertices and sampling times (L2)
  double velocity = 0;      ///< relative difference of velocities, in the same norm (L2)
  /// largest |u - r| of a vertex over all times, over the root mean square of the vertices' |r|
  double worst_vertex = 0;
};

/// Throws InputError where no vertex moves by more than rounding, since no relative error exists
/// then.
void expect_motion(const Trajectory& trajectory, const TetMesh& mesh);

/// Returns the errors of a trajectory; the reference has the same times and vertices.
StudyErrors errors_of(const Trajectory& trajectory, const Trajectory& reference);

/// Returns |a - b| / |size| of displacements, L2 norms over all vertices and sampling times.
double difference(const Trajectory& a, const Trajectory& b, const Trajectory& size);

/// Returns |u - r| / |r| of one vertex over all sampling times; none where it stays at rest in the
/// reference.
std::optional<double> error_at(const Trajectory& trajectory, const Trajectory& reference,
                               std::size_t vertex);

/// Returns the mean delay behind the reference [s]; < 0: ahead. It is the s that fits u = r - s v
/// best, by least squares over all vertices and sampling times; v is the reference's velocity. The
/// value is meaningful while small compared with the motion's period.
double delay_of(const Trajectory& trajectory, const Trajectory& reference);

}  // namespace plica
