// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <cmath>
#include <limits>
#include <plica/core/error.hpp>
#include <plica/drivers/run/simulation.hpp>
#include <stdexcept>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/refusal.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// What a caller may change between two macro steps, and the way back out of one.
namespace {

using namespace plica;
using namespace plica::test;

const Point down(0, 0, -10), aside(5, 0, 1);

// A free body falls without deforming: its velocity is the sum of gravity times step.
TEST(ChangedGravity, MovesAFreeBodyFromThenOn) {
  Problem p = small_cube();
  p.gravity = down;
  Simulation<Host> s(p);
  advance(s, 20);
  s.set_gravity(aside);
  advance(s, 30);
  const Point expected = s.macro_step() * (20 * down + 30 * aside);
  for (const Point& v : s.velocities()) EXPECT_LE((v - expected).norm(), 1e-9 * expected.norm());
  const auto u = displacements(s, small_cube().body.levels[0]);
  EXPECT_NEAR(s.energies().potential, -s.levels()[0].mass * aside.dot(u[0]),
              1e-9 * std::abs(s.energies().potential));
}

TEST(ChangedGravity, IsThatOfAProblemWhichHasIt) {
  for (const char* integrator : {"symplectic_euler", "implicit_euler", "newmark"}) {
    Problem with = small_cube();
    with.body.fixed = {left_face()};
    with.integration.integrator = {integrator};
    with.integration.macro_step = 1e-3;
    Problem without = with;
    with.gravity = down;
    Simulation<Host> a(with), b(without);
    b.set_gravity(down);
    advance(a, 10), advance(b, 10);
    EXPECT_TRUE(same_bits(a.positions(), b.positions())) << integrator;
    EXPECT_EQ(a.energies().potential, b.energies().potential);
  }
}

TEST(ChangedGravity, IsFinite) {
  Simulation<Host> s(small_cube());
  EXPECT_EQ(refusal([&] {
              s.set_gravity({0, 0, std::numeric_limits<double>::infinity()});
            }),
            "gravity: expected finite numbers [m/s^2]");
}

TEST(StepStart, IsWhereAnExceptionInAStepLeadsBack) {
  Problem p = small_cube();
  p.gravity = down;
  p.body.fixed = {left_face()};
  Simulation<Host> s(p);
  advance(s, 7);
  s.keep_step_starts(true);
  advance(s, 26);
  const auto x = s.positions(), v = s.velocities();
  const double time = s.time();
  long last = s.macro_steps();
  s.set_external_forces([&](const ForceRequest<Host>&) {
    if (s.macro_steps() == last) throw std::runtime_error("mine");
  });
  EXPECT_THROW(advance(s, 1), std::runtime_error);
  s.return_to_step_start();
  EXPECT_EQ(s.macro_steps(), 33);
  EXPECT_EQ(s.time(), time);
  EXPECT_TRUE(same_bits(s.positions(), x) && same_bits(s.velocities(), v));
  last = 35;
  EXPECT_THROW(advance(s, 100), std::runtime_error);
  s.return_to_step_start();
  EXPECT_EQ(s.macro_steps(), 35);
  Simulation<Host> other(p);
  advance(other, 35);
  EXPECT_LE(largest_difference(other.positions(), s.positions()), 1e-15);
}

}  // namespace
