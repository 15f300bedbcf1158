// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cstdio>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/generators.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"

// Results that must not change unnoticed: a ball drops into a bowl. No reference but what came out
// once; where a change of method is meant to change them, the new ones are printed on failure.
namespace {

using namespace plica;
using namespace plica::test;

/// The macro step is given: an automatic one follows the critical step, which is an estimate.
Problem ball_in_bowl(const std::string& cycle, std::vector<int> cells, double macro_step) {
  Problem p;
  for (int n : cells) p.body.levels.push_back(ball_mesh({0, 0, 0.1}, 0.05, n));
  p.body.material = {"neo_hookean", 50e3, 0.4, 1000};
  p.body.damping.mass = 5;
  p.body.element = {"linear"};
  p.body.surface = sphere_surface({0, 0, 0.1}, 0.05, 2);
  p.body.initial.velocity = {0.2, 0, -0.7};
  p.gravity = {0, 0, -9.81};
  p.contact.obstacles.push_back({BowlOptions{{0.01, 0, 0.13}, 0.13, 0.08}, 0.3, {}});
  p.integration.cycle = cycle;
  p.integration.macro_step = macro_step;
  return p;
}

/// Centre of the vertices and the energies [J] after 0.09 s, pressed against the bowl.
void expect_values(const Problem& p, const std::array<double, 7>& want) {
  Simulation<Host> simulation(p);
  advance(simulation, static_cast<int>(0.09 / simulation.macro_step()));
  Point centre = Point::Zero();
  const auto x = simulation.positions();
  for (const Point& a : x) centre += a / static_cast<double>(x.size());
  const Energies e = simulation.energies();
  const std::array<double, 7> got = {centre[0], centre[1],   centre[2], e.kinetic,
                                     e.elastic, e.potential, e.contact};
  std::string text;
  for (double value : got) {
    char number[32];
    std::snprintf(number, sizeof number, "%.10g, ", value);
    text += number;
  }
  for (std::size_t i = 0; i < got.size(); ++i)
    EXPECT_NEAR(got[i], want[i], i < 3 ? 1e-6 : 1e-4 * std::abs(want[i]) + 1e-9)
        << i << " of " << text;
}

TEST(StoredValues, SingleLevel) {
  expect_values(ball_in_bowl("single", {8}, 5e-4), {0.01282347956, 0, 0.04581947854, 0.2079614418,
                                                    0.03165232257, -0.27381334, 0.0003237336565});
}

TEST(StoredValues, StatesThroughThreeLevels) {
  expect_values(ball_in_bowl("rs", {8, 6, 4}, 2e-3),
                {0.01258735714, 0, 0.04908146065, 0.1503647433, 0.00157843298, -0.2574311371,
                 9.341501951e-06});
}

TEST(StoredValues, HybridOfTwoLevels) {
  Problem p = ball_in_bowl("rs", {8, 6}, 5e-3);
  p.integration.integrator = {"symplectic_euler", "implicit_euler"};
  p.integration.distribution = "inverse_elements", p.integration.shift_to_coarsest = 0.5;
  p.integration.implicit.relative_residual = 1e-9;
  expect_values(p, {0.01258859379, 0, 0.04546662485, 0.05915123276, 0.01920014924, -0.2756373517,
                    0.0002155537339});
}

TEST(StoredValues, ImplicitSingleLevel) {
  Problem p = ball_in_bowl("single", {8}, 5e-3);
  p.integration.integrator = {"implicit_euler"};
  p.integration.implicit.relative_residual = 1e-9;
  expect_values(p, {0.01263001569, 0, 0.04477473316, 0.04085054134, 0.02767579754, -0.2791182289,
                    0.00027938638});
}

}  // namespace
