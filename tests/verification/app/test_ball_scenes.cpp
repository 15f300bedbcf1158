// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <plica/drivers/app/scene/load_scene.hpp>
#include <plica/drivers/run/simulation.hpp>

#include "support/backends.hpp"

// The shipped ball scenes, whole, against the finest level alone at a quarter of its critical step.
// The bounds say what the paper's cycle is worth on its own scene.
namespace {

using namespace plica;
using namespace plica::test;
using Surface = std::vector<Point>;

struct Motion {
  std::vector<double> time;
  std::vector<Surface> surface;
  Energies start, end;
  double residual_speed = 0;  ///< the largest root-mean-square speed in the last 0.2 s [m/s]
};

Motion run(const std::string& scene, double over_critical = 0) {
  app::Scene s =
      app::load_scene(std::string(PLICA_SOURCE_DIR "/drivers/scenes/") + scene + ".yaml");
  if (over_critical > 0)
    s.problem.integration.macro_step =
        over_critical * Simulation<Host>(s.problem).levels().front().critical_step;
  Simulation<Host> simulation(s.problem);
  Motion m;
  m.start = simulation.energies();
  while (simulation.time() < s.duration) {
    if (m.time.empty() || simulation.time() >= m.time.back() + 2e-3) {
      m.time.push_back(simulation.time());
      m.surface.push_back(simulation.surface_positions());
    }
    if (const auto bad = simulation.step_checked()) {
      ADD_FAILURE() << scene << ": " << bad->text();
      return m;
    }
    if (simulation.time() > s.duration - 0.2) {
      const double mass = simulation.levels().front().mass;
      m.residual_speed =
          std::max(m.residual_speed, std::sqrt(2 * simulation.energies().kinetic / mass));
    }
  }
  m.end = simulation.energies();
  return m;
}

Point centre(const Surface& x) {
  Point sum = Point::Zero();
  for (const Point& p : x) sum += p;
  return sum / static_cast<double>(x.size());
}

/// What is left of a surface's displacement from `rest` without translation and rotation (Kabsch
/// 1976).
Surface shape(const Surface& x, const Surface& rest) {
  const Point c = centre(x), r = centre(rest);
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < x.size(); ++i) H += (x[i] - c) * (rest[i] - r).transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(H, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix3d Q = svd.matrixU() * svd.matrixV().transpose();
  Surface d(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) d[i] = Q.transpose() * (x[i] - c) - (rest[i] - r);
  return d;
}

/// The reference's surface at a time, interpolated.
Surface at(const Motion& m, double time) {
  const auto after = std::min<std::size_t>(
      static_cast<std::size_t>(std::upper_bound(m.time.begin(), m.time.end(), time) -
                               m.time.begin()),
      m.time.size() - 1);
  const double q = std::min(1.0, (time - m.time[after - 1]) / (m.time[after] - m.time[after - 1]));
  Surface x(m.surface[after].size());
  for (std::size_t i = 0; i < x.size(); ++i)
    x[i] = (1 - q) * m.surface[after - 1][i] + q * m.surface[after][i];
  return x;
}

struct Errors {
  double centre = 0, shape = 0;  ///< relative, over the whole run
};

Errors errors(const Motion& run, const Motion& reference) {
  const Surface& rest = reference.surface.front();
  double centre_off = 0, centre_all = 0, shape_off = 0, shape_all = 0;
  for (std::size_t n = 0; n < run.time.size() && run.time[n] <= reference.time.back(); ++n) {
    const Surface truth = at(reference, run.time[n]);
    centre_off += (centre(run.surface[n]) - centre(truth)).squaredNorm();
    centre_all += (centre(truth) - centre(rest)).squaredNorm();
    const Surface d = shape(run.surface[n], rest), want = shape(truth, rest);
    for (std::size_t i = 0; i < d.size(); ++i)
      shape_off += (d[i] - want[i]).squaredNorm(), shape_all += want[i].squaredNorm();
  }
  return {std::sqrt(centre_off / centre_all), std::sqrt(shape_off / shape_all)};
}

void expect_within(const Motion& reference, const std::string& scene, double centre_error,
                   double shape_error, double speed) {
  SCOPED_TRACE(scene);
  const Motion m = run(scene);
  const Errors e = errors(m, reference);
  EXPECT_LT(e.centre, centre_error);
  EXPECT_LT(e.shape, shape_error);
  EXPECT_GT(e.shape, 1e-4) << "too good to be another run";
  EXPECT_LT(m.residual_speed, speed);
  // what gravity has put in by the time the ball rests
  const double fall = -reference.end.potential;
  EXPECT_LT(m.end.total(), m.start.total() + 0.05 * fall);
  const Point c = centre(m.surface.back());
  EXPECT_LT(std::hypot(c[0], c[1]), 5e-3) << "it rests at the bottom";
  EXPECT_GT(c[2], 0.03);
}

TEST(BallScenes, EndInTheBowl) {
  const Motion reference = run("ball_in_bowl_single", 0.25);
  // 0.041, 0.35, 0.054: contact bounds no step, so that of rsv is the longest its elements allow
  expect_within(reference, "ball_in_bowl", 0.05, 0.4, 0.06);
  expect_within(reference, "ball_in_bowl_hybrid", 0.15, 0.60, 0.1);
}

}  // namespace
