// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <numbers>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/generators.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// Obstacles on paths, and obstacles of triangles.
namespace {

using namespace plica;
using namespace plica::test;

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

// A plate that comes up under a body at rest takes it along, with every shape, without a false alarm of the energy check.
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
    EXPECT_GT(lowest, 0.04);  // pushed ahead, not run through
    EXPECT_LT(std::abs(mean(simulation.positions())[0] - 0.05), 5e-4);
  }
}

// Friction is against the obstacle's own velocity: a belt carries the body along.
TEST(MovingObstacles, DragByFriction) {
  Problem p = block_with_surface();
  p.gravity = {0, 0, -9.81};
  p.contact.obstacles.push_back({PlaneOptions{{0, 0, 0}, {0, 0, 1}}, 0.5, Point(0.1, 0, 0)});
  p.body.damping.mass = 2;
  Simulation<Host> simulation(p);
  while (simulation.time() < 0.5) advance(simulation, 1);
  EXPECT_GT(mean(simulation.velocities())[0], 0.05);
  EXPECT_LT(mean(simulation.velocities())[0], 0.12);
}

// One obstacle's sine under implicit steps: the body's side that it pushes is never farther in than a fraction of an edge.
TEST(MovingObstacles, MeetImplicitStepsInTime) {
  Problem p = block_with_surface();
  p.body.fixed = {Box{{0.1, 0, 0}, {0.1, 0.1, 0.1}}};
  p.contact.obstacles.push_back({PlaneOptions{{-0.001, 0, 0}, {1, 0, 0}}, {}, SineMotion{{0.01, 0, 0}, 2, 0}});
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

}  // namespace
