// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <plica/drivers/body/masses.hpp>
#include <plica/drivers/run/energy_meter.hpp>
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

/// A rod is pressed 13 mm into an organ and held there.
Problem held_rod(const std::string& integrator, std::optional<double> step) {
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
  return p;
}

/// The force of the rod [N].
double force_of_a_held_rod(const std::string& integrator, std::optional<double> step,
                           long* halvings = nullptr) {
  Simulation<Host> s(held_rod(integrator, step));
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

// A second step in a row that ends in contact that it did not know of is taken in halves, also
// where the first one was before a saved state.
TEST(ShorterSteps, KnowFromASavedStateWhatWasNotForeseen) {
  const Problem p = held_rod("implicit_euler", 5e-3);
  Simulation<Host> whole(p);
  const auto halvings = [](const Simulation<Host>& s) { return s.counters().at("step_halvings"); };
  int compared = 0;
  while (whole.time() < 0.25 && compared < 3) {
    const SavedState saved = whole.save();
    const long before = halvings(whole);
    advance(whole, 1);
    if (halvings(whole) == before) continue;
    Simulation<Host> resumed(p);
    resumed.restore(saved);
    advance(resumed, 1);
    EXPECT_EQ(halvings(resumed), halvings(whole)) << whole.time();
    EXPECT_TRUE(same_bits(resumed.positions(), whole.positions())) << whole.time();
    ++compared;
  }
  EXPECT_GT(compared, 0);
}

// A step that is taken again from a kept state knows what that state knew: that its contact was
// foreseen. Else the first surprise would count as the second, and the step would be halved.
TEST(ShorterSteps, AreNotTakenForASurpriseThatWasTakenBack) {
  Simulation<Host> s(held_rod("implicit_euler", 5e-3));
  const auto halvings = [&] { return s.counters().at("step_halvings"); };
  while (s.time() < 0.25) {
    s.step();
    if (halvings() > 0) break;  // of the second surprise in a row: the one before was not halved
    s.return_to_last_good();
    s.step();
    ASSERT_EQ(halvings(), 0) << s.time();
    s.return_to_last_good();
    ASSERT_FALSE(s.step_checked());
  }
  EXPECT_GT(halvings(), 0);
}

const Point push(0, 0, 0.5);  // velocity of the plane below [m/s]

/// A free cube that a plane meets from below. All its momentum comes from the plane: the plane's
/// work is the momentum times the plane's velocity, whatever the steps are.
Problem pushed_cube() {
  Problem p = small_cube("neo_hookean");
  p.body.surface = boundary_surface(p.body.levels[0]).surface;
  p.contact.obstacles.push_back({PlaneOptions{{0, 0, -5e-4}, {0, 0, 1}}, {}, SteadyMotion(push)});
  return p;
}

/// What the plane must have done so far [J].
double work_by_momentum(const Simulation<Host>& s, const Problem& p) {
  const auto mass = lumped_masses(p.body.levels[0], {p.body.material.density});
  const auto v = s.velocities();
  double sum = 0;
  for (std::size_t a = 0; a < mass.size(); ++a) sum += mass[a] * push.dot(v[a]);
  return sum;
}

// Forces of contact change much from step to step: the work of a short step is that of its own.
TEST(ShorterSteps, CountTheWorkOfObstaclesWhereARunEndsWithinOne) {
  const Problem p = pushed_cube();
  Simulation<Host> s(p);
  ObstacleWork<Host> work(s, p);
  for (int n = 0; n < 60; ++n) {
    s.end_at(s.time() + 0.3 * s.macro_step());
    advance(s, 1), work.step(s);
    EXPECT_NEAR(work.done(), work_by_momentum(s, p), 1e-9) << n;
    s.end_at(std::numeric_limits<double>::infinity());
    advance(s, 1), work.step(s);
    EXPECT_NEAR(work.done(), work_by_momentum(s, p), 1e-9) << n;
  }
  EXPECT_GT(work.done(), 0.1);
  EXPECT_TRUE(work.known());
}

// Steps that are never solved are taken in their shortest parts: the force is the mean over these.
TEST(ShorterSteps, CountTheWorkOfObstaclesOverAllParts) {
  Problem p = pushed_cube();
  p.integration.integrator = {"implicit_euler"}, p.integration.macro_step = 4e-3;
  p.integration.implicit.newton_iterations = 2, p.integration.implicit.newton_tolerance = 1e-9;
  p.integration.implicit.relative_residual = 1e-9;
  p.integration.on_failure.halvings = 3;
  Simulation<Host> s(p);
  ObstacleWork<Host> work(s, p);
  double before = 0, wanted = 0, most = 0, off = 0;
  for (int n = 0; n < 20; ++n) {
    advance(s, 1), work.step(s);
    const double done = work.done() - std::exchange(before, work.done()),
                 want = work_by_momentum(s, p) - std::exchange(wanted, work_by_momentum(s, p));
    most = std::max(most, std::abs(want)), off = std::max(off, std::abs(done - want));
  }
  EXPECT_GT(s.counters().at("step_halvings"), 0);
  EXPECT_GT(most, 0.01);
  EXPECT_LT(off, 0.02 * most);
}

/// A cube whose steps Newton's method never solves: they are taken in parts.
Problem halved_cube() {
  Problem p = small_cube("neo_hookean", 2);
  p.integration.integrator = {"implicit_euler"};
  p.integration.implicit.newton_iterations = 2, p.integration.implicit.newton_tolerance = 1e-12;
  p.integration.on_failure.halvings = 3;
  return p;
}

// Each part of a step has its own time: given motions end where they must.
TEST(ShorterSteps, FollowGivenMotionsInTheirOwnTime) {
  Problem p = halved_cube();
  const SineMotion motion{{0.02, 0, 0.01}, 3, 0.4};
  p.body.prescribed = {{left_face(), motion}};
  p.integration.macro_step = 0.01;
  Simulation<Host> s(p);
  const auto& rest = p.body.levels[0].vertices;
  for (int n = 1; n <= 30; ++n) {
    advance(s, 1);
    const auto x = s.positions();
    const double angle = 2 * std::numbers::pi * motion.frequency * s.time() + motion.phase;
    const Point at = (std::sin(angle) - std::sin(motion.phase)) * motion.amplitude;
    for (std::size_t a = 0; a < x.size(); ++a)
      if (rest[a][0] == 0) {
        EXPECT_LE((x[a] - rest[a] - at).norm(), 1e-12) << n;
      }
  }
  EXPECT_GT(s.counters().at("step_halvings"), 0);
}

// A load that grows slowly bends a body as far as it has grown, whatever the steps are.
TEST(ShorterSteps, SeeLoadsInTheirOwnTime) {
  Problem p = halved_cube();
  p.body.fixed = {left_face()};
  p.body.loads = {
      {Box{{0.1, -1, -1}, {1, 1, 1}}, TotalForce{{0, 0, 4}}, PolygonCourse{{{0, 0}, {2, 1}}}}};
  p.integration.macro_step = 0.25;
  Simulation<Host> halved(p);
  p.integration.macro_step = 0.25 / 8;
  p.integration.implicit.newton_iterations = 40, p.integration.implicit.newton_tolerance.reset();
  Simulation<Host> small(p);
  for (int n = 1; n <= 8; ++n) {
    advance(halved, 1), advance(small, 8);
    ASSERT_NEAR(halved.time(), small.time(), 1e-12);
    const auto a = displacements(halved, p.body.levels[0]),
               b = displacements(small, p.body.levels[0]);
    EXPECT_GT(largest(b), 1e-4 * n);
    EXPECT_LE(largest_difference(a, b), 0.05 * largest(b)) << n;
  }
  EXPECT_GT(halved.counters().at("step_halvings"), 0);
}

}  // namespace
