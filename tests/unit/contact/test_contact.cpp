// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <numbers>
#include <plica/drivers/contact/contact.hpp>
#include <plica/drivers/study/level_probe.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/generators.hpp>
#include <plica/meshes/mesh_quality.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/refusal.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// Penalty contact of a body with the options' obstacles.
namespace {

using namespace plica;
using namespace plica::test;

/// A cube that stands on (or over) the plane z = 0, its own vertices as contact surface.
Problem cube_over(double gap, std::optional<double> friction = {}) {
  Problem p = body_of({box_mesh(decimetre, {3, 3, 3})}, "corotational");
  TriangleSurface surface;
  surface.vertices =
      p.body.levels[0]
          .vertices;  // every mesh vertex is a contact point; the sides' and inner ones never touch
  const auto at = [](int x, int y, int z) { return x + 4 * (y + 4 * z); };
  for (int z : {0, 3})
    for (int x = 0; x < 3; ++x)
      for (int y = 0; y < 3; ++y) {
        surface.triangles.push_back({at(x, y, z), at(x + 1, y, z), at(x, y + 1, z)});
        surface.triangles.push_back({at(x + 1, y, z), at(x + 1, y + 1, z), at(x, y + 1, z)});
      }
  p.body.surface = surface;
  p.contact.obstacles.push_back({PlaneOptions{{0, 0, -gap}, {0, 0, 2}}, friction, {}});
  return p;
}

Point sum(const std::vector<Point>& f) {
  Point total = Point::Zero();
  for (const Point& x : f) total += x;
  return total;
}

template <class B>
class ContactOn : public testing::Test {};
TYPED_TEST_SUITE(ContactOn, EachBackend);

// A smooth skin around a coarse mesh lies outside it in most of its points.
TYPED_TEST(ContactOn, SurfacePointsOutsideTurnWithTheBody) {
  constexpr double radius = 0.05;
  Problem p = body_of({ball_mesh({0, 0, 0}, radius, 6)}, "neo_hookean");
  p.body.surface = sphere_surface({0, 0, 0}, radius, 2);
  Simulation<TypeParam> simulation(p);
  std::vector<Point> turn;
  for (const Point& x : p.body.levels[0].vertices) turn.push_back(Point(-x[1], x[0], x[2]) - x);
  simulation.set_state(turn, std::vector<Point>(turn.size(), Point::Zero()));
  const std::vector<Point> x = simulation.surface_positions();
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Point& X = p.body.surface->vertices[i];
    EXPECT_LT((x[i] - Point(-X[1], X[0], X[2])).norm(),
              round_off<typename TypeParam::Real>(64, radius));
  }
}

TYPED_TEST(ContactOn, StiffnessIsYoungsModulusTimesAreaOverEdge) {
  Problem p = cube_over(0);
  p.contact.stiffness_scale = 3, p.contact.damping_scale = 0.5;
  LevelProbe<TypeParam> probe(p);
  const double area = 0.02 / 64, edge = mean_edge_length(p.body.levels[0]),
               k = 3 * 64 * 20e3 * area / edge;
  EXPECT_NEAR(probe.at(0).contact()->stiffness(), k, round_off<double>(50, k));
  const double d = 0.5 * std::sqrt(k * 1000 * area * edge);
  EXPECT_NEAR(probe.at(0).contact()->damping(), d, round_off<double>(50, d));
}

TYPED_TEST(ContactOn, ForceOnASunkenBodyIsThePenalty) {
  using Real = typename TypeParam::Real;
  Problem p = cube_over(0, 0.4);
  LevelProbe<TypeParam> probe(p);
  const auto& contact = *probe.at(0).contact();
  const double k = contact.stiffness(), depth = 0.002;
  std::vector<Point> down(probe.vertices(), Point(0, 0, -depth));
  EXPECT_LE((sum(probe.force(down)) - Point(0, 0, 16 * k * depth)).norm(),
            round_off<Real>(2000, k * depth));
  EXPECT_LE(sum(probe.force(std::vector<Point>(probe.vertices(), Point(0, 0, 1e-4)))).norm(),
            round_off<Real>(500, 1));
}

TYPED_TEST(ContactOn, MovingObstacleIsWhereItsVelocityTakesIt) {
  using Real = typename TypeParam::Real;
  Problem p = cube_over(0.01);
  p.contact.obstacles[0].motion = Point(0, 0, 0.5);
  p.contact.damping_scale = 0;
  LevelProbe<TypeParam> probe(p);
  const double k = probe.at(0).contact()->stiffness();
  const auto z = probe.zero();
  EXPECT_LE(largest(probe.force(z, z, 0.019)), round_off<Real>(500, 1));
  EXPECT_NEAR(sum(probe.force(z, z, 0.024))[2], 16 * k * 0.002, round_off<Real>(2000, k * 0.01));
}

TYPED_TEST(ContactOn, EnergyIsHalfStiffnessTimesDepthSquared) {
  using Real = typename TypeParam::Real;
  Problem p = cube_over(-0.001);  // the plane's surface is 1 mm inside the body
  p.integration.macro_step = 1e-4;
  Simulation<TypeParam> simulation(p);
  const double k = LevelProbe<TypeParam>(p).at(0).contact()->stiffness();
  EXPECT_NEAR(simulation.energies().contact, 16 * 0.5 * k * 1e-6, round_off<Real>(2000, k * 1e-6));
}

// Sum of contact forces at rest: the mean over a long time balances the weight.
TEST(Contact, CarriesTheWeightAtRest) {
  for (const char* integrator : {"symplectic_euler", "implicit_euler"}) {
    Problem p = cube_over(0, 0.3);
    p.gravity = {0, 0, -9.81};
    p.body.damping.mass = 20;
    p.integration.integrator = {integrator};
    p.integration.macro_step = 4e-3;
    p.integration.substeps = {0};
    Simulation<Host> simulation(p);
    advance(simulation, 400);
    EXPECT_LE(largest(simulation.velocities()), 1e-6) << integrator;
    LevelProbe<Host> probe(p);
    const auto u = displacements(simulation, p.body.levels[0]);
    double contact = 9.81;  // elastic forces sum to zero, so this is contact alone
    contact += sum(probe.force(u))[2];
    EXPECT_NEAR(contact, 9.81, 1e-5 * 9.81) << integrator;
  }
}

// Sliding: the centre of mass decelerates at mu g.
TEST(Contact, FrictionStopsASlidingBlock) {
  for (const char* integrator : {"symplectic_euler", "implicit_euler"}) {
    Problem p = cube_over(0, 0.2);
    p.body.material.young_modulus = 2e5;  // stiff: it does not topple or rock much
    p.gravity = {0, 0, -10};
    p.integration.integrator = {integrator};
    p.integration.macro_step = 1e-3;
    p.integration.substeps = {0};
    // settle first, then push
    p.body.damping.mass = 50;
    Simulation<Host> settled(p);
    advance(settled, 150);
    const auto u = displacements(settled, p.body.levels[0]);
    p.body.damping.mass = 0;
    Simulation<Host> simulation(p);
    simulation.set_state(u, std::vector<Point>(u.size(), Point(0.6, 0, 0)));
    const auto mean = [&] {
      return sum(simulation.velocities())[0] / static_cast<double>(u.size());
    };
    advance(simulation, 100);
    EXPECT_NEAR(mean(), 0.6 - 0.2 * 10 * simulation.time(), 2e-3) << integrator;
    advance(simulation, 200);  // it sticks, and rings by the stiffness of its elements
    double rest = 0;
    for (int n = 0; n < 100; ++n) advance(simulation, 1), rest += mean() / 100;
    EXPECT_NEAR(rest, 0, 4e-3) << integrator;
  }
}

TEST(Contact, SlopeBelowTheFrictionAngleHoldsAndAboveDoesNot) {
  const auto slid = [](double friction) {
    Problem p = cube_over(0, friction);
    p.gravity = 10 * Point(std::sin(0.2), 0, -std::cos(0.2));  // tan 0.2 = 0.203
    p.body.material.young_modulus = 2e5;
    p.body.damping.mass = 5;
    p.contact.tangential_damping_scale = 20;  // little creep
    p.integration.macro_step = 2e-3;
    p.integration.integrator = {"implicit_euler"};
    Simulation<Host> simulation(p);
    advance(simulation, 250);
    const auto v = simulation.velocities();
    return sum(v)[0] / static_cast<double>(v.size());
  };
  EXPECT_NEAR(slid(0.4), 0, 3e-3);
  EXPECT_NEAR(slid(0.1), 10 * (std::sin(0.2) - 0.1 * std::cos(0.2)) * (1 - std::exp(-5 * 0.5)) / 5,
              1e-3);
}

// A body thrown at the floor with steps far above the explicit limit neither blows up nor sinks
// through it.
TEST(Contact, ImplicitStepsSurviveAFastImpact) {
  for (int newton : {1, 10})
    for (double speed : {1.0, 10.0}) {
      Problem p = cube_over(0.05);
      p.body.initial.velocity = {0, 0, -speed};
      p.gravity = {0, 0, -9.81};
      p.integration.integrator = {"implicit_euler"};
      p.integration.macro_step = 0.01;
      p.integration.implicit.newton_iterations = newton;
      Simulation<Host> simulation(p);
      double lowest = 0;
      for (int n = 0; n < 30; ++n) {
        advance(simulation, 1);
        for (const Point& x : simulation.positions()) lowest = std::min(lowest, x[2] + 0.05);
      }
      EXPECT_GT(lowest, -0.09) << newton << " " << speed;
      EXPECT_LE(largest(simulation.velocities()), 1) << newton << " " << speed;
      EXPECT_EQ(simulation.counters().at("cg_misses"), 0);
    }
}

TEST(Contact, MovingPlanePushesTheBody) {
  for (const char* integrator : {"symplectic_euler", "implicit_euler"}) {
    Problem p = cube_over(0.001);
    p.contact.obstacles[0].motion = Point(0, 0, 0.3);
    p.body.damping.mass = 10;
    p.integration.integrator = {integrator};
    p.integration.macro_step = 4e-3;
    p.integration.substeps = {0};
    Simulation<Host> simulation(p);
    advance(simulation, 375);
    for (const Point& v : simulation.velocities()) EXPECT_NEAR(v[2], 0.3, 2e-4) << integrator;
    double lowest = 1e9;
    for (const Point& x : simulation.positions()) lowest = std::min(lowest, x[2]);
    EXPECT_NEAR(lowest, 0.3 * simulation.time() - 0.001, 0.002) << integrator;
  }
}

TEST(Contact, NeedsASurface) {
  Problem p = cube_over(0);
  p.body.surface.reset();
  EXPECT_ANY_THROW(Simulation<Host>{p});
}

// Obstacles on paths, and obstacles of triangles.

Point mean(const std::vector<Point>& field) {
  Point total = Point::Zero();
  for (const Point& x : field) total += x;
  return total / static_cast<double>(field.size());
}

Problem block_with_surface() {
  Problem p = small_cube("neo_hookean", 4);
  p.body.surface = boundary_surface(p.body.levels[0]).surface;
  return p;
}

template <class B>
class MovingObstacles : public testing::Test {};
TYPED_TEST_SUITE(MovingObstacles, EachBackend);

// A plate that comes up under a body at rest takes it along, with every shape, without a false
// alarm of the energy check.
TYPED_TEST(MovingObstacles, OfEveryShapePushTheBody) {
  const TriangleSurface plate =
      boundary_surface(box_mesh({{-0.1, -0.1, -0.08}, {0.2, 0.2, -0.001}}, {1, 1, 1})).surface;
  const std::vector<decltype(ObstacleOptions::shape)> shapes = {
      PlaneOptions{{0, 0, -0.001}, {0, 0, 1}},
      SphereOptions{{0.05, 0.05, -0.301}, 0.3},
      BowlOptions{{0.05, 0.05, 0.186}, 0.2, 0.1},
      CapsuleOptions{{-1, 0.05, -0.201}, {1, 0.05, -0.201}, 0.2},
      BlockOptions{{0.05, 0.05, -0.041}, {0.3, 0.3, 0.08}, {0, 0, 0.4}},
      CylinderOptions{{0.05, 0.05, -0.2}, {0.05, 0.05, -0.001}, 0.2},
      SurfaceOptions{plate, 0}};
  for (const auto& shape : shapes) {
    SCOPED_TRACE(shape.type().name());
    Problem p = block_with_surface();
    p.contact.obstacles.push_back({shape, 0.3, PathMotion{{{0, {0, 0, 0}}, {0.1, {0, 0, 0.05}}}}});
    Simulation<TypeParam> simulation(p);
    while (simulation.time() < 0.1) advance(simulation, 1);
    const double height = mean(simulation.positions())[2];
    EXPECT_GT(height, 0.05 + 0.03);
    double lowest = 1;
    for (const Point& x : simulation.surface_positions()) lowest = std::min(lowest, x[2]);
    // pushed ahead, not run through
    EXPECT_GT(lowest, 0.04);
    // 1.03e-3 in the bowl: the mesh leans one way
    EXPECT_LT(std::abs(mean(simulation.positions())[0] - 0.05), 1.2e-3);
  }
}

// Friction is against the obstacle's own velocity: a belt carries the body along.
TEST(MovingObstacles, DragByFriction) {
  Problem p = block_with_surface();
  p.gravity = {0, 0, -9.81};
  p.contact.obstacles.push_back({PlaneOptions{{0, 0, 0}, {0, 0, 1}}, 0.5, Point(0.1, 0, 0)});
  p.body.damping.mass = 2;
  Simulation<Host> simulation(p);
  while (simulation.time() < 0.4) advance(simulation, 1);
  double speed = 0;
  int steps = 0;
  for (; simulation.time() < 0.8; ++steps)
    advance(simulation, 1), speed += mean(simulation.velocities())[0];
  EXPECT_NEAR(speed / steps, 0.1, 0.01);  // it sticks, and rings
}

// One obstacle's sine under implicit steps: the body's side that it pushes is never farther in than
// a fraction of an edge.
TEST(MovingObstacles, MeetImplicitStepsInTime) {
  Problem p = block_with_surface();
  p.body.fixed = {Box{{0.1, 0, 0}, {0.1, 0.1, 0.1}}};
  p.contact.obstacles.push_back(
      {PlaneOptions{{-0.001, 0, 0}, {1, 0, 0}}, {}, SineMotion{{0.01, 0, 0}, 2, 0}});
  p.integration.integrator = {"implicit_euler"};
  p.integration.macro_step = 0.005;
  Simulation<Host> simulation(p);
  double deepest = 0;
  for (int n = 0; n < 100; ++n) {
    advance(simulation, 1);
    const double wall = -0.001 + 0.01 * std::sin(2 * std::numbers::pi * 2 * simulation.time());
    for (const Point& x : simulation.surface_positions()) deepest = std::max(deepest, wall - x[0]);
  }
  EXPECT_LT(deepest, 0.004);
}

// The same ball, as a formula and as 5120 triangles: a body that falls on it takes the same way.
TYPED_TEST(MovingObstacles, SampledSphereActsLikeTheSphere) {
  const auto falls = [](const ObstacleOptions& ball) {
    Problem p = block_with_surface();
    p.gravity = {0, 0, -9.81};
    p.body.damping.mass = 2;
    p.contact.obstacles = {ball};
    p.integration.macro_step = 5e-4;
    Simulation<TypeParam> simulation(p);
    advance(simulation, 400);
    return simulation.positions();
  };
  const Point centre{0.05, 0.05, -0.21};
  const auto formula = falls({SphereOptions{centre, 0.2}, 0.3, {}});
  const auto sampled = falls({SurfaceOptions{sphere_surface(centre, 0.2, 4), 0}, 0.3, {}});
  EXPECT_LE(largest_difference(formula, sampled),
            2e-3);  // the triangles are 0.3 mm inside the sphere, 0.2 s of bouncing
  EXPECT_LT(mean(formula)[2], 0.05);
  EXPECT_GT(mean(formula)[2], 0.02);
}

TEST(Contact, RefusesNumbersOfNoVertex) {
  Problem p = block_with_surface();
  p.contact.obstacles = {{SphereOptions{{0.05, 0.05, -0.21}, 0.2}, {}, {}}};
  p.body.surface->triangles[3][1] = static_cast<int>(p.body.surface->vertices.size());
  EXPECT_NE(refusal([&] { Simulation<Host> s(p); }).find("body.surface triangle's vertex"),
            std::string::npos);
  p = block_with_surface();
  p.body.levels[0].vertex_sets["base"] = {0, -1};
  p.body.fixed = {GroupSelection{"base"}};
  EXPECT_NE(refusal([&] { Simulation<Host> s(p); }).find("group 'base' has vertex -1 of"),
            std::string::npos);
}

}  // namespace
