// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <numbers>
#include <plica/drivers/solver/set_up/make_path.hpp>
#include <plica/kernels/motion/path.hpp>

#include "support/bodies.hpp"
#include "support/tolerance.hpp"

// Motions as functions of time.
namespace {

using namespace plica;
using namespace plica::test;

Point point(const Vec3<double>& v) { return {v[0], v[1], v[2]}; }

struct Made {
  explicit Made(const Motion& motion) : path(make_path(motion, knots)) {}
  std::vector<PathKnot> knots;
  Path path;
  Point at(double t) const { return point(path_at(path, knots.data(), t).displacement); }
  Point speed(double t) const { return point(path_at(path, knots.data(), t).velocity); }
};

const PathMotion polygon{{{0.1, {0, 0, 0}}, {0.3, {1, 0, -2}}, {0.4, {1, 5, -2}}, {1.0, {0, 0, 0}}}};
const SineMotion sine{{0.1, 0, -0.2}, 2.5, 0.7};

TEST(Path, SteadyMotionIsSpeedTimesTime) {
  const Made made(Point(1, -2, 3));
  EXPECT_LE((made.at(0.5) - Point(0.5, -1, 1.5)).norm(), round_off<double>(4));
  EXPECT_EQ(made.speed(7), Point(1, -2, 3));
}

TEST(Path, PolygonGoesThroughItsKnotsAndRestsOutside) {
  const Made made(polygon);
  for (const auto& knot : polygon.knots)
    EXPECT_LE((made.at(knot.time) - knot.displacement).norm(), round_off<double>(16)) << knot.time;
  EXPECT_LE((made.at(0.2) - Point(0.5, 0, -1)).norm(), round_off<double>(16));
  EXPECT_LE((made.speed(0.2) - Point(5, 0, -10)).norm(), round_off<double>(64));
  for (double t : {0.0, 0.05, 1.0, 1.5, 1e6}) {
    EXPECT_EQ(made.at(t), Point::Zero()) << t;
    EXPECT_EQ(made.speed(t), Point::Zero()) << t;
  }
  const Made still(PathMotion{{{0, {1, 2, 3}}}});
  EXPECT_EQ(still.at(0), Point(1, 2, 3));
  EXPECT_EQ(still.at(9), Point(1, 2, 3));
}

TEST(Path, SineBeginsAtRestsPlaceAndComesBack) {
  const Made made(sine);
  EXPECT_EQ(made.at(0), Point::Zero());
  for (double t : {0.013, 0.2, 1.7}) {
    const double want = std::sin(2 * std::numbers::pi * 2.5 * t + 0.7) - std::sin(0.7);
    EXPECT_LE((made.at(t) - want * sine.amplitude).norm(), round_off<double>(64)) << t;
  }
  EXPECT_LE(made.at(4000).norm(), round_off<double>(1e5));  // ten thousand periods later
  const Made gentle(SineMotion{{1, 0, 0}, 3, -std::numbers::pi / 2});
  EXPECT_LE(gentle.speed(0).norm(), round_off<double>(64));
  EXPECT_NEAR(gentle.at(1.0 / 6)[0], 2, round_off<double>(64));
}

TEST(Path, SpeedIsTheSlope) {
  for (const Motion& motion : {Motion(SteadyMotion(Point(1, -2, 3))), Motion(polygon), Motion(sine)}) {
    const Made made(motion);
    for (double t : {0.15, 0.27, 0.33, 0.55, 0.9, 2.0}) {
      const double h = 1e-6;
      const Point slope = (made.at(t + h) - made.at(t - h)) / (2 * h);
      EXPECT_LE((slope - made.speed(t)).norm(), 1e-7) << t;
    }
  }
}

TEST(Path, AStepAheadEndsWhereThePathDoes) {
  for (const Motion& motion : {Motion(polygon), Motion(sine)}) {
    const Made made(motion);
    for (double t : {0.0, 0.25, 0.38, 0.95})
      for (double h : {1e-3, 0.1, 1.0}) {
        const PathPoint p = path_step(made.path, made.knots.data(), t, h);
        EXPECT_EQ(point(p.displacement), made.at(t));
        EXPECT_LE((point(p.displacement) + h * point(p.velocity) - made.at(t + h)).norm(), round_off<double>(64));
      }
  }
}

TEST(Path, SeveralShareOneListOfKnots) {
  std::vector<PathKnot> knots;
  make_path(PathMotion{{{0, {7, 7, 7}}, {1, {8, 8, 8}}}}, knots);
  const Path second = make_path(polygon, knots);
  EXPECT_LE((point(path_at(second, knots.data(), 0.2).displacement) - Point(0.5, 0, -1)).norm(), round_off<double>(16));
}

TEST(Path, KnowsWhetherItMoves) {
  EXPECT_FALSE(moves({}));
  EXPECT_TRUE(moves(Point(0, 1, 0)));
  EXPECT_TRUE(moves(sine));
  EXPECT_TRUE(moves(polygon));
  EXPECT_FALSE(moves(PathMotion{{{0, {1, 2, 3}}, {1, {1, 2, 3}}}}));
  EXPECT_FALSE(moves(SineMotion{}));
}

}  // namespace
