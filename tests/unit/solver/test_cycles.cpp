// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/drivers/solver/registry.hpp>
#include <plica/meshes/generators.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// What every cycle must keep, walking the list of cycles.
namespace {

using namespace plica;
using namespace plica::test;

template <class B>
class CyclesOn : public testing::Test {};
TYPED_TEST_SUITE(CyclesOn, EachBackend);

template <class B>
std::vector<Point> state_after(const Problem& p, int steps) {
  Simulation<B> simulation(p);
  advance(simulation, steps);
  auto state = simulation.positions();
  const auto v = simulation.velocities();
  state.insert(state.end(), v.begin(), v.end());
  return state;
}

TYPED_TEST(CyclesOn, OneLevelIsTheSingleLevelSolverBitForBit) {
  for (const std::string& integrator : names(integrators())) {
    Problem p = small_cube("neo_hookean");
    p.gravity = {0, 0, -9.81};
    p.body.fixed = {left_face()};
    p.body.damping.mass = 2;
    p.body.initial.velocity = {0, 0.3, 0};
    p.integration.integrator = {integrator};
    p.integration.macro_step = 4e-4;
    p.integration.allow_unstable = true;
    p.integration.shift_to_coarsest = 0.5;
    p.integration.substeps = {2};
    const auto single = state_after<TypeParam>(p, 20);
    for (const std::string& cycle : sharing_cycles()) {
      p.integration.cycle = cycle;
      EXPECT_TRUE(same_bits(state_after<TypeParam>(p, 20), single)) << integrator << " " << cycle;
    }
  }
}

TYPED_TEST(CyclesOn, SingleIgnoresTheCoarseLevels) {
  Problem p = cube_levels(3, 4, "single");
  p.gravity = {0, 0, -9.81};
  p.integration.macro_step = 4e-4;
  const auto with = state_after<TypeParam>(p, 10);
  p.body.levels.resize(1);
  EXPECT_TRUE(same_bits(state_after<TypeParam>(p, 10), with));
}

// Without forces every level flies on at the same speed: no part of the motion is lost or counted twice. (Few steps: cycles
// that are unstable on their own multiply rounding errors.)
TYPED_TEST(CyclesOn, FreeFlightIsUniformMotion) {
  using Real = typename TypeParam::Real;
  for (const std::string& cycle : sharing_cycles())
    for (const char* distribution : {"equal", "critical", "inverse_elements"}) {
      Problem p = cube_levels(3, 4, cycle);
      p.body.initial.velocity = {1, -2, 0.5};
      p.integration.distribution = distribution;
      Simulation<TypeParam> simulation(p);
      advance(simulation, 12);
      const Point want = simulation.time() * p.body.initial.velocity;
      const auto u = displacements(simulation, p.body.levels[0]), v = simulation.velocities();
      const std::vector<Point> all(u.size(), want), speed(v.size(), p.body.initial.velocity);
      EXPECT_LE(largest_difference(u, all), round_off<Real>(2000, 0.1)) << cycle << " " << distribution;
      EXPECT_LE(largest_difference(v, speed), round_off<Real>(20000)) << cycle << " " << distribution;
    }
}

// Under gravity the levels act one after the other: one vertex that takes their steps in turn.
TYPED_TEST(CyclesOn, FreeFallIsTheExactSequenceOfSteps) {
  using Real = typename TypeParam::Real;
  for (const std::string& cycle : sharing_cycles()) {
    Problem p = cube_levels(2, 4, cycle);
    p.gravity = {0, 0, -9.81};
    p.body.initial.velocity = {0, 0, 1};
    p.integration.distribution = "custom", p.integration.macro_step = 6e-4;
    const bool single = cycle == "single";
    p.integration.shares = single ? std::vector<double>{1.0} : std::vector<double>{0.25, 0.75};
    p.integration.substeps = {1, 3};
    Simulation<TypeParam> simulation(p);
    advance(simulation, 60);
    double u = 0, v = 1;
    const auto take = [&](double h) { v += h * -9.81, u += h * v; };
    for (int n = 0; n < 60; ++n) {
      if (single) {
        take(6e-4);
        continue;
      }
      for (int s = 0; s < 3; ++s) take(0.75 * 6e-4 / 3);
      take(0.25 * 6e-4);
    }
    for (const Point& x : displacements(simulation, p.body.levels[0]))
      EXPECT_LE((x - Point(0, 0, u)).norm(), round_off<Real>(1000, 0.1)) << cycle;
    for (const Point& x : simulation.velocities())
      EXPECT_LE((x - Point(0, 0, v)).norm(), round_off<Real>(5000)) << cycle;
  }
}

// Barycentric rows sum to 1 whatever the meshes: a translation crosses levels that do not overlap fully.
TYPED_TEST(CyclesOn, TranslationIsExactOnLevelsThatOverlapInPart) {
  using Real = typename TypeParam::Real;
  for (const char* outside : {"clamp", "extrapolate"})
    for (const std::string& cycle : names(cycles())) {
      const bool corrected = cycle == "fas";  // hands masses down, which pile up here: what rounding stirs up grows
      if ((corrected || cycle == "him") && outside == std::string("extrapolate")) continue;
      Problem p = body_of({jittered_box(decimetre, {4, 4, 4}), ball_mesh({0.05, 0.05, 0.05}, 0.05, 4)});
      p.integration.cycle = cycle, p.integration.outside = outside;
      p.body.initial.velocity = {0, 0, -3};
      Simulation<TypeParam> simulation(p);
      advance(simulation, corrected ? 5 : 50);
      for (const Point& u : displacements(simulation, p.body.levels[0]))
        EXPECT_LE((u - Point(0, 0, -3 * simulation.time())).norm(), round_off<Real>(1000, 0.3)) << cycle << outside;
    }
}

// What is done with outside vertices is of no account where there are none.
TYPED_TEST(CyclesOn, OutsideRulesAgreeOnLevelsThatOverlapFully) {
  const auto after = [](const char* outside) {
    Problem p = cube_levels(2, 4, "rsv");
    p.body.initial.angular_velocity = {0, 0, 2};
    p.integration.outside = outside;
    return state_after<TypeParam>(p, 10);
  };
  const auto clamped = after("clamp");
  for (const char* outside : {"extrapolate", "keep"})
    EXPECT_LE(largest_difference(after(outside), clamped), round_off<typename TypeParam::Real>(1e4)) << outside;
}

// The restriction of a variation telescopes: with nothing fixed, `rv` is `rsv` that never switches.
TYPED_TEST(CyclesOn, SwitchingNeverIsVariationAndAlwaysIsState) {
  const auto after = [](const std::string& cycle, double threshold) {
    Problem p = cube_levels(2, 4, cycle);
    p.body.initial.angular_velocity = {0, 0, 2};
    p.integration.switch_threshold = threshold;
    return state_after<TypeParam>(p, 20);
  };
  EXPECT_TRUE(same_bits(after("rsv", 1e6), after("rv", 1)));
  EXPECT_LE(largest_difference(after("rsv", 1e-30), after("rs", 1)), round_off<typename TypeParam::Real>(1e4));
}

TYPED_TEST(CyclesOn, EveryOneHoldsALoadedBeam) {
  for (const std::string& cycle : names(cycles())) {
    Problem p = body_of({box_mesh(beam_box, {12, 4, 4}), box_mesh(beam_box, {8, 3, 3})}, "corotational");
    p.gravity = {0, 0, -9.81};
    p.body.damping.mass = 20;
    p.body.fixed = {left_face()};
    p.integration.cycle = cycle;
    Simulation<TypeParam> simulation(p);
    advance(simulation, 100);
    for (int level = 0; level < (integrates_coarse_levels(cycle) ? 2 : 1); ++level) {
      const TetMesh& mesh = p.body.levels[static_cast<std::size_t>(level)];
      const auto u = displacements(simulation, mesh, level);
      for (std::size_t a = 0; a < u.size(); ++a)
        if (mesh.vertices[a][0] == 0) {
          EXPECT_EQ(u[a].norm(), 0) << cycle;
        }
      EXPECT_GT(largest(u), 0.1) << cycle;
    }
    if (cycle == "rv" || cycle == "rsv_sv") {  // what they hand up grows on a loaded body: by and by, and not unnoticed
      std::optional<Diagnosis> bad;
      for (int n = 0; n < 1500 && !bad; ++n) simulation.step(), bad = simulation.check();
      ASSERT_TRUE(bad) << cycle;
      EXPECT_TRUE(bad->kind == "energy" || bad->kind == "speed") << cycle << " " << bad->text();
    }
  }
}

}  // namespace
