// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/drivers/study/level_probe.hpp>
#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// What the integrators say of themselves: energy, stiff motion, given motion, cycles.
namespace {

using namespace plica;
using namespace plica::test;

Problem ringing(const std::string& integrator, double steps_of_limit) {
  Problem p = small_cube("linear");
  const double limit = Simulation<Host>(p).levels()[0].critical_step;
  p.integration.integrator = {integrator}, p.integration.macro_step = steps_of_limit * limit;
  p.integration.implicit.relative_residual = 1e-11;
  return p;
}

/// Energy after steps of a clamped body that starts deformed at random, over that at the start.
double energy_left(Problem p, int steps) {
  p.body.fixed = {left_face()};
  Simulation<Host> simulation(p);
  auto u = random_field(p.body.levels[0].vertices.size(), 1e-5, 4);
  for (std::size_t a = 0; a < u.size(); ++a)
    if (p.body.levels[0].vertices[a][0] < 1e-9) u[a].setZero();
  simulation.set_state(u, std::vector<Point>(u.size(), Point::Zero()));
  const double before = simulation.energies().total();
  for (int n = 0; n < steps; ++n) simulation.step();
  return simulation.energies().total() / before;
}

TEST(Integrators, KeepTheEnergyTheySayTheyKeep) {
  EXPECT_NEAR(energy_left(ringing("central_difference", 0.3), 2000), 1, 0.05);  // wavers
  for (const double step : {0.3, 30.0}) EXPECT_NEAR(energy_left(ringing("newmark", step), 200), 1, 1e-8) << step;
  Problem p = ringing("generalized_alpha", 30);
  p.integration.implicit.rho_infinity = 1;
  EXPECT_NEAR(energy_left(p, 200), 1, 1e-9);
}

TEST(Integrators, DampWhatIsTooFastForTheStep) {
  for (const char* integrator : {"implicit_euler", "bdf2"})
    EXPECT_LT(energy_left(ringing(integrator, 1e4), 4), 1e-8) << integrator;
  for (const double rho : {0.2, 0.5, 0.9}) {
    Problem p = ringing("generalized_alpha", 1e4);
    p.integration.implicit.rho_infinity = rho;
    const double a = energy_left(p, 10), b = energy_left(p, 20);  // n rho^n in amplitude: a double root
    EXPECT_NEAR(std::log(b / a) / 10, 2 * std::log(rho), 0.2) << rho;
  }
}

TEST(Integrators, FollowGivenMotionExactly) {
  for (const std::string& integrator : names(integrators())) {
    Problem p = small_cube("linear", 2);
    p.body.prescribed = {{left_face(), SineMotion{Point(0.01, 0, 0), 5, 0}}};
    p.integration.integrator = {integrator}, p.integration.macro_step = 1e-3, p.integration.allow_unstable = true;
    Simulation<Host> simulation(p);
    for (int n = 0; n < 20; ++n) simulation.step();
    const double want = 0.01 * std::sin(2 * M_PI * 5 * simulation.time());
    const auto u = displacements(simulation, p.body.levels[0]);
    for (std::size_t a = 0; a < u.size(); ++a)
      if (p.body.levels[0].vertices[a][0] < 1e-9) {
        EXPECT_NEAR(u[a][0], want, 1e-12) << integrator;
      }
  }
}

// A body at rest under given motion and gravity must not care which integrator carries it: falling is exact for order 2.
TEST(Integrators, FallFreely) {
  for (const std::string& integrator : names(integrators())) {
    Problem p = small_cube("corotational", 2);
    p.gravity = {0, 0, -10};
    p.integration.integrator = {integrator}, p.integration.macro_step = 1e-3, p.integration.allow_unstable = true;
    p.integration.implicit.relative_residual = 1e-12;
    Simulation<Host> simulation(p);
    for (int n = 0; n < 50; ++n) simulation.step();
    for (const Point& v : simulation.velocities()) EXPECT_NEAR(v[2], -0.5, 1e-8) << integrator;
    const bool first = integrator.find("euler") != std::string::npos;  // off by h v / 2
    for (const Point& u : displacements(simulation, p.body.levels[0]))
      EXPECT_NEAR(u[2], -0.0125, first ? 2.6e-4 : 1e-8) << integrator;
  }
}

// Every integrator on every level of every cycle that shares the step: a fall, from which the clamped side holds back and a step
// of first order is off by a tenth.
TEST(Integrators, WorkInCycles) {
  for (const std::string& cycle : sharing_cycles())
    for (const std::string& integrator : names(integrators())) {
      Problem p = cube_levels(2, 4, cycle);
      p.gravity = {0, 0, -9.81}, p.body.fixed = {left_face()}, p.body.damping.mass = 20;
      p.integration.integrator = {integrator};
      p.integration.macro_step = 5e-4, p.integration.allow_unstable = true;
      Simulation<Host> simulation(p);
      for (int n = 0; n < 40; ++n) simulation.step();
      EXPECT_FALSE(simulation.check()) << cycle << " " << integrator;
      EXPECT_NEAR(largest(displacements(simulation, p.body.levels[0])), 0.5 * 9.81 * 0.02 * 0.02, 4e-4)
          << cycle << " " << integrator;
    }
}

// What is carried from step to step is saved: the same bits after a restore.
TEST(Integrators, AreRestoredBitForBit) {
  for (const std::string& integrator : names(integrators())) {
    Problem p = small_cube("neo_hookean", 2);
    p.gravity = {0, 0, -9.81}, p.body.fixed = {left_face()};
    p.integration.integrator = {integrator}, p.integration.macro_step = 2e-4, p.integration.allow_unstable = true;
    Simulation<Host> one(p), two(p);
    for (int n = 0; n < 5; ++n) one.step();
    two.restore(one.save());
    for (int n = 0; n < 5; ++n) one.step(), two.step();
    EXPECT_EQ(one.positions(), two.positions()) << integrator;
    EXPECT_EQ(one.velocities(), two.velocities()) << integrator;
  }
}

}  // namespace
