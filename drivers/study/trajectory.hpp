// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/meshes/embedding.hpp>
#include <utility>
#include <vector>

namespace plica {

/// Level 0's motion at sampling times: [sample][vertex], displacement from the placed rest mesh [m] and velocity [m/s].
struct Trajectory {
  std::vector<double> times;  ///< [s]
  std::vector<std::vector<Point>> u, v;
};

/// `samples` times, evenly over (0, duration]. [s]
std::vector<double> sampling_times(double duration, int samples);

/// Fills a trajectory from the states of a run with steps of one length, of which it keeps none: a sampling time between two
/// states is interpolated by the polynomial of degree 3 through the two before and the two after it (at the ends the four
/// nearest; fewer where the run has fewer), Lagrange's form. A sampling time that a step hits is that state.
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

/// The motion of points that hang on the trajectory's mesh.
Trajectory interpolated(const Trajectory& trajectory, const Embedding& embedding);

}  // namespace plica
