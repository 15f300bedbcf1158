// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <plica/drivers/body/masses.hpp>
#include <plica/drivers/contact/turning.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/generators.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/refusal.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// Obstacles with mass and inertia: torques turn them, and a coupling pulls them to the attitude of
// their turn.
namespace {

using namespace plica;
using namespace plica::test;

/// A block, and a rod far above it.
Problem block_and_rod() {
  Problem p = body_of({box_mesh({{0, 0, 0}, {0.08, 0.08, 0.04}}, {6, 6, 3})}, "neo_hookean");
  p.body.surface = boundary_surface(p.body.levels[0]).surface;
  ObstacleOptions rod{CapsuleOptions{{-0.06, 0.04, 1}, {0.06, 0.04, 1}, 0.01}, {}, {}};
  rod.name = "rod", rod.mass = 0.1, rod.inertia = {2e-5, 1.5e-4, 1.6e-4};
  p.contact.obstacles = {rod};
  p.integration.macro_step = 2e-4;
  return p;
}

Eigen::Matrix3d matrix(const Mat3<double>& R) {
  Eigen::Matrix3d M;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) M(i, j) = R[i][j];
  return M;
}

/// I w, with I turned as the tool is.
Point spin_of(const ObstacleOptions& o, const ToolState& tool) {
  const Eigen::Matrix3d R = matrix(rotation_by(tool.rotation));
  return R * inertia_matrix(o) * R.transpose() * tool.angular_velocity;
}

/// `way` rad about z at once, by the spring's critical motion: (1 - (1 + w t) exp(-w t)) of it.
TEST(ToolsThatTurn, FollowTheirTurnAsTheSpringLetsThem) {
  Problem p = block_and_rod();
  ObstacleOptions& rod = p.contact.obstacles[0];
  rod.turn = Turn{Point::UnitZ(), {}, Point::Zero(), PathTurn{{{0, 0.5}}}};
  rod.coupling.angular_stiffness = 0.16;
  Simulation<Host> s(p);
  const double w = std::sqrt(0.16 / 1.6e-4);
  while (s.time() < 0.1) {
    advance(s, 10);
    const ToolState tool = s.tools()[0];
    const double t = s.time(), angle = 0.5 * (1 - (1 + w * t) * std::exp(-w * t));
    EXPECT_NEAR(tool.rotation[2], angle, 0.01 * 0.5) << t;
    EXPECT_NEAR(tool.angular_velocity[2], 0.5 * w * w * t * std::exp(-w * t), 0.02 * 0.5 * w) << t;
    EXPECT_LT(tool.displacement.norm(), 1e-15);
  }
}

/// Its motion goes round a point that is not its centre of mass.
TEST(ToolsThatTurn, GoRoundThePointOfTheirTurn) {
  Problem p = block_and_rod();
  ObstacleOptions& rod = p.contact.obstacles[0];
  rod.turn =
      Turn{Point::UnitZ(), Point(-0.06, 0.04, 1), Point::Zero(), PathTurn{{{0, 0}, {0.2, 0.8}}}};
  rod.coupling = {1000, {}, 1.0, {}};
  Simulation<Host> s(p);
  while (s.time() < 0.4) advance(s, 10);
  const ToolState tool = s.tools()[0];
  EXPECT_NEAR(tool.rotation[2], 0.8, 1e-3);
  EXPECT_NEAR(tool.displacement[0], 0.06 * (std::cos(0.8) - 1), 1e-4);
  EXPECT_NEAR(tool.displacement[1], 0.06 * std::sin(0.8), 1e-4);
}

/// A free one, pushed at its end as a soft body comes by: what the body loses of linear and angular
/// momentum it gets.
Problem pushed_at_its_end(const std::string& integrator) {
  Problem p = block_and_rod();
  p.body.initial.velocity = {0, 0.2, 0.5};
  p.contact.obstacles[0].shape = CapsuleOptions{{0.03, 0.035, 0.052}, {0.2, 0.045, 0.052}, 0.01};
  p.contact.obstacles[0].friction = 0.4;
  p.contact.obstacles[0].inertia = {2e-5, 3e-4, 3.1e-4, -2e-6, 1e-6, 0};
  p.integration.integrator = {integrator};
  return p;
}

TEST(ToolsThatTurn, KeepLinearAndAngularMomentum) {
  // implicit steps keep them as far as they are solved
  for (const auto& [integrator, solved] :
       {std::pair{"symplectic_euler", 1e-9}, {"implicit_euler", 2e-3}}) {
    SCOPED_TRACE(integrator);
    const Problem p = pushed_at_its_end(integrator);
    const ObstacleOptions& rod = p.contact.obstacles[0];
    Simulation<Host> s(p);
    const auto mass = lumped_masses(p.body.levels[0], {p.body.material.density});
    const Point origin(0.115, 0.04, 0.052);
    const auto momenta = [&] {
      const ToolState tool = s.tools()[0];
      Point linear = *rod.mass * tool.velocity,
            angular = Point(origin + tool.displacement).cross(linear) + spin_of(rod, tool);
      const auto x = s.positions(), v = s.velocities();
      for (std::size_t a = 0; a < v.size(); ++a)
        linear += mass[a] * v[a], angular += mass[a] * x[a].cross(v[a]);
      return std::pair{linear, angular};
    };
    const auto start = momenta();
    double gained = 0;
    for (int n = 0; n < 250; ++n) {
      advance(s, 1);
      const auto now = momenta();
      EXPECT_LT((now.first - start.first).norm(), solved * start.first.norm()) << n;
      EXPECT_LT((now.second - start.second).norm(), 2e-3 * start.second.norm()) << n;
      gained = std::max(gained, spin_of(rod, s.tools()[0]).norm());
    }
    EXPECT_GT(s.tools()[0].angular_velocity.norm(), 1);
    EXPECT_GT(gained, 0.02 * start.second.norm());
  }
}

/// Free of torque afterwards: angular momentum stays to rounding, and energy nearly.
TEST(ToolsThatTurn, SpinFreely) {
  const Problem p = pushed_at_its_end("symplectic_euler");
  const ObstacleOptions& rod = p.contact.obstacles[0];
  Simulation<Host> s(p);
  while (s.time() < 0.1) advance(s, 1);
  const ToolState before = s.tools()[0];
  const Point L = spin_of(rod, before);
  ASSERT_GT(L.norm(), 0);
  const double energy = L.dot(before.angular_velocity) / 2;
  while (s.time() < 0.5) advance(s, 1);
  const ToolState after = s.tools()[0];
  ASSERT_TRUE(s.wrenches()[0].force.isZero());
  EXPECT_LT((spin_of(rod, after) - L).norm(), 1e-10 * L.norm());
  EXPECT_NEAR(spin_of(rod, after).dot(after.angular_velocity) / 2, energy, 0.01 * energy);
  EXPECT_GT((rotation_vector(rotation_by(after.rotation) * rotation_by(-before.rotation))).norm(),
            0.1);
}

TEST(ToolsThatTurn, GoOnFromASavedState) {
  const Problem p = pushed_at_its_end("symplectic_euler");
  Simulation<Host> s(p), other(p);
  advance(s, 100);
  const SavedState saved = s.save();
  advance(s, 100);
  other.restore(saved);
  advance(other, 100);
  EXPECT_EQ(s.tools()[0].rotation, other.tools()[0].rotation);
  EXPECT_GT(s.tools()[0].rotation.norm(), 0);
  EXPECT_TRUE(same_bits(s.positions(), other.positions()));
}

TEST(ToolsThatTurn, AreRefusedWhereTheyCannotBe) {
  const auto why = [](const auto& change) {
    Problem p = block_and_rod();
    change(p.contact.obstacles[0]);
    return refusal([&] { Simulation<Host>{p}; });
  };
  const auto expect = [](const std::string& text, const char* part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  expect(why([](auto& o) { o.mass.reset(); }), "expected contact.obstacles.0.mass, too");
  expect(why([](auto& o) { o.inertia = {1e-4, 1e-4}; }), "has 2 numbers");
  expect(why([](auto& o) { o.inertia = {1e-4, 1e-4, 3e-4}; }), "none larger than the sum");
  expect(why([](auto& o) { o.inertia = {1e-4, 1e-4, -1e-4}; }), "positive");
  expect(why([](auto& o) { o.inertia = {}, o.turn = Turn{}; }), "contact.obstacles.0.inertia");
  expect(why([](auto& o) { o.inertia = {}, o.coupling.angular_stiffness = 1; }),
         "contact.obstacles.0.inertia");
  expect(why([](auto& o) { o.coupling.angular_stiffness = 1e6; }), "least moment of inertia");
}

}  // namespace
