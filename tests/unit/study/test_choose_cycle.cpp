// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <memory>
#include <plica/core/error.hpp>
#include <plica/drivers/run/simulation.hpp>
#include <plica/drivers/study/choose_cycle.hpp>
#include <plica/drivers/study/first_touch.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/boundary_triangles.hpp>

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
  Problem p =
      body_of({box_mesh(beam_box, {12, 4, 4}), box_mesh(beam_box, {6, 3, 3})}, "corotational");
  p.body.fixed = {left_face()};
  p.body.material.young_modulus = 3e6;
  p.gravity = {0, 0, -9.81};
  p.integration.cycle = "auto", p.integration.error_class = error_class;
  return p;
}

/// A clock by which every step and every set-up takes as long as any other.
std::function<double()> even_clock() {
  return [now = std::make_shared<double>(0)] { return ++*now; };
}

/// A run of so many steps of level 0 alone.
ChoiceOptions run_of(const Problem& p, double steps) {
  return {steps * Simulation<Host>(level_0_alone(p)).macro_step(), even_clock()};
}

constexpr double long_run = 40000;

template <class B = Host>
CycleChoice choice_of(const Problem& p, const typename B::Exec& exec = {},
                      double steps = long_run) {
  return choose_cycle<B>(p, run_of(p, steps), exec).value();
}

/// Level 0's displacements at the ends of a trial's quarters from the scene's start, to rk4 at a
/// quarter of the critical step.
double error_from_the_start(const Problem& p, const CycleChoice& choice) {
  const double critical = choice.macro_step / choice.over_critical, quarter = 32 * critical;
  const auto states = [&](Problem q, double longest) {
    const int steps = static_cast<int>(std::ceil(quarter / longest * 0.99));
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
  const CycleChoice interactive = choice_of(sagging("interactive")),
                    accurate = choice_of(sagging("accurate"));
  EXPECT_EQ(interactive.cycle, "him");
  EXPECT_GT(interactive.macro_step, 2 * accurate.macro_step);
  for (const CycleChoice& choice : {interactive, choice_of(sagging("balanced")), accurate}) {
    SCOPED_TRACE(choice.error_class);
    ASSERT_FALSE(choice.trials.empty());
    EXPECT_FALSE(choice.reason.empty());
    EXPECT_EQ(choice.trials.front().cycle, "single");
    EXPECT_EQ(choice.trials[1].over_critical, 8);
    const CycleTrial* best = nullptr;
    for (const CycleTrial& trial : choice.trials) {
      EXPECT_TRUE(trial.error || !trial.reason.empty());
      if (!trial.error) continue;
      EXPECT_NEAR(choice.duration, 128 / trial.over_critical * trial.macro_step, 1e-12);
      if (*trial.error <= choice.allowed && (best == nullptr || trial.run_time < best->run_time))
        best = &trial;
    }
    ASSERT_EQ(best != nullptr, choice.cycle == "him");
    if (best == nullptr) continue;
    EXPECT_NEAR(choice.macro_step, best->macro_step, 2e-3 * best->macro_step);
    EXPECT_LE(choice.macro_step, best->macro_step);
  }
}

TEST(ChooseCycle, KeepsItsWordAndSetsItUp) {
  for (const auto& [error_class, allowed] : {std::pair{"interactive", 0.05}, {"balanced", 0.01}}) {
    const Problem p = sagging(error_class);
    const CycleChoice choice = choice_of(p);
    const double error = error_from_the_start(p, choice);
    EXPECT_LE(error, 3 * allowed) << error_class;
    EXPECT_GT(error, 0) << error_class;
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
  EXPECT_FALSE(choose_cycle<Host>(named, {}));
  EXPECT_EQ(with_choice(named, {}).integration.cycle, "him");
}

TEST(ChooseCycle, DoesWhatTheNamedCycleDoesBitForBit) {
  Problem p = sagging("balanced");
  const CycleChoice choice = choice_of(p);
  Simulation<Host> chosen(with_choice(p, choice));
  p.integration.cycle = choice.cycle, p.integration.macro_step = choice.macro_step;
  const std::string start = "cycle: him, macro_step: ";
  ASSERT_EQ(choice.keys().find(start), 0u);
  EXPECT_EQ(std::stod(choice.keys().substr(start.size())), choice.macro_step) << "to the last bit";
  Simulation<Host> named(p);
  advance(chosen, 10), advance(named, 10);
  EXPECT_TRUE(same_bits(chosen.positions(), named.positions()));
  Simulation<Host> again(with_choice(sagging("balanced"), choice));
  again.restore(chosen.save());
  EXPECT_TRUE(same_bits(again.positions(), chosen.positions()));
}

TEST(ChooseCycle, TakesTheFinestLevelAloneWhereThereIsNoOther) {
  Problem p = sagging("interactive");
  // too few to make a level of
  p.body.levels = {box_mesh(bounding_box(p.body.levels[0].vertices), {4, 2, 2})};
  const CycleChoice choice = choice_of(p);
  EXPECT_EQ(choice.cycle, "single");
  EXPECT_NEAR(choice.over_critical, 0.9, 1e-9);
  EXPECT_TRUE(choice.trials.empty());
  EXPECT_EQ(choice.reason, "there is no coarser level");
}

// What him refuses is no reason to refuse the scene: level 0 alone steps it. Nothing is timed.
TEST(ChooseCycle, TakesLevel0AloneWhereHimCannotStepTheScene) {
  Problem damped = sagging("interactive"), filled = damped;
  damped.body.damping.stiffness = 1e-5;
  filled.body.loads = {{left_face(), EnclosedVolume{1.2, 1e3}, {}}};
  const Simulation<Host> alone(level_0_alone(damped));
  const double duration = long_run * alone.macro_step();
  for (const auto& [p, why] : {std::pair{damped, "body.damping.stiffness is above 0"},
                               {filled, "body.loads.0.enclosed_volume needs cycle single"}}) {
    long asked = 0;
    const ChoiceOptions options{duration, [&asked] { return static_cast<double>(asked++); }};
    const CycleChoice choice = choose_cycle<Host>(p, alone, options).value();
    EXPECT_EQ(choice.cycle, "single");
    EXPECT_TRUE(choice.trials.empty());
    EXPECT_LE(asked, 1);
    EXPECT_NE(choice.reason.find(why), std::string::npos) << choice.reason;
    const std::string ahead = trials_ahead(p, duration, alone.levels().front(), alone.macro_step());
    EXPECT_EQ(ahead, "a run takes single: " + choice.reason);
  }
  Simulation<Host> simulation(with_choice(damped, choose_cycle<Host>(damped, {})));
  advance(simulation, 5);
}

TEST(ChooseCycle, TakesTheUsualStepWhereNothingMoves) {
  Problem p = sagging("accurate");
  p.gravity = Point::Zero();
  const CycleChoice choice = choice_of(p);
  EXPECT_EQ(choice.cycle, "him");
  EXPECT_NEAR(choice.over_critical, 8, 0.01);
  EXPECT_TRUE(choice.provisional);
  EXPECT_NE(choice.reason.find("nothing moves"), std::string::npos);
}

TEST(ChooseCycle, PassesByWhatIsRefused) {
  Problem p = sagging("interactive");
  // more vertices than the coarsest level may have
  p.body.levels[1] = box_mesh(beam_box, {20, 10, 10});
  const CycleChoice choice =
      choose_cycle<Host>(p, {std::numeric_limits<double>::infinity(), even_clock()}).value();
  EXPECT_EQ(choice.cycle, "single");
  ASSERT_EQ(choice.trials.size(), 3u) << "level 0 alone, and him at 8 and 4 times";
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
  const CycleChoice a = choice_of<B>(sagging("balanced"), one),
                    b = choice_of<B>(sagging("balanced"), two);
  EXPECT_EQ(a.cycle, b.cycle);
  EXPECT_EQ(a.macro_step, b.macro_step);
  ASSERT_EQ(a.trials.size(), b.trials.size());
  for (std::size_t i = 0; i < a.trials.size(); ++i) EXPECT_EQ(a.trials[i].error, b.trials[i].error);
}
#endif

TEST(ChooseCycle, TriesNothingWhereTheRunIsCheap) {
  const Problem p = sagging("interactive");
  long asked = 0;
  ChoiceOptions options = run_of(p, 2000);
  options.clock = [&asked] { return static_cast<double>(asked++); };
  const CycleChoice shorter = choose_cycle<Host>(p, options).value();
  EXPECT_EQ(shorter.cycle, "single");
  EXPECT_TRUE(shorter.trials.empty());
  EXPECT_LE(asked, 1) << "nothing is timed";
  EXPECT_NE(shorter.reason.find("the run is short: 2000 steps"), std::string::npos)
      << shorter.reason;
  EXPECT_EQ(shorter.keys(), "cycle: single, macro_step: auto");
  const CycleChoice longer = choice_of(p, {}, 3500);
  EXPECT_EQ(longer.cycle, "single");
  EXPECT_TRUE(longer.trials.empty());
  EXPECT_NE(longer.reason.find("trials would take"), std::string::npos) << longer.reason;
}

TEST(ChooseCycle, EndsTrialsThatTakeLongerThanTheyMay) {
  const Problem p = sagging("interactive");
  ChoiceOptions options = run_of(p, long_run);
  double now = 0;
  long readings = 0, stuck_from = std::numeric_limits<long>::max();
  options.clock = [&] { return now += ++readings > stuck_from ? 1e6 : 1; };
  const CycleChoice all = choose_cycle<Host>(p, options).value();
  EXPECT_LE(all.spent, trial_part * all.single_time);
  ASSERT_GE(all.trials.size(), 3u);
  long of_him = 0;
  for (const CycleTrial& trial : all.trials)
    if (trial.cycle == "him") of_him += std::lround(2 * 128 / trial.over_critical);
  stuck_from = readings - of_him - 3, now = 0, readings = 0;  // within the first trial of him
  const CycleChoice slow = choose_cycle<Host>(p, options).value();
  EXPECT_EQ(slow.cycle, "single");
  ASSERT_EQ(slow.trials.size(), 2u);
  EXPECT_EQ(slow.trials.back().reason.find("given up"), 0u) << slow.trials.back().reason;
}

/// One mesh, whose coarse levels are made, falls on a plane.
Problem dropped(double height) {
  Problem p = body_of({box_mesh(decimetre, {6, 6, 6})}, "neo_hookean");
  p.body.element = {"nodal"};
  p.body.material.young_modulus = 200e3;
  p.body.surface = boundary_surface(p.body.levels.front()).surface;
  p.gravity = {0, 0, -9.81};
  ObstacleOptions floor;
  floor.shape = PlaneOptions{{0, 0, -height}, {0, 0, 1}};
  p.contact.obstacles = {floor};
  p.integration.cycle = "auto", p.integration.error_class = "interactive";
  return p;
}

TEST(ChooseCycle, TriesTheImpactHoweverLongTheFall) {
  const Problem p = dropped(0.6);  // longer than 400 steps of level 0 alone
  const CycleChoice choice = choice_of(p);
  const double touch = first_touch(p, 10).time;
  ASSERT_GT(touch, 400 * choice.trials.front().macro_step);
  EXPECT_LT(choice.start, touch);
  EXPECT_GT(choice.start + choice.duration, touch);
  EXPECT_FALSE(choice.provisional);
  Simulation<Host> simulation(with_choice(p, choice));
  while (simulation.time() < touch + 0.1) {
    const auto diagnosis = simulation.step_checked();
    ASSERT_FALSE(diagnosis) << choice.keys() << ": " << diagnosis->text();
  }
}

TEST(ChooseCycle, TakesLevel0AloneWhereAFallIsShort) {
  const CycleChoice choice = choice_of(dropped(0.4), {}, 1000);
  EXPECT_EQ(choice.cycle, "single");
  EXPECT_TRUE(choice.trials.empty());
}

TEST(ChooseCycle, IsProvisionalWhereContactIsExpectedAndNotSeen) {
  Problem p = sagging("interactive");  // which the plane is too far from
  p.body.surface = boundary_surface(p.body.levels.front()).surface;
  ObstacleOptions floor;
  floor.shape = PlaneOptions{{0, 0, -0.3}, {0, 0, 1}};
  p.contact.obstacles = {floor};
  const CycleChoice choice = choice_of(p);
  ASSERT_FALSE(choice.trials.empty());
  for (const CycleTrial& trial : choice.trials) EXPECT_LE(trial.over_critical, 4);
  EXPECT_LE(choice.over_critical, 4);
  EXPECT_EQ(choice.provisional, choice.cycle == "him");
  if (choice.provisional) {
    EXPECT_NE(choice.reason.find("provisional"), std::string::npos) << choice.reason;
  }
}

TEST(ChooseCycle, SaysWhatItWouldTry) {
  const auto ahead = [](const Problem& p, double steps) {
    const Simulation<Host> alone(level_0_alone(p));
    return trials_ahead(p, steps * alone.macro_step(), alone.levels().front(), alone.macro_step());
  };
  EXPECT_NE(ahead(sagging("balanced"), 1000).find("takes single: the run is short: 1000 steps"),
            std::string::npos);
  EXPECT_NE(ahead(sagging("balanced"), long_run).find("tries him at 8 critical steps"),
            std::string::npos);
  EXPECT_NE(ahead(dropped(0.4), long_run).find("shortly before obstacle_0 is first touched"),
            std::string::npos);
  Problem named = sagging("balanced");
  named.integration.cycle = "him";
  EXPECT_EQ(ahead(named, long_run), "");
}

TEST(ChooseCycle, RefusesWhatItChoosesItself) {
  const auto message = [](const auto& change) {
    Problem p = sagging("balanced");
    change(p.integration);
    return refusal([&] { Simulation<Host>(with_choice(p, choose_cycle<Host>(p, {}))); });
  };
  using O = IntegrationOptions;
  EXPECT_EQ(
      message([](O& o) { o.macro_step = 1e-3; }),
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
  EXPECT_NE(message([](O& o) { o.error_class = "acurate"; }).find("did you mean 'accurate'"),
            std::string::npos);
  EXPECT_NE(message([](O& o) { o.cycle = "atuo"; }).find("did you mean 'auto'"), std::string::npos);
}

}  // namespace
