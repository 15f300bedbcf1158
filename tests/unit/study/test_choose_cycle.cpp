// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/core/error.hpp>
#include <plica/drivers/solver/simulation.hpp>
#include <plica/drivers/study/choose_cycle.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/refusal.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// Cycle auto: what it chooses, how good that is, and what it refuses.
namespace {

using namespace plica;
using namespace plica::test;

Problem sagging(const std::string& error_class) {
  Problem p = body_of({box_mesh(beam_box, {12, 4, 4}), box_mesh(beam_box, {6, 3, 3})}, "corotational");
  p.body.fixed = {left_face()};
  p.body.material.young_modulus = 300e3;
  p.gravity = {0, 0, -9.81};
  p.integration.cycle = "auto", p.integration.error_class = error_class;
  return p;
}

template <class B = Host>
CycleChoice choice_of(const Problem& p, const typename B::Exec& exec = {}) {
  return choose_cycle<B>(p, exec).value();
}

/// Level 0's displacements at the trial's quarters, to rk4 at a quarter of the critical step.
double error_in_the_trial(const Problem& p) {
  const CycleChoice choice = choice_of(p);
  const double critical = choice.macro_step / choice.over_critical, quarter = 32 * critical;
  const auto states = [&](Problem q, double longest) {
    const int steps = static_cast<int>(std::ceil(quarter / longest * (1 - 1e-9)));
    q.integration.macro_step = quarter / steps;
    Simulation<Host> simulation(q);
    std::vector<Point> all;
    for (int i = 0; i < 4; ++i) {
      advance(simulation, steps);
      const auto u = displacements(simulation, p.body.levels[0]);
      all.insert(all.end(), u.begin(), u.end());
    }
    return all;
  };
  Problem chosen = p, exact = p;
  chosen.integration.cycle = choice.cycle;
  exact.integration.cycle = "single", exact.integration.integrator = {"rk4"};
  const auto u = states(chosen, choice.macro_step), from = states(exact, critical / 4);
  double difference = 0, size = 0;
  for (std::size_t a = 0; a < u.size(); ++a)
    difference += (u[a] - from[a]).squaredNorm(), size += from[a].squaredNorm();
  return std::sqrt(difference / size);
}

TEST(ChooseCycle, TakesALongerStepWhereMoreErrorIsAllowed) {
  const CycleChoice interactive = choice_of(sagging("interactive")), accurate = choice_of(sagging("accurate"));
  EXPECT_EQ(interactive.cycle, "him");
  EXPECT_GT(interactive.macro_step, 2 * accurate.macro_step);
  for (const CycleChoice& choice : {interactive, choice_of(sagging("balanced")), accurate}) {
    SCOPED_TRACE(choice.error_class);
    ASSERT_FALSE(choice.trials.empty());
    EXPECT_FALSE(choice.reason.empty());
    EXPECT_EQ(choice.trials.front().over_critical, 32);
    for (const CycleTrial& trial : choice.trials) {
      EXPECT_TRUE(trial.error || !trial.reason.empty());
      if (!trial.error) continue;
      if (trial.cycle == "him") {
        EXPECT_EQ(*trial.error <= choice.allowed, trial.macro_step == choice.macro_step);
      }
      EXPECT_NEAR(choice.duration, 128 / trial.over_critical * trial.macro_step, 1e-12);
    }
    EXPECT_EQ(choice.trials.back().cycle, choice.cycle);
  }
}

TEST(ChooseCycle, KeepsItsWordAndSetsItUp) {
  for (const auto& [error_class, allowed] : {std::pair{"interactive", 0.05}, {"balanced", 0.01}}) {
    const Problem p = sagging(error_class);
    const double error = error_in_the_trial(p);
    EXPECT_LE(error, 3 * allowed) << error_class;
    EXPECT_GT(error, 0) << error_class;
    const CycleChoice choice = choice_of(p);
    const Simulation<Host> simulation(with_choice(p, choice));
    EXPECT_EQ(simulation.macro_step(), choice.macro_step);
    EXPECT_EQ(simulation.him().has_value(), choice.cycle == "him");
  }
}

TEST(ChooseCycle, IsNotAskedByASimulation) {
  const Problem p = sagging("balanced");
  const std::string text = refusal([&] { Simulation<Host>{p}; });
  EXPECT_NE(text.find("integration.cycle is auto"), std::string::npos) << text;
  EXPECT_NE(text.find("choose_cycle()"), std::string::npos) << text;
  Problem named = p;
  named.integration.cycle = "him";
  EXPECT_FALSE(choose_cycle<Host>(named));
  EXPECT_EQ(with_choice(named, {}).integration.cycle, "him");
}

TEST(ChooseCycle, DoesWhatTheNamedCycleDoesBitForBit) {
  Problem p = sagging("balanced");
  const CycleChoice choice = choice_of(p);
  Simulation<Host> chosen(with_choice(p, choice));
  p.integration.cycle = choice.cycle, p.integration.macro_step = choice.macro_step;
  Simulation<Host> named(p);
  advance(chosen, 10), advance(named, 10);
  EXPECT_TRUE(same_bits(chosen.positions(), named.positions()));
  Simulation<Host> again(with_choice(sagging("balanced"), choice));
  again.restore(chosen.save());
  EXPECT_TRUE(same_bits(again.positions(), chosen.positions()));
}

TEST(ChooseCycle, TakesTheFinestLevelAloneWhereThereIsNoOther) {
  Problem p = sagging("interactive");
  p.body.levels = {box_mesh(bounding_box(p.body.levels[0].vertices), {4, 2, 2})};  // too few to make a level of
  const CycleChoice choice = choice_of(p);
  EXPECT_EQ(choice.cycle, "single");
  EXPECT_NEAR(choice.over_critical, 0.9, 1e-9);
  EXPECT_TRUE(choice.trials.empty());
  EXPECT_EQ(choice.reason, "there is no coarser level");
}

TEST(ChooseCycle, TakesTheUsualStepWhereNothingMoves) {
  Problem p = sagging("accurate");
  p.gravity = Point::Zero();
  const CycleChoice choice = choice_of(p);
  EXPECT_EQ(choice.cycle, "him");
  EXPECT_NEAR(choice.over_critical, 8, 1e-12);
  EXPECT_NE(choice.reason.find("nothing moves"), std::string::npos);
}

TEST(ChooseCycle, PassesByWhatIsRefused) {
  Problem p = sagging("interactive");
  p.body.levels[1] = box_mesh(beam_box, {20, 10, 10});  // more vertices than the coarsest level may have
  const CycleChoice choice = choice_of(p);
  EXPECT_EQ(choice.cycle, "single");
  ASSERT_EQ(choice.trials.size(), 6u);
  EXPECT_TRUE(choice.trials.back().error) << "of level 0 alone";
  for (const CycleTrial& trial : choice.trials) {
    if (trial.cycle == "single") continue;
    EXPECT_FALSE(trial.error);
    EXPECT_EQ(trial.reason.find("refused: "), 0u) << trial.reason;
  }
}

#if defined(KOKKOS_ENABLE_OPENMP)
TEST(ChooseCycle, IsTheSameForOneThreadAndTwo) {
  using B = Backend<double, Kokkos::OpenMP>;
  if (Kokkos::OpenMP().concurrency() < 2) GTEST_SKIP() << "one thread";
  const Kokkos::OpenMP one(1), two(2);
  const CycleChoice a = choice_of<B>(sagging("balanced"), one), b = choice_of<B>(sagging("balanced"), two);
  EXPECT_EQ(a.cycle, b.cycle);
  EXPECT_EQ(a.macro_step, b.macro_step);
  ASSERT_EQ(a.trials.size(), b.trials.size());
  for (std::size_t i = 0; i < a.trials.size(); ++i) EXPECT_EQ(a.trials[i].error, b.trials[i].error);
}
#endif

TEST(ChooseCycle, RefusesWhatItChoosesItself) {
  const auto message = [](const auto& change) {
    Problem p = sagging("balanced");
    change(p.integration);
    return refusal([&] { Simulation<Host>(with_choice(p, choose_cycle<Host>(p))); });
  };
  using O = IntegrationOptions;
  EXPECT_EQ(message([](O& o) { o.macro_step = 1e-3; }),
            "integration.macro_step is 0.001 s, but cycle auto chooses the macro step; leave it out");
  const auto expect_left_out = [&](const char* key, const auto& change) {
    const std::string text = message(change);
    EXPECT_EQ(text.find("integration." + std::string(key) + " is "), 0u) << text;
    EXPECT_NE(text.find("but cycle auto"), std::string::npos) << text;
  };
  expect_left_out("integrator", [](O& o) { o.integrator = {"rk4"}; });
  expect_left_out("substeps", [](O& o) { o.substeps = {2}; });
  expect_left_out("distribution", [](O& o) { o.distribution = "equal"; });
  expect_left_out("shift_to_coarsest", [](O& o) { o.shift_to_coarsest = 0.5; });
  expect_left_out("allow_unstable", [](O& o) { o.allow_unstable = true; });
  expect_left_out("outside", [](O& o) { o.outside = "keep"; });
  EXPECT_NE(message([](O& o) { o.error_class = "acurate"; }).find("did you mean 'accurate'"), std::string::npos);
  EXPECT_NE(message([](O& o) { o.cycle = "atuo"; }).find("did you mean 'auto'"), std::string::npos);
}

}  // namespace
