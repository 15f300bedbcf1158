// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/core/error.hpp>
#include <plica/drivers/elastic/materials.hpp>
#include <plica/drivers/run/diagnose.hpp>
#include <plica/drivers/run/registry.hpp>
#include <plica/drivers/run/validate.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/refusal.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// Bodies that start flat, inside out or at random, and what becomes of them.
namespace {

using namespace plica;
using namespace plica::test;

template <class B>
class BadStates : public testing::Test {};
TYPED_TEST_SUITE(BadStates, EachBackend);

Problem deformed(const std::string& material, const Point& stretch,
                 std::optional<int> random = {}) {
  Problem p = small_cube(material, 2);
  p.body.material.allow_inversion = true;
  p.body.initial.stretch = stretch, p.body.initial.random = random;
  return p;
}

std::string refusal_of(const Problem& p) {
  return refusal([&] { Simulation<Host>{p}; });
}

TYPED_TEST(BadStates, StartsAreWhatTheySay) {
  Problem p = cube_levels(2, 3, "rs");
  p.body.levels.back() = p.body.levels.front();  // of the same vertices: its state is level 0's
  p.body.fixed = {left_face()};
  p.body.initial.position = Point(1, 2, 3);
  p.body.initial.stretch = {5, 0, -1};
  const Simulation<TypeParam> simulation(p);
  const auto& rest = p.body.levels[0].vertices;
  const double close = round_off<typename TypeParam::Real>(20);
  for (int level = 0; level < 2; ++level) {
    const auto x = simulation.positions(level);
    for (std::size_t a = 0; a < x.size(); ++a) {
      const Point from = rest[a] - Point(0.05, 0.05, 0.05), still = Point(1, 2, 3) + from;
      const Point moved = Point(1, 2, 3) + Point(5 * from[0], 0, -from[2]);
      EXPECT_LE((x[a] - (rest[a][0] == 0 ? still : moved)).norm(), close) << level << " " << a;
    }
  }
}

TEST(RandomStarts, LieInTheBoxAndRepeat) {
  const auto first = Simulation<Host>(deformed("corotational", Point::Ones(), 3)).positions();
  for (const Point& x : first)
    for (int k = 0; k < 3; ++k) EXPECT_TRUE(x[k] >= 0 && x[k] <= 0.1) << x;
  EXPECT_TRUE(
      same_bits(Simulation<Host>(deformed("corotational", Point::Ones(), 3)).positions(), first));
  EXPECT_GT(largest_difference(
                Simulation<Host>(deformed("corotational", Point::Ones(), 4)).positions(), first),
            0.02);
  // limits are those of the body at rest
  EXPECT_EQ(Simulation<Host>(deformed("corotational", Point::Ones(), 3)).levels()[0].critical_step,
            Simulation<Host>(deformed("corotational", Point::Ones())).levels()[0].critical_step);
}

// neo_hookean's mirrored start is far stiffer: it takes Newton's method. From random starts it may
// come to rest in a tangle: that is not asked for.
TEST(BadStates, NewtonTurnsAMirroredBodyBack) {
  Problem p = deformed("neo_hookean", {1, 1, -1});
  p.body.damping.mass = 20;
  p.integration.integrator = {"implicit_euler"}, p.integration.macro_step = 2e-3;
  p.integration.implicit.newton_iterations = 60;
  p.integration.on_failure.halvings = 10;
  Simulation<Host> simulation(p);
  const double before = simulation.energies().elastic;
  advance(simulation, 500);
  const auto J = simulation.element_fields().J;
  EXPECT_GT(*std::min_element(J.begin(), J.end()), 0.99);
  EXPECT_LT(simulation.energies().elastic, 1e-9 * before);
}

// Materials that claim it find back to their shape, up to a rigid motion; steps that are linearised
// once are retried by halves.
TYPED_TEST(BadStates, RecoverInMaterialsThatSaySo) {
  for (const char* material : {"corotational", "neo_hookean"}) {
    ASSERT_TRUE(recovers(material));
    std::vector<Problem> starts = {deformed(material, {1, 1, 0}), deformed(material, {5, 1, 1})};
    if (std::string(material) == "corotational")
      for (const Problem& more :
           {deformed(material, {1, 1, -1}), deformed(material, Point::Ones(), 1),
            deformed(material, Point::Ones(), 2)})
        starts.push_back(more);
    for (std::size_t i = 0; i < starts.size(); ++i) {
      SCOPED_TRACE(material + (" " + std::to_string(i)));
      Problem p = starts[i];
      p.body.damping.mass = 20;
      p.integration.integrator = {"implicit_euler"};
      p.integration.macro_step = 2e-3;
      p.integration.on_failure.halvings = 10;
      Simulation<TypeParam> simulation(p);
      const double before = simulation.energies().elastic;
      advance(simulation, 500);
      const auto J = simulation.element_fields().J;
      EXPECT_GT(*std::min_element(J.begin(), J.end()), 0.5);
      EXPECT_LT(simulation.energies().elastic, 1e-6 * before);
    }
  }
}

TEST(InvertedStarts, AreRefusedWhereTheyAreNotAllowed) {
  Problem p = deformed("neo_hookean", {1, 1, -1});
  EXPECT_EQ(refusal_of(p), "");
  p.body.material.allow_inversion.reset();
  const std::string said = refusal_of(p);
  for (const char* part :
       {"body.initial", "48 of 48 elements", "J = -1", "body.material.allow_inversion: true"})
    EXPECT_NE(said.find(part), std::string::npos) << said;
  p.body.initial.stretch = {1, -1, -1};  // turned about x
  EXPECT_EQ(refusal_of(p), "");
  p.body.material = {"corotational", 20e3, 0.35, 1000};
  p.body.initial.stretch = {1, 1, 0};
  EXPECT_EQ(refusal_of(p), "");
  p.body.material.allow_inversion = false;
  EXPECT_NE(refusal_of(p).find("body.initial"), std::string::npos);
}

TEST(InvertedStarts, AreDoubtedInMaterialsThatDoNotRecover) {
  const auto said = [](const std::string& material) {
    std::string all;
    for (const std::string& doubt : other_doubts(deformed(material, {1, 1, -1}))) all += doubt;
    return all;
  };
  EXPECT_NE(said("st_venant_kirchhoff").find("does not push them back"), std::string::npos);
  EXPECT_EQ(said("corotational"), "");
  EXPECT_EQ(said("neo_hookean"), "");
}

TEST(InitialShape, SenselessOnesAreRefused) {
  Problem p = deformed("corotational", {1, 2, 1}, 3);
  EXPECT_NE(refusal_of(p).find("one of them"), std::string::npos);
  p.body.initial.random = -1;
  EXPECT_NE(refusal_of(p).find("body.initial.random"), std::string::npos);
  p.body.initial.random.reset();
  p.body.initial.stretch[1] = std::numeric_limits<double>::infinity();
  EXPECT_NE(refusal_of(p).find("body.initial.stretch"), std::string::npos);
}

// Whoever asks for it is told of inverted elements in any material
TYPED_TEST(BadStates, InversionCanBeForbiddenToEachMaterial) {
  for (const Choice& material : materials()) {
    SCOPED_TRACE(material.name);
    for (const bool allowed : {true, false}) {
      Problem p = small_cube(material.name);
      p.body.material.allow_inversion = allowed;
      p.integration.macro_step = 1e-6;
      Simulation<TypeParam> simulation(p);
      std::vector<Point> u, v(p.body.levels[0].vertices.size(), Point::Zero());
      for (const Point& x : p.body.levels[0].vertices) u.push_back({0, 0, -2 * x[2]});
      simulation.set_state(u, v);
      simulation.step();
      const auto bad = simulation.check();
      EXPECT_EQ(bad && bad->kind == "inverted", !allowed);
    }
  }
}

// A macro step that is bad is taken again in halves, and nothing else changes.

template <class B>
class Retry : public testing::Test {};
TYPED_TEST_SUITE(Retry, EachBackend);

/// Let go a little squashed, in macro steps above the limit whose halves are below it: motion grows
/// until a step is bad.
Problem squashed(int halvings, const std::string& cycle = "single") {
  Problem p = cube_levels(cycle == "single" ? 1 : 2, 3, cycle);
  p.body.initial.stretch = {1, 1, 0.95};
  p.body.damping.mass = 50;
  p.integration.substeps = {1};
  p.integration.macro_step = cycle == "single" ? 5e-3 : 7e-3;
  p.integration.allow_unstable = true;
  p.integration.on_failure.halvings = halvings;
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
  EXPECT_GT(with.counters().at("step_halvings"), 0);
  EXPECT_GE(with.counters().at("rejected_steps"), with.counters().at("step_halvings"));
  EXPECT_FALSE(without.counters().contains("step_halvings"));
}

TYPED_TEST(Retry, OfAStepThatEndsTheRun) {
  Simulation<TypeParam> simulation(squashed(6));
  const double end = 60.5 * simulation.macro_step();
  simulation.end_at(end);
  advance(simulation, 61);
  EXPECT_EQ(simulation.time(), end);
  EXPECT_GT(simulation.counters().at("step_halvings"), 0);
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
    p.integration.on_failure.halvings = 4;
    Simulation<TypeParam> watched(p);
    advance(plain, 15), advance(watched, 15);
    EXPECT_TRUE(same_bits(plain.positions(), watched.positions()));
    EXPECT_EQ(watched.counters().at("step_halvings"), 0);
  }
}

TYPED_TEST(Retry, GivesUpAtItsLimit) {
  Problem p = squashed(2);
  Simulation<TypeParam> simulation(p);
  advance(simulation, 3);
  simulation.velocity()(17, 1) = std::numeric_limits<typename TypeParam::Real>::quiet_NaN();
  simulation.set_time(simulation.time());  // keeps this state: there is no sound one to go back to
  const auto bad = simulation.step_checked();
  ASSERT_TRUE(bad);
  EXPECT_EQ(bad->kind, "non_finite");
  EXPECT_EQ(simulation.counters().at("step_halvings"),
            simulation.counters().at("rejected_steps") - 1);
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
    const long halvings = simulation.counters().at("step_halvings");
    bad = simulation.check();
    EXPECT_TRUE(same_bits(simulation.positions(), x));
    EXPECT_EQ(simulation.counters().at("step_halvings"), halvings);
  }
  ASSERT_TRUE(bad);
  const long steps = simulation.macro_steps();
  EXPECT_FALSE(simulation.recover(*bad));
  EXPECT_EQ(simulation.macro_steps(), steps);
  EXPECT_GT(simulation.counters().at("step_halvings"), 0);
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

TEST(FailureOptions, AreChecked) {
  const auto refused = [](const Problem& p) { return refusal([&] { Simulation<Host>{p}; }); };
  EXPECT_NE(
      refused(squashed(11))
          .find(
              "integration.on_failure.halvings is 11; expected a whole number in [0, 10], or auto"),
      std::string::npos);
  EXPECT_NE(refused(squashed(-2)).find("integration.on_failure.halvings"), std::string::npos);
  for (const char* cycle : {"him", "auto"}) {
    Problem p = squashed(2, cycle);
    // which auto does not take either
    p.integration.macro_step.reset(), p.integration.allow_unstable = false;
    EXPECT_NE(refused(p).find("on_failure.halvings is 2, but cycle " + std::string(cycle)),
              std::string::npos)
        << cycle;
  }
}

}  // namespace
