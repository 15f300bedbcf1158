// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <plica/drivers/study/level_probe.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"

// The limits of a run's checks, and which element they name.
namespace {

using namespace plica;
using namespace plica::test;

template <class B>
class Checks : public testing::Test {};
TYPED_TEST_SUITE(Checks, EachBackend);

// Twice the energy that was put in is allowed.
TYPED_TEST(Checks, KineticEnergyMayBeTwiceWhatWasPutIn) {
  using Real = typename TypeParam::Real;
  for (const double part : {1.8, 2.2}) {
    Problem p = small_cube();
    p.body.initial.velocity = {0, 0, 2};
    p.integration.macro_step = 5e-4;
    Simulation<TypeParam> simulation(p);
    const auto v = simulation.velocity();
    for (std::size_t a = 0; a < v.extent(0); ++a)
      for (int k = 0; k < 3; ++k) v(a, k) *= static_cast<Real>(std::sqrt(part));
    simulation.step();
    const auto bad = simulation.check();
    EXPECT_EQ(bad.has_value(), part > 2) << part;
    if (bad) {
      EXPECT_EQ(bad->kind, "energy");
    }
  }
}

// An edge in a sub-step is allowed, where energies cannot tell.
TYPED_TEST(Checks, AVertexMayMoveByAnEdgeInASubStep) {
  using Real = typename TypeParam::Real;
  Problem p = small_cube();
  p.body.prescribed = {{left_face(), SteadyMotion(Point(1e-6, 0, 0))}};
  p.integration.macro_step = 1e-5, p.integration.substeps = {1};
  const auto checked = [&](double speed) {
    Simulation<TypeParam> simulation(p);
    const auto last = simulation.velocity().extent(0) - 1;
    simulation.velocity()(last, 2) = static_cast<Real>(speed);
    simulation.step();
    return simulation.check();
  };
  const double fast = 1e7;  // some thousand edges in a step
  const auto bad = checked(fast);
  ASSERT_TRUE(bad);
  EXPECT_EQ(bad->kind, "speed");
  const double an_edge = fast / bad->motion_over_edge;
  EXPECT_GT(an_edge * 1e-5, 0.01) << "about a third of the cube in a step";
  EXPECT_LT(an_edge * 1e-5, 0.07);
  EXPECT_FALSE(checked(0.95 * an_edge));
  const auto faster = checked(1.05 * an_edge);
  ASSERT_TRUE(faster);
  EXPECT_EQ(faster->kind, "speed");
  EXPECT_NEAR(faster->motion_over_edge, 1.05, 1e-3);
}

// Of the elements that force kernels have flagged, that of the first evaluation is named, and of
// several in it that of the least J.
TEST(FindInverted, NamesTheEarliestAndMostInverted) {
  LevelProbe<Host> probe(small_cube("neo_hookean", 8));
  const Level<Host>& level = probe.at(0);
  const auto& element = level.model.patches.element;
  ASSERT_GE(level.flags.evaluation.extent(0), 3u);
  std::vector<int> slots;
  for (int slot = 0; slots.size() < 3; slot += 5)
    if (element(slot) >= 0) slots.push_back(slot);
  struct Flag {
    int evaluation;
    double J;
  };
  const auto found = [&](const std::vector<Flag>& of_patches) {
    level.flags.clear(level.exec());
    level.exec().fence();
    for (std::size_t i = 0; i < of_patches.size(); ++i)
      if (of_patches[i].evaluation > 0)
        level.flags.raise(static_cast<int>(i), of_patches[i].evaluation, slots[i], of_patches[i].J);
    return find_inverted<Host>(probe.built);
  };
  const auto expect_named = [&](const std::vector<Flag>& of_patches, std::size_t named) {
    const auto bad = found(of_patches);
    ASSERT_TRUE(bad);
    EXPECT_EQ(bad->kind, "inverted");
    EXPECT_EQ(bad->level, 0);
    EXPECT_EQ(bad->element, element(slots[named])) << named;
    EXPECT_FLOAT_EQ(static_cast<float>(bad->J), static_cast<float>(of_patches[named].J));
  };
  EXPECT_FALSE(found({}));
  expect_named({{4, -0.25}, {4, -0.5}, {4, -0.375}}, 1);
  expect_named({{4, -0.5}, {4, -0.25}, {4, -0.375}}, 0);
  expect_named({{4, -0.5}, {3, -0.25}, {4, -0.75}}, 1);
  expect_named({{3, -0.25}, {4, -0.5}, {5, -0.75}}, 0);
  expect_named({{0, 0}, {9, -0.5}, {7, -0.125}}, 2);
  const auto bad = found({{2, std::numeric_limits<double>::quiet_NaN()}});
  ASSERT_TRUE(bad);
  EXPECT_EQ(bad->kind, "non_finite");
}

// Where the state is not finite, and elements must not be inverted, the last state that is kept
// tells whether one was: a J of 0 counts.
TEST(LocateFailure, CallsAStateInvertedWhereItsElementsWere) {
  LevelProbe<Host> probe(small_cube("neo_hookean"));
  Level<Host>& level = probe.at(0);
  ASSERT_GT(level.flags.evaluation.extent(0), 0u);
  const auto kept_at = [&](double height) {
    std::vector<Point> u;
    for (const Point& x : probe.problem.body.levels[0].vertices)
      u.push_back({0, 0, (height - 1) * x[2]});
    return State<Host>(device_field<Host>(u), device_field<Host>(probe.zero()));
  };
  const auto located = [&](double height) {
    return locate_failure<Host>("non_finite", probe.built, {kept_at(height)});
  };
  level.state.u(5, 1) = std::numeric_limits<double>::quiet_NaN();
  const Diagnosis flat = located(0);
  EXPECT_EQ(flat.vertex, 5);
  EXPECT_EQ(flat.J, 0);
  EXPECT_EQ(flat.kind, "inverted");
  EXPECT_EQ(located(-0.5).kind, "inverted");
  EXPECT_NEAR(located(-0.5).J, -0.5, 1e-12);
  EXPECT_EQ(located(0.5).kind, "non_finite");
  EXPECT_NEAR(located(0.5).J, 0.5, 1e-12);
  level.state.u(5, 1) = 0;
  EXPECT_EQ(locate_failure<Host>("energy", probe.built, {kept_at(0)}).kind, "energy");
}

}  // namespace
