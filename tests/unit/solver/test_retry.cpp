// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/core/error.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// A macro step that is bad is taken again in halves, and nothing else changes.
namespace {

using namespace plica;
using namespace plica::test;

template <class B>
class Retry : public testing::Test {};
TYPED_TEST_SUITE(Retry, EachBackend);

/// Let go a little squashed, in macro steps above the limit whose halves are below it: motion grows until a step is bad.
Problem squashed(int halvings, const std::string& cycle = "single") {
  Problem p = cube_levels(cycle == "single" ? 1 : 2, 3, cycle);
  p.body.initial.stretch = {1, 1, 0.95};
  p.body.damping.mass = 50;
  p.integration.substeps = {1};
  p.integration.macro_step = cycle == "single" ? 5e-3 : 7e-3;
  p.integration.allow_unstable = true;
  p.integration.retry.halvings = halvings;
  return p;
}

TYPED_TEST(Retry, GoesOnWhereTheRunWouldEnd) {
  Simulation<TypeParam> without(squashed(0)), with(squashed(6));
  bool ended = false;
  for (int n = 0; n < 100 && !ended; ++n) {
    ended = without.step_checked().has_value();
  }
  ASSERT_TRUE(ended);
  advance(with, 100);
  EXPECT_DOUBLE_EQ(with.time(), 100 * with.macro_step());
  EXPECT_EQ(with.macro_steps(), 100);
  EXPECT_GT(with.counters().at("halvings"), 0);
  EXPECT_GE(with.counters().at("rejected_steps"), with.counters().at("halvings"));
  EXPECT_FALSE(without.counters().contains("halvings"));
}

TYPED_TEST(Retry, OfAStepThatEndsTheRun) {
  Simulation<TypeParam> simulation(squashed(6));
  const double end = 60.5 * simulation.macro_step();
  simulation.end_at(end);
  advance(simulation, 61);
  EXPECT_EQ(simulation.time(), end);
  EXPECT_GT(simulation.counters().at("halvings"), 0);
  std::vector<Point> u(simulation.positions().size(), Point::Zero()), v = u;
  simulation.set_state(u, v);
  simulation.end_at(end + 0.25 * simulation.macro_step());
  advance(simulation, 1);
  EXPECT_EQ(simulation.time(), end + 0.25 * simulation.macro_step());
}

TYPED_TEST(Retry, IsNotNoticedWhereNothingIsBad) {
  for (const char* cycle : {"single", "rsv"}) {
    Problem p = squashed(0, cycle);
    p.integration.macro_step = 1e-3;
    Simulation<TypeParam> plain(p);
    p.integration.retry.halvings = 4;
    Simulation<TypeParam> watched(p);
    advance(plain, 15), advance(watched, 15);
    EXPECT_TRUE(same_bits(plain.positions(), watched.positions()));
    EXPECT_EQ(watched.counters().at("halvings"), 0);
  }
}

TYPED_TEST(Retry, GivesUpAtItsLimit) {
  Problem p = squashed(2);
  Simulation<TypeParam> simulation(p);
  std::vector<Point> u(p.body.levels[0].vertices.size(), Point::Zero()), v = u;
  v[17] = {0, std::numeric_limits<double>::quiet_NaN(), 0};
  advance(simulation, 3);
  simulation.set_state(u, v);
  const auto bad = simulation.step_checked();
  ASSERT_TRUE(bad);
  EXPECT_EQ(bad->kind, "non_finite");
  EXPECT_EQ(simulation.counters().at("halvings"), simulation.counters().at("rejected_steps") - 1);
}

TYPED_TEST(Retry, OfCyclesAndOfSeveralStepsAtOnce) {
  for (const char* cycle : {"rs", "rsv", "fas"}) {
    SCOPED_TRACE(cycle);
    Simulation<TypeParam> simulation(squashed(8, cycle));
    for (int n = 0; n < 20; ++n) {
      simulation.step(), simulation.step();
      auto bad = simulation.check();
      if (bad) bad = simulation.recover(*bad);
      ASSERT_FALSE(bad) << bad->text();
    }
    EXPECT_EQ(simulation.macro_steps(), 40);
    EXPECT_DOUBLE_EQ(simulation.time(), 40 * simulation.macro_step());
  }
}

// A look at the state is no step.
TYPED_TEST(Retry, LeavesTheStateToTheCheckAsItIs) {
  Simulation<TypeParam> simulation(squashed(6));
  std::optional<Diagnosis> bad;
  for (int n = 0; n < 100 && !bad; ++n) {
    simulation.step();
    const auto x = simulation.positions();
    const long halvings = simulation.counters().at("halvings");
    bad = simulation.check();
    EXPECT_TRUE(same_bits(simulation.positions(), x));
    EXPECT_EQ(simulation.counters().at("halvings"), halvings);
  }
  ASSERT_TRUE(bad);
  const long steps = simulation.macro_steps();
  EXPECT_FALSE(simulation.recover(*bad));
  EXPECT_EQ(simulation.macro_steps(), steps);
  EXPECT_GT(simulation.counters().at("halvings"), 0);
  EXPECT_FALSE(simulation.check());
}

TYPED_TEST(Retry, ContinuesBitForBitFromASavedState) {
  Simulation<TypeParam> whole(squashed(6)), second(squashed(6));
  advance(whole, 4);
  const SavedState saved = whole.save();
  advance(whole, 30);
  second.restore(saved);
  advance(second, 30);
  EXPECT_TRUE(same_bits(whole.positions(), second.positions()));
  EXPECT_TRUE(same_bits(whole.velocities(), second.velocities()));
  EXPECT_EQ(whole.counters(), second.counters());
}

TEST(RetryOptions, AreChecked) {
  const auto refusal = [](Problem p) -> std::string {
    try {
      const Simulation<Host> simulation(p);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_NE(refusal(squashed(11)).find("integration.retry.halvings is 11; expected a whole number in [0, 10]"),
            std::string::npos);
  EXPECT_NE(refusal(squashed(-1)).find("integration.retry.halvings"), std::string::npos);
  for (const char* cycle : {"him", "auto"}) {
    Problem p = squashed(2, cycle);
    p.integration.macro_step.reset(), p.integration.allow_unstable = false;  // which auto does not take either
    EXPECT_NE(refusal(p).find("retry.halvings is 2, but cycle " + std::string(cycle)), std::string::npos) << cycle;
  }
}

}  // namespace
