// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <plica/drivers/body/masses.hpp>
#include <plica/drivers/contact/turning.hpp>
#include <plica/drivers/run/energy_meter.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/generators.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// What turning obstacles hold, and those that a program turns.
namespace {

using namespace plica;
using namespace plica::test;

constexpr double pi = std::numbers::pi, side = 0.06;

/// A cube from 0 to `side` along every axis.
Problem cube() {
  Problem p = body_of({box_mesh({{0, 0, 0}, {side, side, side}}, {4, 4, 4})}, "neo_hookean");
  p.body.surface = boundary_surface(p.body.levels[0]).surface;
  return p;
}

Eigen::Matrix3d rotation(const Point& vector) {
  return Eigen::AngleAxisd(vector.norm(), vector.normalized()).toRotationMatrix();
}

double largest_difference(const std::vector<Point>& a, const std::vector<Point>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, (a[i] - b[i]).norm());
  return most;
}

/// A plate above the cube holds its top, and turns about a hinge beside it.
Problem carried(const Turn& turn) {
  Problem p = cube();
  ObstacleOptions plate{
      BlockOptions{{side / 2, side / 2, side + 0.0105}, {0.2, 0.2, 0.02}, {0, 0, 0}}, {}, {}};
  plate.name = "plate",
  plate.grasp = GraspOptions{.from = {0}, .until = {}, .reach = 1e-3, .stiffness = {}};
  plate.turn = turn;
  p.contact.obstacles = {plate};
  p.integration.macro_step = 2e-4;
  return p;
}

const Point hinge(0.1, 0, 0.02);
const Turn quarter{{0, 1, 0}, hinge, {0, 0, 0}, PathTurn{{{0, 0}, {0.3, pi / 2}}}};

TEST(TurnedByTools, CarryAndTurnWhatTheyHold) {
  const Eigen::Matrix3d R = rotation({0, pi / 2, 0});
  for (const char* cycle : {"single", "rs", "him"}) {
    Problem p = carried(quarter);
    p.body.damping.mass = 20;
    p.integration.cycle = cycle;
    if (p.integration.cycle != "single")
      p.body.levels.push_back(box_mesh({{0, 0, 0}, {side, side, side}}, {2, 2, 2}));
    Simulation<Host> s(p);
    while (s.time() < 0.8) advance(s, 1);
    ASSERT_EQ(s.held()[0].points.size(), 25u);
    // they are, and the cube with them
    const auto x = s.positions();
    double worst = 0;
    for (std::size_t v = 0; v < x.size(); ++v)
      worst = std::max(worst, (x[v] - hinge - R * (p.body.levels[0].vertices[v] - hinge)).norm());
    EXPECT_LT(worst, 0.01 * side) << cycle;
  }
}

// Angular momentum changes by the wrench's torque about the plate's centre, which turns with it: by
// leapfrog to rounding.
TEST(TurnedByTools, TorqueIsTheChangeOfAngularMomentum) {
  Problem p = carried({{1, 2, 0}, hinge, {0, 0, 0}, SineTurn{0.5, 4, 0.3}});
  p.contact.obstacles[0].motion = SteadyMotion{Point(0.1, 0, 0)};
  Simulation<Host> s(p);
  const auto mass = lumped_masses(p.body.levels[0], {p.body.material.density});
  const auto turning = [&] {
    Point sum = Point::Zero();
    const auto x = s.positions(), v = s.velocities();
    for (std::size_t a = 0; a < x.size(); ++a) sum += mass[a] * x[a].cross(v[a]);
    return sum;
  };
  Point before = turning();
  double most = 0;
  for (int n = 0; n < 400; ++n) {
    const Point at = s.obstacle_origin(0);
    advance(s, 1);
    const Point now = turning();
    const Wrench w = s.wrenches()[0];
    EXPECT_LE((now - before - 2e-4 * (w.torque + at.cross(w.force))).norm(),
              round_off<double>(20000, 0.01))
        << n;
    before = now, most = std::max(most, w.torque.norm());
  }
  EXPECT_GT(most, 0.01);
}

// The work of the plate, its force times the way of its centre and its torque times its angle, is
// the energy that the body gets.
TEST(TurnedByTools, WorkIsTheEnergyOfTheBody) {
  Problem p = carried({{1, 2, 0}, hinge, {0, 0, 0}, SineTurn{0.3, 4, 0}});
  p.contact.damping_scale = 0;
  p.integration.macro_step = 5e-5;
  Simulation<Host> s(p);
  advance(s, 1);
  ObstacleWork<Host> work(s, p);
  const double start = s.energies().total();
  double most = 0, off = 0;
  for (int n = 0; n < 4000; ++n) {
    advance(s, 1), work.step(s);
    if (n % 50 > 0) continue;
    const double now = s.energies().total() - start;
    most = std::max(most, std::abs(now)), off = std::max(off, std::abs(now - work.done()));
  }
  EXPECT_GT(most, 0.01);
  EXPECT_LT(off, 0.06 * most);
  EXPECT_TRUE(moves(p.contact.obstacles[0]));
}

TEST(TurnedByTools, GoOnFromASavedState) {
  for (const char* cycle : {"single", "him"}) {
    Problem p = carried({{1, 2, 0}, hinge, {0, 0, 0.1}, SineTurn{0.3, 4, 0}});
    p.integration.cycle = cycle;
    if (p.integration.cycle == "him")
      p.body.levels.push_back(box_mesh({{0, 0, 0}, {side, side, side}}, {2, 2, 2}));
    Simulation<Host> s(p), other(p);
    advance(s, 100);
    const SavedState saved = s.save();
    advance(s, 100);
    other.restore(saved);
    advance(other, 100);
    EXPECT_TRUE(same_bits(s.positions(), other.positions())) << cycle;
  }
}

// --- By a program ---

// Turned step by step to the angles of a path, with a displacement beside it, it goes as by the
// path.
TEST(TurnedByTools, GoByAProgramAsByAPath) {
  const Point velocity(0.02, 0, 0.01), along = Point(1, 2, 0).normalized();
  Problem by_path = carried({{1, 2, 0}, hinge, {0, 0, 0}, SteadyTurn{2}}), by_program = by_path;
  by_path.contact.obstacles[0].motion = SteadyMotion{velocity};
  by_program.contact.obstacles[0].turn->angle = SteadyTurn{0};
  Simulation<Host> told(by_path), moved(by_program);
  for (int n = 1; n <= 300; ++n) {
    const double time = told.time() + told.macro_step();
    moved.move_obstacle(0, time * velocity, 2 * time * along);
    advance(told, 1), advance(moved, 1);
    EXPECT_LE((moved.obstacle_rotation(0) - 2 * time * along).norm(), 1e-12);
    EXPECT_LE((moved.obstacle_origin(0) - told.obstacle_origin(0)).norm(), 1e-12);
  }
  EXPECT_LE(largest_difference(told.positions(), moved.positions()), 1e-9);
}

TEST(TurnedByTools, TurnOnWhileTheyAreMoved) {
  Simulation<Host> s(carried({{0, 0, 1}, {}, {0, 0, 0}, SteadyTurn{2}}));
  s.move_obstacle(0, {0, 0, 0.001});
  advance(s, 10);
  EXPECT_LE((s.obstacle_rotation(0) - Point(0, 0, 2 * s.time())).norm(), 1e-12);
  EXPECT_EQ(s.obstacle_displacement(0), Point(0, 0, 0.001));
  s.set_obstacle_turn(0, {});
  EXPECT_EQ(s.obstacle_rotation(0), Point(0, 0, 0));
  s.set_obstacle_turn(0, Turn{{1, 0, 0}, {}, {0, 0, 0}, PathTurn{{{0, 1}}}});
  EXPECT_LE((s.obstacle_rotation(0) - Point(1, 0, 0)).norm(), 1e-14);
}

}  // namespace
