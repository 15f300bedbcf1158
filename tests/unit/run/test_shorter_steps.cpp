// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/files/mesh_files.hpp>
#include <plica/meshes/jitter.hpp>
#include <plica/meshes/organs.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// Steps that become shorter: explicit ones whose number is automatic, of a body that stiffens
// beyond the limit it has at rest; implicit ones in which the surface turns about the places where
// a tool touches it.
namespace {

using namespace plica;
using namespace plica::test;

/// A ball is pressed into a liver that is held on one side.
Problem pressed_liver() {
  Problem p = body_of({read_mesh(PLICA_SOURCE_DIR "/meshes/data/organs/liver.vtk")}, "neo_hookean");
  p.body.element = {"nodal"};
  p.body.material.young_modulus = 20e3, p.body.material.poisson_ratio = 0.45;
  p.body.fixed = {HalfSpaceSelection{{0, 0, 0}, {1, 0, 0}}};
  p.body.surface = boundary_surface(p.body.levels[0]).surface;
  p.gravity = {0, 0, -9.81};
  p.contact.obstacles.push_back(
      {SphereOptions{{0.06, 0, 0.047}, 8e-3}, {}, SineMotion{{0, 0, -12e-3}, 2, 0}});
  return p;
}

TEST(ShorterSteps, AreTakenWhereTheBodyStiffens) {
  Simulation<Host> simulation(pressed_liver());
  simulation.end_at(0.2);
  while (simulation.time() < 0.2)
    if (const auto bad = simulation.step_checked()) FAIL() << bad->text();
  EXPECT_GE(simulation.counters().at("substep_halvings"), 1);

  Problem given = pressed_liver();  // a step that was asked for is not changed
  given.integration.macro_step = simulation.macro_step();
  given.integration.substeps = {1};
  Simulation<Host> stops(given);
  bool stopped = false;
  while (stops.time() < 0.2 && !stopped) stopped = stops.step_checked().has_value();
  EXPECT_TRUE(stopped);
  EXPECT_FALSE(stops.counters().contains("substep_halvings"));
}

/// Forces that one macro step takes.
long forces_of_a_step(Simulation<Host>& simulation) {
  const auto forces = [&] { return simulation.counters().at("force_evaluations"); };
  const long before = forces();
  if (const auto bad = simulation.step_checked()) ADD_FAILURE() << bad->text();
  return forces() - before;
}

// A cube is pressed to half its length, and comes back.
TEST(ShorterSteps, AreGivenBackWhereTheBodyIsCalm) {
  for (const char* cycle : {"single", "him"}) {
    Problem p = small_cube("neo_hookean", 6);
    p.body.damping.mass = 20;
    p.body.fixed = {left_face()};
    p.body.prescribed = {{Box{{0.1, -1, -1}, {1, 1, 1}},
                          PathMotion{{{0, {0, 0, 0}}, {0.2, {-0.05, 0, 0}}, {0.4, {0, 0, 0}}}}}};
    p.integration.cycle = cycle;
    Simulation<Host> simulation(p);
    const long whole = forces_of_a_step(simulation);
    while (simulation.time() < 0.2) ASSERT_FALSE(simulation.step_checked());
    const long cut = forces_of_a_step(simulation);
    Simulation<Host> resumed(p);
    resumed.restore(simulation.save());
    for (Simulation<Host>* one : {&simulation, &resumed})
      while (one->time() < 4) ASSERT_FALSE(one->step_checked());
    EXPECT_TRUE(same_bits(resumed.positions(), simulation.positions())) << cycle;
    EXPECT_GE(cut, 2 * whole) << cycle;
    EXPECT_GE(simulation.counters().at("substeps_regained"), 1) << cycle;
    EXPECT_EQ(forces_of_a_step(simulation), whole) << cycle;
  }
}

/// A cube that is pressed to a fifth of its length, by the cycle him.
Problem crushed_cube() {
  Problem p = small_cube("neo_hookean", 6);
  p.body.damping.mass = 20;
  p.body.fixed = {left_face()};
  p.body.prescribed = {
      {Box{{0.1, -1, -1}, {1, 1, 1}}, PathMotion{{{0, {0, 0, 0}}, {0.4, {-0.08, 0, 0}}}}}};
  p.integration.cycle = "him";
  return p;
}

// Where a step that an inertia fits is shorter than what level 0 alone may take.
TEST(ShorterSteps, OfHimGiveWayToExplicitOnes) {
  Problem p = crushed_cube();
  Simulation<Host> him(p);
  while (him.time() < 0.4) ASSERT_FALSE(him.step_checked());
  EXPECT_GE(him.counters().at("him_explicit_steps"), 1);
  Simulation<Host> resumed(p);
  resumed.restore(him.save());
  p.integration.cycle = "single", p.integration.safety = 0.4;
  Simulation<Host> single(p);
  single.end_at(him.time());
  while (single.time() < him.time()) ASSERT_FALSE(single.step_checked());
  EXPECT_LE(largest_difference(him.positions(), single.positions()), 2e-3);
  advance(him, 3), advance(resumed, 3);
  EXPECT_TRUE(same_bits(resumed.positions(), him.positions()));
}

// What a driver has recorded of them is replaced step by step.
TEST(ShorterSteps, OfHimTellWhatIsTakenAgain) {
  Simulation<Host> him(crushed_cube());
  std::vector<long> again;
  him.on_repeated_step([&] { again.push_back(him.macro_steps()); });
  long replaced = 0;
  while (him.time() < 0.4) {
    const long earliest = him.earliest_kept();
    again.clear();
    ASSERT_FALSE(him.step_checked());
    if (again.empty()) continue;
    replaced += std::ssize(again);
    EXPECT_GT(again.front(), earliest);
    EXPECT_EQ(again.back(), him.macro_steps());
    for (std::size_t i = 1; i < again.size(); ++i)
      EXPECT_LE(again[i], again[i - 1] + 1) << "on, or back to a kept state";
  }
  EXPECT_GT(replaced, 1);
}

/// A tube that is blown up slowly, whose wall stiffens beyond the limit at rest; the largest
/// kinetic energy that a caller sees, looking at every tenth step [J].
double most_motion(double safety, long& halvings) {
  Tube tube;
  tube.radius = 0.004, tube.wall = 0.001, tube.length = 0.03, tube.bend = 0;
  tube.around = 12, tube.across = 1, tube.along = 8;
  Problem p = body_of({tube_mesh(tube)}, "neo_hookean");
  p.body.material.young_modulus = 50e3, p.body.material.poisson_ratio = 0.49;
  p.body.fixed = {GroupSelection{"inlet"}, GroupSelection{"outlet"}};
  p.body.loads = {{GroupSelection{"lumen"}, EnclosedVolume{1.7, 100e3}, RampCourse{0.2}}};
  p.integration.safety = safety;
  Simulation<Host> simulation(p);
  double most = 0;
  for (int n = 0; simulation.time() < 0.22; ++n) {
    if (const auto bad = simulation.step_checked()) ADD_FAILURE() << bad->text();
    if (n % 10 == 0) most = std::max(most, simulation.energies().kinetic);
  }
  halvings = simulation.counters().at("substep_halvings");
  return most;
}

TEST(ShorterSteps, AreTakenBeforeLostStabilityShows) {
  long cut = 0, none = 0;
  const double most = most_motion(0.9, cut), steady = most_motion(0.5, none);
  EXPECT_GE(cut, 1);
  EXPECT_EQ(none, 0);
  EXPECT_LT(most, 16 * steady);
}

// Steps that are taken again see obstacles that a caller moves step by step where they were the
// first time.
TEST(ShorterSteps, AreTakenAgainWithObstaclesWhereTheyWere) {
  Problem p = pressed_liver();
  p.contact.obstacles[0].motion = {};
  Simulation<Host> s(p);
  const auto way = [](double time) {
    return Point(0, 0, -12e-3 * std::sin(4 * std::numbers::pi * time));
  };
  while (s.time() < 0.1) {
    s.move_obstacle(0, way(s.time() + s.macro_step()));
    ASSERT_FALSE(s.step_checked());
  }
  const double end = s.time();
  const std::vector<Point> want = s.positions();
  s.return_to_last_good();
  ASSERT_LT(s.time(), end);
  EXPECT_LT((s.obstacle_displacement(0) - way(s.time())).norm(), 1e-12);
  while (s.time() < end) s.step();
  EXPECT_TRUE(same_bits(s.positions(), want));
  s.return_to_last_good();
  const Point here = s.obstacle_displacement(0);
  s.set_time(s.time());  // nothing before or after counts any more
  advance(s, 3);
  EXPECT_LT((s.obstacle_displacement(0) - here).norm(), 1e-12);
}

TEST(ShorterSteps, GoOnAfterACheckpoint) {
  Simulation<Host> whole(pressed_liver()), second(pressed_liver());
  while (whole.counters().at("substep_halvings") == 0) ASSERT_FALSE(whole.step_checked());
  second.restore(whole.save());
  for (Simulation<Host>* one : {&whole, &second}) advance(*one, 30);
  EXPECT_EQ(second.counters().at("substep_halvings"), whole.counters().at("substep_halvings"));
  EXPECT_TRUE(same_bits(whole.positions(), second.positions()));
}

/// The force [N] of a rod that is pressed 13 mm into an organ and held there.
double force_of_a_held_rod(const std::string& integrator, std::optional<double> step,
                           long* halvings = nullptr) {
  Problem p = body_of({jittered(blob_mesh({0, 0, 0}, 0.16, 8), 0.2)}, "neo_hookean");
  p.body.element = {"nodal"};
  p.body.material.young_modulus = 50e3, p.body.material.poisson_ratio = 0.45;
  p.body.fixed = {HalfSpaceSelection{{0, 0, 0}, {0, 0, 1}}};
  p.body.surface = boundary_surface(p.body.levels[0]).surface;
  p.body.damping.mass = 20;
  const PathMotion path{{{0, {0, 0, 0}}, {0.1, {0, 0, -0.03}}, {1, {0, 0, -0.03}}}};
  p.contact.obstacles.push_back(
      {CapsuleOptions{{-0.01, 0.005, 0.06}, {-0.01, 0.005, 0.2}, 8e-3}, 0.3, path});
  p.integration.integrator = {integrator}, p.integration.macro_step = step;
  Simulation<Host> s(p);
  while (s.time() < 0.25)
    if (const auto bad = s.step_checked()) ADD_FAILURE() << bad->text();
  if (halvings) *halvings = s.counters().at("step_halvings");
  return -s.wrenches()[0].force[2];
}

// With steps that stay as long as they are, the surface would turn to and fro about those places
// for ever and creep along the rod.
TEST(ShorterSteps, AreTakenWhereContactWasNotForeseen) {
  long halvings = 0;
  const double by_explicit = force_of_a_held_rod("symplectic_euler", {}),
               found = force_of_a_held_rod("implicit_euler", 5e-3, &halvings);
  EXPECT_GT(by_explicit, 25);
  EXPECT_NEAR(found, by_explicit, 0.05 * by_explicit);
  EXPECT_GT(halvings, 0);
}

}  // namespace
