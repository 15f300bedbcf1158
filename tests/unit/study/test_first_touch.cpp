// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <plica/drivers/run/simulation.hpp>
#include <plica/drivers/study/first_touch.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/boundary_triangles.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"

// When a body first touches something, without a step.
namespace {

using namespace plica;
using namespace plica::test;

constexpr double g = 9.81;

/// A cube of a decimetre, its lower face this high above a plane.
Problem above_a_plane(double height) {
  Problem p = body_of({box_mesh(decimetre, {2, 2, 2})});
  p.body.surface = boundary_surface(p.body.levels.front()).surface;
  p.gravity = {0, 0, -g};
  ObstacleOptions floor;
  floor.name = "floor", floor.shape = PlaneOptions{{0, 0, -height}, {0, 0, 1}};
  p.contact.obstacles = {floor};
  return p;
}

TEST(FirstTouch, OfABodyThatFallsIsExact) {
  const FirstTouch touch = first_touch(above_a_plane(0.2), 10);
  EXPECT_TRUE(touch.exact);
  EXPECT_EQ(touch.what, "floor");
  EXPECT_NEAR(touch.time, std::sqrt(2 * 0.2 / g), 1e-4);
  EXPECT_FALSE(first_touch(above_a_plane(0.2), 0.19).expected()) << "the run ends before";
}

TEST(FirstTouch, KnowsWhereADampedBodyIs) {
  Problem p = above_a_plane(0.2);
  p.body.damping.mass = 8, p.body.initial.velocity = {0.3, 0, 0.5};
  const FirstTouch touch = first_touch(p, 10);
  ASSERT_TRUE(touch.exact);
  p.integration.integrator = {"central_difference"}, p.integration.macro_step = 1e-3;
  Simulation<Host> simulation(p);
  const RigidMotion motion = rigid_motion(p).value();
  while (simulation.time() < touch.time) simulation.step();
  for (const Point& u : displacements(simulation, p.body.levels.front()))
    EXPECT_LT((u - motion.displacement_at(simulation.time())).norm(), 1e-3);
  EXPECT_NEAR(motion.displacement_at(touch.time).z(), -0.2, 1e-4);
}

TEST(FirstTouch, OfAToolThatComesToABodyAtRest) {
  Problem p = above_a_plane(1);
  p.gravity = Point::Zero();
  p.body.fixed = {left_face()};
  ObstacleOptions ball;
  ball.shape = SphereOptions{{0.05, 0.05, 0.3}, 0.02};
  ball.motion = PathMotion{{{0, Point::Zero()}, {1, Point::Zero()}, {2, {0, 0, -0.3}}}};
  p.contact.obstacles.push_back(ball);
  const FirstTouch touch = first_touch(p, 10);
  EXPECT_TRUE(touch.exact);
  EXPECT_EQ(touch.what, obstacle_name(p.contact, 1));
  EXPECT_NEAR(touch.time, 1 + 0.18 / 0.3, 1e-3);
}

TEST(FirstTouch, IsABoundWhereTheBodyDeforms) {
  Problem p = above_a_plane(0.2);
  p.body.fixed = {left_face()};
  EXPECT_FALSE(rigid_motion(p));
  const FirstTouch touch = first_touch(p, 10);
  EXPECT_FALSE(touch.exact);
  EXPECT_NEAR(touch.time, std::sqrt(2 * 0.2 / g), 1e-3) << "nothing of it falls faster than freely";
  EXPECT_EQ(first_touch(p, 0.1).what, "");
}

TEST(FirstTouch, MayBeAtOnce) {
  Problem self = above_a_plane(0.2);
  self.contact.self = true;
  EXPECT_EQ(first_touch(self, 10).time, 0);
  EXPECT_FALSE(first_touch(self, 10).exact);
  Problem driven = above_a_plane(0.2);
  driven.body.prescribed = {{left_face(), SteadyMotion(Point(0, 0, -1))}};
  EXPECT_EQ(first_touch(driven, 10).time, 0);
  Problem alone = above_a_plane(0.2);
  remove_contact(alone);
  EXPECT_FALSE(first_touch(alone, 10).expected());
}

}  // namespace
