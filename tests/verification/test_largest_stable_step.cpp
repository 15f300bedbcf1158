// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/drivers/study/stability.hpp>
#include <plica/meshes/sphere_surface.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// The predicted critical step against runs: just below they stay bounded, just above they grow without bound.
namespace {

using namespace plica;
using namespace plica::test;

void expect_limit(const Problem& p, const std::string& integrator) {
  StudyOptions asked;
  asked.methods = {"single/" + integrator};
  const StabilityRow row = stability(p, asked).rows.at(0);
  ASSERT_EQ(row.status, "limited") << row.reason;
  EXPECT_NEAR(*row.ratio, 1, 0.02) << integrator;
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
