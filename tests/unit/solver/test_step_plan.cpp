// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <numeric>
#include <plica/core/error.hpp>
#include <plica/drivers/solver/set_up/plan_steps.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// Shares of the macro step, sub-steps, and what is refused.
namespace {

using namespace plica;
using namespace plica::test;

const std::vector<LevelLimits> levels = {{6 * 17 * 17 * 17, "symplectic_euler", true, 1.0e-3},
                                         {6 * 15 * 15 * 15, "symplectic_euler", true, 1.1e-3},
                                         {6 * 12 * 12 * 12, "symplectic_euler", true, 1.4e-3},
                                         {6 * 10 * 10 * 10, "implicit_euler", false, 1.7e-3}};

IntegrationOptions options(const std::string& distribution, double shift, double macro_step) {
  IntegrationOptions o;
  o.distribution = distribution, o.shift_to_coarsest = shift, o.macro_step = macro_step;
  return o;
}

std::string refusal(const IntegrationOptions& o, const std::vector<LevelLimits>& of = levels) {
  try {
    plan_steps(o, of);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(Shares, SumToOneInEveryDistribution) {
  for (const char* distribution : {"equal", "inverse_elements", "critical", "custom"})
    for (double shift : {0.0, 0.3, 0.99}) {
      IntegrationOptions o = options(distribution, shift, 1e-3);
      o.shares = {0.1, 0.2, 0.3, 0.4};
      const auto share = plan_steps(o, levels).share;
      EXPECT_NEAR(std::accumulate(share.begin(), share.end(), 0.0), 1, round_off<double>(8)) << distribution;
      for (double w : share) EXPECT_GT(w, 0);
    }
}

TEST(Shares, AreWhatTheirNamesSay) {
  const auto critical = plan_steps(options("critical", 0, 1e-3), levels).share;
  EXPECT_NEAR(critical[3] / critical[0], 1.7, round_off<double>(8));
  const auto elements = plan_steps(options("inverse_elements", 0, 1e-3), levels).share;
  EXPECT_NEAR(elements[3] / elements[0], std::pow(1.7, 3), round_off<double>(16));
  EXPECT_NEAR(plan_steps(options("equal", 0, 1e-3), levels).share[2], 0.25, round_off<double>(2));
}

// The paper's hybrid cycle: equation 1 on cubes of 17, 15, 12 and 10 cells, half of it moved, shares 23 ms as 17 + 6.
TEST(Shares, MovedToTheCoarsestAreThePapersTable2) {
  const auto share = plan_steps(options("inverse_elements", 0.5, 0.023), levels).share;
  EXPECT_NEAR(share[3] * 23, 17.03, 0.005);
  EXPECT_NEAR((share[0] + share[1] + share[2]) * 23, 5.97, 0.005);
}

TEST(Shares, OfOneLevelAreAll) {
  EXPECT_EQ(plan_steps(options("inverse_elements", 0.5, 1e-4), {levels[0]}).share, std::vector<double>{1.0});
}

TEST(Shares, RefusesCustomOnesThatDoNotFit) {
  IntegrationOptions o = options("custom", 0, 1e-3);
  o.shares = {0.1, 0.2, 0.3, 0.41};
  EXPECT_NE(refusal(o).find("the shares must add up to 1, got 1.01"), std::string::npos) << refusal(o);
  o.shares = {0.1, 0.2, 0.3, 0.4 + 1e-11};
  EXPECT_NE(refusal(o).find("add up to 1, got 1.00000000001"), std::string::npos) << refusal(o);
  o.shares = {0.5, 0.5};
  EXPECT_NE(refusal(o).find("one for each level (4 in body.levels), got a list of 2"), std::string::npos) << refusal(o);
  o.shares = {0.5, 0.6, -0.2, 0.1};
  EXPECT_NE(refusal(o).find("integration.distribution is -0.2; expected a number > 0"), std::string::npos)
      << refusal(o);
  o.distribution = "equall";
  EXPECT_NE(refusal(o).find("did you mean 'equal'?"), std::string::npos) << refusal(o);
}

// A level without a limit of its own has no critical share: never a NaN that runs.
TEST(Shares, RefusesCriticalOnesWithoutALimit) {
  auto none = levels, rigid = levels;
  none[0].integrator = "euler", none[0].critical_step = 0;
  rigid[3].critical_step = std::numeric_limits<double>::infinity();
  IntegrationOptions o = options("critical", 0, 1e-3);
  o.allow_unstable = true;
  for (const auto& bad : {none, rigid}) {
    EXPECT_NE(refusal(o, bad).find("critical"), std::string::npos) << refusal(o, bad);
    EXPECT_NE(refusal(o, bad).find("equal"), std::string::npos) << refusal(o, bad);
  }
  auto all = none;
  for (auto& level : all) level.critical_step = 0, level.integrator = "euler", level.is_explicit = true;
  EXPECT_NE(refusal(o, all), "");
  o.distribution = "equal";
  EXPECT_EQ(refusal(o, all), "");
  // one level needs no shares
  EXPECT_EQ(refusal(options("critical", 0, 1e-3), {rigid[3]}), "");
}

TEST(Substeps, AutomaticOnesKeepTheLimit) {
  IntegrationOptions o = options("equal", 0, 0.02);
  const StepPlan plan = plan_steps(o, levels);
  EXPECT_EQ(plan.substeps, (std::vector<int>{6, 6, 4, 1}));  // ceil(5 ms / (0.9 * limit)); implicit: one
  o.safety = 1;
  EXPECT_EQ(plan_steps(o, levels).substeps, (std::vector<int>{5, 5, 4, 1}));
  o.substeps = {7, 8, 9, 2};
  EXPECT_EQ(plan_steps(o, levels).substeps, (std::vector<int>{7, 8, 9, 2}));
  EXPECT_EQ(refusal(options("equal", 0, 1e6)),
            "integration.macro_step asks for 277777778 sub-steps on one level; expected at most 1000000");
}

TEST(MacroStep, AutomaticIsNineTenthsOfTheTightestLevel) {
  IntegrationOptions o;
  o.distribution = "custom", o.shares = {0.4, 0.3, 0.2, 0.1};
  EXPECT_NEAR(plan_steps(o, levels).macro_step, 0.9 * 1e-3 / 0.4, round_off<double>(8, 1e-3));
  EXPECT_EQ(plan_steps(o, levels).substeps, (std::vector<int>{1, 1, 1, 1}));
  o.substeps = {4, 1, 1, 1};
  EXPECT_NEAR(plan_steps(o, levels).macro_step, 0.9 * 1.1e-3 / 0.3, round_off<double>(8, 1e-3));
  EXPECT_NE(refusal(IntegrationOptions{}, {levels[3]}).find("give it in seconds"), std::string::npos);
}

TEST(MacroStep, AboveTheLimitIsRefusedWithNumbersAndRemedy) {
  IntegrationOptions o = options("equal", 0, 0.008);
  o.substeps = {1};
  const std::string text = refusal(o);
  for (const char* part : {"level 0", "symplectic_euler", "0.002 s", "2 times", "critical step 0.001 s", "substeps: 2",
                           "implicit", "allow_unstable: true"})
    EXPECT_NE(text.find(part), std::string::npos) << part << " not in: " << text;
  o.allow_unstable = true;
  EXPECT_EQ(refusal(o), "");
  EXPECT_EQ(plan_steps(o, levels).substeps, (std::vector<int>{1, 1, 1, 1}));
}

TEST(MacroStep, UndampedEulerIsRefused) {
  Problem p = small_cube();
  p.integration.integrator = {"euler"};
  const auto text = [&]() -> std::string {
    try {
      Simulation<Host> simulation(p);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_NE(text().find("stable at no step"), std::string::npos) << text();
  p.integration.macro_step = 1e-5;
  EXPECT_NE(text().find("grows at every step"), std::string::npos) << text();
  p.integration.allow_unstable = true;
  EXPECT_EQ(text(), "");
  p.integration.allow_unstable = false, p.integration.macro_step.reset(), p.body.damping.mass = 1;
  EXPECT_EQ(text(), "");
}

}  // namespace
