// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/meshes/sphere_surface.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// The predicted critical step against runs: just below they stay bounded, just above they grow without bound.
namespace {

using namespace plica;
using namespace plica::test;

/// Whether small random motion stays small. The material is linear, so that size is of no account.
bool stays_bounded(Problem p, double step) {
  p.integration.macro_step = step;
  p.integration.substeps = {1};
  p.integration.allow_unstable = true;
  Simulation<Host> simulation(p);
  const std::size_t n = p.body.levels[0].vertices.size();
  auto v = random_field(n, 1e-3, 12);
  simulation.set_state(std::vector<Point>(n, Point::Zero()), v);
  for (int i = 0; i < 2000; ++i) simulation.step();
  return largest(simulation.velocities()) < 1e-1;  // bounded motion wavers by less than (1 - (h w / 2)^2)^-1/2
}

void expect_limit(const Problem& p, const std::string& integrator) {
  Problem q = p;
  q.integration.integrator = {integrator};
  const double predicted = [&] {
    q.integration.macro_step = 1e-7;
    return Simulation<Host>(q).levels()[0].critical_step;
  }();
  double low = 0.9 * predicted, high = 1.1 * predicted;
  ASSERT_TRUE(stays_bounded(q, low)) << integrator;
  ASSERT_FALSE(stays_bounded(q, high)) << integrator;
  while (high - low > 0.004 * predicted) {
    const double middle = 0.5 * (low + high);
    (stays_bounded(q, middle) ? low : high) = middle;
  }
  EXPECT_NEAR(low, predicted, 0.02 * predicted) << integrator;
}

TEST(LargestStableStep, OfAFreeCube) { expect_limit(small_cube("linear"), "symplectic_euler"); }

TEST(LargestStableStep, OfRungeKutta) { expect_limit(small_cube("linear"), "rk4"); }

TEST(LargestStableStep, OfAStiffInclusion) {
  Problem p = small_cube("linear", 4);
  p.body.levels[0] = with_regions(p.body.levels[0], 0.05, "stiff", "soft");
  p.body.regions["stiff"].young_modulus = 2e6;
  expect_limit(p, "symplectic_euler");
}

// Deep in a plane that resists only along its normal every point is active: the prediction, which takes contact to act
// in all directions, is on the sure side, and not by much more than the friction-free directions account for.
TEST(LargestStableStep, InContactIsPredictedOnTheSureSide) {
  Problem p = small_cube("linear");
  p.body.surface = sphere_surface({0.05, 0.05, 0.05}, 0.049, 2);
  p.contact.obstacles.push_back({PlaneOptions{{0, 0, 0.5}, {0, 0, 1}}, {}, {}});
  p.contact.stiffness_scale = 5;
  p.body.fixed = {left_face()};
  p.integration.macro_step = 1e-7;
  const double predicted = Simulation<Host>(p).levels()[0].critical_step;
  const auto bounded = [&](double step) {
    Problem q = p;
    q.integration.macro_step = step, q.integration.substeps = {1}, q.integration.allow_unstable = true;
    Simulation<Host> simulation(q);
    for (int i = 0; i < 800; ++i) simulation.step();
    return largest(simulation.velocities()) < 1e3;
  };
  EXPECT_TRUE(bounded(0.999 * predicted));
  EXPECT_FALSE(bounded(1.6 * predicted));
}

}  // namespace
