// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/drivers/solver/registry.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/generators.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"

// Sound runs pass their check at every macro step (advance() fails otherwise).
namespace {

using namespace plica;
using namespace plica::test;

template <class B>
class NoFalseAlarm : public testing::Test {};
TYPED_TEST_SUITE(NoFalseAlarm, EachBackend);

Problem bouncing(const std::string& cycle) {
  Problem p = cube_levels(2, 4, cycle);
  p.body.material.model = "neo_hookean";
  p.body.surface = sphere_surface({0.05, 0.05, 0.05}, 0.05, 2);
  p.contact.obstacles.push_back({PlaneOptions{{0, 0, -0.02}, {0, 0, 1}}, 0.3, {}});
  p.gravity = {0, 0, -9.81};
  p.body.damping.mass = 5;
  return p;
}

TYPED_TEST(NoFalseAlarm, FallBounceAndRest) {
  Simulation<TypeParam> simulation(bouncing("single"));
  const Energies start = simulation.energies();
  advance(simulation, 1200);
  EXPECT_LT(simulation.energies().total(), start.total());
}

TYPED_TEST(NoFalseAlarm, ThrownUpwardSpinning) {
  Problem p = bouncing("single");
  p.contact.obstacles.clear();
  p.body.damping.mass = 0;
  p.body.initial.velocity = {0, 0, 3};
  p.body.initial.angular_velocity = {5, 2, 0};
  Simulation<TypeParam> simulation(p);
  advance(simulation, 400);
  EXPECT_LT(simulation.velocities()[0][2], 0);  // it came back down
}

TYPED_TEST(NoFalseAlarm, OfTheCyclesThatHold) {
  for (const char* cycle : {"rs", "rsv"}) {
    SCOPED_TRACE(cycle);
    Problem p = bouncing(cycle);
    p.body.levels = {box_mesh(decimetre, {9, 9, 9}), box_mesh(decimetre, {8, 8, 8})};
    p.body.material = {"neo_hookean", 50e3, 0.4, 1000};
    Simulation<TypeParam> simulation(p);
    advance(simulation, 150);
  }
}

// A thousand edges per macro step are nothing to a body as a whole
TYPED_TEST(NoFalseAlarm, OfAFastBodyInFlight) {
  Problem p = small_cube("corotational");
  p.body.initial.velocity = {0, 0, 1000};
  p.body.initial.angular_velocity = {0, 10, 0};
  p.gravity = {0, 0, -9.81};
  Simulation<TypeParam> simulation(p);
  advance(simulation, 100);
}

TYPED_TEST(NoFalseAlarm, OfARestingFreeBody) {
  Simulation<TypeParam> simulation(small_cube());
  advance(simulation, 300);
  EXPECT_LT(simulation.energies().kinetic, 1e-9);
}

TYPED_TEST(NoFalseAlarm, OfAStretchedBodyThatIsLetGo) {
  Problem p = small_cube("corotational");
  Simulation<TypeParam> simulation(p);
  std::vector<Point> u, v(p.body.levels[0].vertices.size(), Point::Zero());
  for (const Point& x : p.body.levels[0].vertices) u.push_back({0.3 * x[0], -0.1 * x[1], -0.1 * x[2]});
  simulation.set_state(u, v);
  advance(simulation, 300);
}

TYPED_TEST(NoFalseAlarm, OfAPushedBody) {
  Problem p = small_cube();
  p.body.prescribed = {{left_face(), Point(0.5, 0, 0)}};
  p.body.damping.mass = 5;
  Simulation<TypeParam> simulation(p);
  advance(simulation, 300);
}

TYPED_TEST(NoFalseAlarm, OfLargeImplicitSteps) {
  Problem p = bouncing("single");
  p.integration.integrator = {"implicit_euler"};
  p.integration.macro_step = 0.017;
  Simulation<TypeParam> simulation(p);
  advance(simulation, 60);
}

// Energy of an undamped body wavers but does not drift, and its parts add up.
TEST(Energies, AreKeptBySymplecticEuler) {
  Problem p = small_cube("st_venant_kirchhoff");
  p.body.fixed = {left_face()};
  Simulation<Host> simulation(p);
  std::vector<Point> u(p.body.levels[0].vertices.size(), Point::Zero()), v;
  for (const Point& x : p.body.levels[0].vertices) v.push_back(x[0] * Point(1, 3, -2));
  simulation.set_state(u, v);
  const double start = simulation.energies().total();
  double highest = 0, elastic = 0;
  for (int n = 0; n < 60; ++n) {
    advance(simulation, 10);
    highest = std::max(highest, std::abs(simulation.energies().total() / start - 1));
    elastic = std::max(elastic, simulation.energies().elastic / start);
  }
  EXPECT_LT(highest, 0.1);
  EXPECT_GT(elastic, 0.5);
}

}  // namespace
