// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <plica/core/error.hpp>
#include <plica/drivers/body/masses.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/generators.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/refusal.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// Obstacles with mass, tied to their motion by a spring and a damper.
namespace {

using namespace plica;
using namespace plica::test;

/// A block and a ball above it, which is asked to go down by `way` at once.
Problem block_and_tool(double gap, double way, double stiffness) {
  Problem p = body_of({box_mesh({{0, 0, 0}, {0.08, 0.08, 0.04}}, {6, 6, 3})}, "neo_hookean");
  p.body.fixed = {HalfSpaceSelection{{0, 0, 0}, {0, 0, 1}}};
  p.body.damping.mass = 40;
  p.body.surface = boundary_surface(p.body.levels[0]).surface;
  ObstacleOptions tool{SphereOptions{{0.04, 0.04, 0.04 + 0.03 + gap}, 0.03}, {}, {}};
  if (way > 0) tool.motion = PathMotion{{{0, {0, 0, -way}}}};
  tool.name = "ball", tool.mass = 0.1, tool.coupling.stiffness = stiffness;
  p.contact.obstacles = {tool};
  p.integration.macro_step = 2e-4;
  return p;
}

// Before it touches: x = (1 - (1 + w t) exp(-w t)) x*, w^2 = k / m, the spring's critical motion.
TEST(ToolsWithMass, FollowTheirMotionAsTheSpringLetsThem) {
  Simulation<Host> s(block_and_tool(1, 0.02, 100));
  const double w = std::sqrt(100 / 0.1);
  while (s.time() < 0.1) {
    advance(s, 10);
    const auto tools = s.tools();
    ASSERT_EQ(tools.size(), 1u);
    EXPECT_EQ(tools[0].obstacle, "ball");
    const double t = s.time(), x = -0.02 * (1 - (1 + w * t) * std::exp(-w * t));
    EXPECT_NEAR(tools[0].displacement[2], x, 0.01 * 0.02) << t;
    EXPECT_NEAR(tools[0].velocity[2], -0.02 * w * w * t * std::exp(-w * t), 0.02 * 0.02 * w) << t;
  }
}

// At rest on the body the spring's pull is the contact force.
TEST(ToolsWithMass, RestWhereSpringAndBodyPushAlike) {
  Simulation<Host> s(block_and_tool(0.001, 0.02, 100));
  while (s.time() < 0.6) advance(s, 1);
  const ToolState tool = s.tools()[0];
  const double spring = 100 * (-0.02 - tool.displacement[2]);
  EXPECT_LT(spring, -0.3);
  EXPECT_LT(tool.displacement[2], -0.002);
  EXPECT_NEAR(s.wrenches()[0].force[2], spring, 0.02 * -spring);
}

// A body thrown at a free tool: what one loses the other gets, in every step, to rounding.
TEST(ToolsWithMass, KeepTheMomentum) {
  Problem p = body_of({box_mesh(decimetre, {4, 4, 4})}, "neo_hookean");
  p.body.surface = boundary_surface(p.body.levels[0]).surface;
  p.body.initial.velocity = {0, 0, -1};
  ObstacleOptions tool{SphereOptions{{0.05, 0.05, -0.041}, 0.04}, 0.3, {}};
  tool.mass = 0.5;
  p.contact.obstacles = {tool};
  Simulation<Host> s(p);
  const auto mass = lumped_masses(p.body.levels[0], {p.body.material.density});
  for (int n = 0; n < 200; ++n) {
    advance(s, 1);
    Point sum = 0.5 * s.tools()[0].velocity;
    const auto v = s.velocities();
    for (std::size_t a = 0; a < v.size(); ++a) sum += mass[a] * v[a];
    EXPECT_LE((sum - Point(0, 0, -1)).norm(), round_off<double>(2000, 1.0)) << n;
  }
  EXPECT_LT(s.tools()[0].velocity[2], -0.3);
}

TEST(ToolsWithMass, GoOnFromASavedState) {
  const Problem p = block_and_tool(0.001, 0.02, 100);
  Simulation<Host> s(p), other(p);
  advance(s, 100);
  const SavedState saved = s.save();
  advance(s, 100);
  other.restore(saved);
  advance(other, 100);
  EXPECT_EQ(s.tools()[0].displacement, other.tools()[0].displacement);
  EXPECT_TRUE(same_bits(s.positions(), other.positions()));
}

// Macro steps that are taken again take the tool back.
TEST(ToolsWithMass, GoBackWithTheState) {
  Problem p = block_and_tool(0.001, 0.02, 100);
  p.integration.on_failure.halvings = 3;
  Simulation<Host> s(p), other(p);
  advance(s, 50), advance(other, 50);
  s.step();  // without a check, and so not kept
  s.return_to_last_good();
  EXPECT_EQ(s.tools()[0].displacement, other.tools()[0].displacement);
  advance(s, 50), advance(other, 50);
  EXPECT_EQ(s.tools()[0].displacement, other.tools()[0].displacement);
}

TEST(ToolsWithMass, AreRefusedWhereTheyCannotBe) {
  const auto why = [](const Problem& p) { return refusal([&] { Simulation<Host>{p}; }); };
  Problem p = block_and_tool(0.001, 0.02, 100);
  for (const double mass : {0.0, -0.1}) {
    p.contact.obstacles[0].mass = mass;
    EXPECT_NE(why(p).find("contact.obstacles.0.mass"), std::string::npos) << why(p);
  }
  p.contact.obstacles[0].mass.reset();
  EXPECT_NE(why(p).find("coupling"), std::string::npos) << why(p);
  p.contact.obstacles[0].mass = 0.1, p.contact.obstacles[0].coupling = {};
  p.contact.obstacles[0].motion = SteadyMotion(Point(0, 0, -1));
  EXPECT_NE(why(p).find("nothing that makes it follow"), std::string::npos) << why(p);
  p = block_and_tool(0.001, 0.02, 1e7);  // 0.1 kg / (0.2 ms)^2 = 2.5e6 N/m
  EXPECT_NE(why(p).find("at most 2.5e+06"), std::string::npos) << why(p);
}

}  // namespace
