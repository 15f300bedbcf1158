// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/core/error.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// The corrected cycle: what its adjoint transfers conserve, and whose equilibrium it keeps.
namespace {

using namespace plica;
using namespace plica::test;

template <class B>
class CorrectedCycle : public testing::Test {};
TYPED_TEST_SUITE(CorrectedCycle, EachBackend);

double mass_of(const Problem& p) {
  double volume = 0;
  for (const auto& t : p.body.levels[0].tets) {
    const auto x = [&](std::size_t k) { return p.body.levels[0].vertices[static_cast<std::size_t>(t[k])]; };
    volume += tet_volume(x(0), x(1), x(2), x(3));
  }
  return volume * p.body.material.density;
}

Problem hanging(const std::string& cycle) {
  Problem p = body_of({jittered_box(beam_box, {12, 3, 3}), jittered_box(beam_box, {7, 2, 2})}, "corotational");
  p.body.material.young_modulus = 200e3;
  p.body.fixed = {left_face()};
  p.gravity = {0, 0, -9.81};
  p.integration.cycle = cycle;
  return p;
}

TYPED_TEST(CorrectedCycle, InheritsTheWholeMass) {
  Problem p = cube_levels(3, 6, "fas");
  const Simulation<TypeParam> simulation(p);
  for (const LevelReport& level : simulation.levels()) {
    EXPECT_NEAR(level.mass, mass_of(p), round_off<double>(100, mass_of(p)));
    EXPECT_EQ(level.massless, 0);
  }
}

// the second level is the finer one: most of its vertices find none of the first in their elements
TYPED_TEST(CorrectedCycle, GivesMassToVerticesThatInheritNone) {
  Problem p = body_of({jittered_box(decimetre, {2, 2, 2}), jittered_box(decimetre, {6, 6, 6})});
  p.integration.cycle = "fas";
  p.body.initial.velocity = {1, 2, 3};
  Simulation<TypeParam> simulation(p);
  EXPECT_GT(simulation.levels()[1].massless, 100);
  EXPECT_NEAR(simulation.levels()[1].mass, mass_of(p), round_off<double>(1000, mass_of(p)));
  advance(simulation, 20);
  for (const Point& v : simulation.velocities())
    EXPECT_LE((v - Point(1, 2, 3)).norm(), round_off<typename TypeParam::Real>(1e4, 4));
}

TYPED_TEST(CorrectedCycle, KeepsLinearMomentum) {
  Problem p = cube_levels(3, 6, "fas");
  Simulation<TypeParam> simulation(p);
  const auto n = p.body.levels[0].vertices.size();
  const auto kick = random_field(n, 0.1, 3);
  simulation.set_state(std::vector<Point>(n, Point::Zero()), kick);
  const auto momentum = [&](const std::vector<Point>& v) {
    Point sum = Point::Zero();
    for (const auto& t : p.body.levels[0].tets) {
      const auto x = [&](std::size_t k) { return p.body.levels[0].vertices[static_cast<std::size_t>(t[k])]; };
      for (int a : t) sum += 250 * tet_volume(x(0), x(1), x(2), x(3)) * v[static_cast<std::size_t>(a)];
    }
    return sum;
  };
  const Point before = momentum(kick);
  for (int step = 0; step < 30; ++step) simulation.step();
  EXPECT_GT(largest(displacements(simulation, p.body.levels[0])), 1e-3);
  EXPECT_LE((momentum(simulation.velocities()) - before).norm(),
            round_off<typename TypeParam::Real>(300, mass_of(p) * 0.1));
}

TYPED_TEST(CorrectedCycle, KeepsTheFinestMeshsEquilibrium) {
  const Problem still = [] {
    Problem p = hanging("single");
    p.body.damping.mass = 12;
    return p;
  }();
  Simulation<TypeParam> settling(still);
  while (settling.time() < 4) settling.step();
  ASSERT_LE(largest(settling.velocities()), 3e-4);
  const auto u = displacements(settling, still.body.levels[0]);
  const double sag = largest(u);
  const auto moved_by = [&](const char* cycle) {
    const Problem p = hanging(cycle);
    Simulation<TypeParam> simulation(p);
    simulation.set_state(u, std::vector<Point>(u.size(), Point::Zero()));
    for (int step = 0; step < 20; ++step) simulation.step();
    return largest_difference(displacements(simulation, p.body.levels[0]), u) / sag;
  };
  EXPECT_LE(moved_by("fas"), 1e-5);
  EXPECT_GT(moved_by("rs"), 1e-2);  // the control: the coarse level pulls towards its own
}

TYPED_TEST(CorrectedCycle, NeedsWeightsThatHandMassDown) {
  Problem p = cube_levels(2, 4, "fas");
  p.integration.outside = "extrapolate";
  EXPECT_THROW(Simulation<TypeParam>{p}, InputError);
}

}  // namespace
