// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <plica/core/error.hpp>
#include <plica/core/keys.hpp>
#include <plica/drivers/elastic/materials.hpp>
#include <plica/drivers/study/stability.hpp>
#include <plica/drivers/study/stability_matrix.hpp>
#include <plica/meshes/generators.hpp>
#include <set>

#include "support/bodies.hpp"

// Largest stable steps: the search, and what it finds beside what was predicted.
namespace {

using namespace plica;
using namespace plica::test;

using Kind = LargestStep::Kind;

StudyOptions asked(std::vector<std::string> methods) {
  StudyOptions o;
  o.duration = 0.05, o.methods = std::move(methods);
  return o;
}

Problem beam() {
  Problem p = clamped_beam().problem;
  p.body.material.model = "linear";
  return p;
}

Problem ball() {
  Problem p = body_of({ball_mesh({0, 0, 0}, 0.05, 6), ball_mesh({0, 0, 0}, 0.05, 3)}, "linear");
  return p;
}

Problem slivers() {
  MatrixBody body = clamped_beam();
  set_slivers(body, 100);
  body.problem.body.material.model = "linear";
  return body.problem;
}

const StabilityRow& row_of(const StabilityResult& result, const std::string& label) {
  const auto row = std::ranges::find(result.rows, label, &StabilityRow::label);
  EXPECT_NE(row, result.rows.end()) << label;
  return *row;
}

void expect_agreement(const Problem& p, std::vector<std::string> methods, double within) {
  const StabilityResult result = stability(p, asked(std::move(methods)));
  EXPECT_TRUE(result.left_out.empty());
  for (const StabilityRow& row : result.rows) {
    ASSERT_EQ(row.status, "limited") << row.label() << row.reason;
    EXPECT_NEAR(*row.ratio, 1, within) << row.label();
    EXPECT_DOUBLE_EQ(*row.ratio, *row.measured / *row.predicted);
    EXPECT_FALSE(row.scene) << "linear";
  }
}

TEST(LargestStable, BracketsAndBisects) {
  for (const double limit : {0.02, 0.5, 0.99, 1.0, 1.01, 3.0, 60.0}) {
    int runs = 0;
    const LargestStep found = largest_stable({1, 0.01, 100, 1.01, 1e-3},
                                             [&](double step) { return ++runs, step <= limit; });
    EXPECT_EQ(found.kind, Kind::limited) << limit;
    EXPECT_LE(found.step, limit);
    EXPECT_GE(found.step, limit / 1.001);
    EXPECT_LE(runs, 30) << limit;
  }
  EXPECT_EQ(largest_stable({1, 0.5, 100, 1.1, 0.01}, [](double) { return true; }).kind,
            Kind::unlimited);
  EXPECT_EQ(largest_stable({1, 0.5, 100, 1.1, 0.01}, [](double) { return true; }).step, 100);
  EXPECT_EQ(largest_stable({1, 0.5, 100, 1.1, 0.01}, [](double) { return false; }).kind,
            Kind::growing);
}

TEST(Stability, LevelsAloneAreAsPredicted) {
  for (const Problem& p : {beam(), ball(), slivers()})
    expect_agreement(p, {"single/symplectic_euler", "single/rk4"}, 0.02);
}

TEST(Stability, CoarserLevelsHaveEveryExplicitIntegrator) {
  const StabilityResult result = stability(beam(), asked({"coarse"}));
  EXPECT_NEAR(*row_of(result, "coarse/1").ratio, 1, 0.02);
  EXPECT_NEAR(*row_of(result, "coarse/1, rk4").ratio, 1, 0.02);
  for (const StabilityRow& row : result.rows) EXPECT_NE(row.integrator, "implicit_euler");
}

TEST(Stability, CyclesWithALimitAreAsPredicted) {
  for (const Problem& p : {beam(), ball(), slivers()}) expect_agreement(p, {"cycle/him"}, 0.1);
  expect_agreement(beam(), {"cycle/rs/equal"}, 0.1);
}

TEST(Stability, CyclesWithoutOneGrow) {
  const StabilityResult result =
      stability(beam(), asked({"cycle/rv/equal", "cycle/rsv/equal", "cycle/fas/equal"}));
  for (const StabilityRow& row : result.rows) {
    EXPECT_EQ(row.status, "growing") << row.label();
    EXPECT_EQ(*row.predicted, 0);
    EXPECT_GT(*row.growth_per_second, 0) << row.label();
    EXPECT_FALSE(row.ratio);
  }
  EXPECT_EQ(*result.rows[0].measured, 0) << "and a run shows it";
  EXPECT_NEAR(*result.rows[0].growth_per_second, *result.rows[1].growth_per_second, 1e-9)
      << "one map, linearised";
}

TEST(Stability, ForwardEulerGrowsUndampedAndImplicitLevelsDoNot) {
  const StabilityResult result =
      stability(beam(), asked({"single/euler", "single/implicit_euler"}));
  EXPECT_EQ(result.rows[0].status, "growing");
  EXPECT_EQ(*result.rows[0].predicted, 0);
  EXPECT_EQ(*result.rows[0].measured, 0);
  EXPECT_GT(*result.rows[0].growth_per_second, 1);
  EXPECT_EQ(result.rows[1].status, "unlimited");
  EXPECT_FALSE(result.rows[1].predicted || result.rows[1].measured);
  EXPECT_NEAR(*result.rows[1].stable_up_to, 1000 * result.rows[1].critical_step, 1e-6);
}

TEST(Stability, ABodyThatStiffensHasASmallerLimitThanAtRest) {
  Problem p = clamped_beam().problem;
  p.body.material.model = "st_venant_kirchhoff";
  // pulls the end out
  p.body.initial.parts = {{HalfSpaceSelection{{0.3, 0, 0}, -Point::UnitX()}, {8, 0, 0}}};
  const StabilityResult result = stability(p, asked({"single/symplectic_euler"}));
  const StabilityRow& row = result.rows.at(0);
  EXPECT_NEAR(*row.ratio, 1, 0.02) << "small motions know nothing of it";
  ASSERT_TRUE(row.scene && row.scene->step && row.scene->failed_step);
  EXPECT_LT(*row.scene->step, 0.95 * *row.measured);
  EXPECT_GT(*row.scene->failed_step, *row.scene->step);
  EXPECT_LT(*row.scene->failed_step, 1.05 * *row.scene->step);
  ASSERT_TRUE(row.scene->failure);
  EXPECT_TRUE(row.scene->failure->kind == "energy" || row.scene->failure->kind == "non_finite");
  EXPECT_EQ(row.scene->failure->level, 0);
  EXPECT_GE(row.scene->failure->element, 0);
  EXPECT_GT(row.scene->failed_time, 0);
  EXPECT_LT(row.scene->failed_time, 0.05);
}

TEST(Stability, StopsWhereItIsToldAndListsWhatItLeftOut) {
  StudyOptions o = asked({"single/symplectic_euler", "single/rk4"});
  const StabilityResult stopped =
      stability(beam(), o, [](const StabilityProgress& p) { return p.done == 0; });
  EXPECT_TRUE(stopped.stopped);
  EXPECT_EQ(stopped.rows.size(), 1U);
  EXPECT_EQ(stopped.left_out, std::vector<std::string>{"single/rk4"});
  o.budget = 1e-9;
  const StabilityResult late = stability(beam(), o);
  EXPECT_FALSE(late.stopped);
  EXPECT_EQ(late.left_out.size(), 2U);
}

TEST(Stability, UnknownMethodsGetTheNearest) {
  EXPECT_THROW(stability(beam(), asked({"cycle/rvs"})), InputError);
  EXPECT_THROW(stability(beam(), asked({"single/euller"})), InputError);
}

// The far end of every line of the matrix of stiff and extreme cases; `plica stability --matrix`
// runs all of it.

class Matrix : public testing::TestWithParam<std::string> {};

TEST_P(Matrix, EveryCaseEndsAsItMust) {
  std::vector<MatrixCase> mine;
  for (const MatrixCase& one : stability_matrix(MatrixSize::small))
    if (one.name.ends_with(", " + GetParam())) mine.push_back(one);
  ASSERT_GT(mine.size(), 20U);
  const MatrixResult result = run_matrix(mine, {});
  for (const MatrixRow& row : result.rows)
    EXPECT_TRUE(row.ok) << row.name << ", " << row.method << ": " << row.outcome << "; expected "
                        << row.expected << ". " << row.detail;
}

std::vector<std::string> materials_and_nodal() {
  std::vector<std::string> ends = materials_of_two_constants();
  ends.emplace_back("nodal");
  return ends;
}

INSTANTIATE_TEST_SUITE_P(Materials, Matrix, testing::ValuesIn(materials_and_nodal()),
                         [](const auto& end) { return end.param; });

// The body turns far within few steps: a cycle that is fitted to the last system, and not to this
// one, throws it away.
TEST(Matrix, OneVCycleFollowsABodyThatTurns) {
  int cases = 0;
  for (const MatrixCase& one : stability_matrix(MatrixSize::whole)) {
    if (one.method != "single/v_cycle_euler" ||
        !(one.name.find("x gravity") != std::string::npos || one.name.starts_with("flattened")))
      continue;
    const MatrixRow row = run_case(one);
    EXPECT_TRUE(row.ok) << row.name << ": " << row.outcome << "; expected " << row.expected << ". "
                        << row.detail;
    ++cases;
  }
  EXPECT_EQ(cases, 24);
}

TEST(Matrix, TissuesEndAsTheyMust) {
  std::set<std::string> tissue_names;
  for (const MatrixCase& one : tissue_cases()) {
    const MatrixRow row = run_case(one);
    EXPECT_TRUE(row.ok) << row.name << ", " << row.method << ": " << row.outcome << "; expected "
                        << row.expected << ". " << row.detail;
    EXPECT_TRUE(row.why.empty()) << row.name << " has one right outcome";
    tissue_names.insert(one.problem.body.material.tissue);
  }
  EXPECT_EQ(tissue_names.size(), tissues().size() + 1)
      << "all of them, and materials that are none";
}

TEST(Matrix, BodiesInOtherWordsMoveAlike) {
  for (const auto& run : invariance_cases(MatrixSize::small)) {
    const MatrixRow row = run();
    EXPECT_TRUE(row.ok) << row.name << ", " << row.method << ": " << row.outcome << "; expected "
                        << row.expected;
  }
}

TEST(Matrix, OrgansWithToolsComeToTheirEnd) {
  for (const auto& run : organ_cases(MatrixSize::small)) {
    const MatrixRow row = run();
    EXPECT_TRUE(row.ok) << row.name << ", " << row.method << ": " << row.outcome << ". "
                        << row.detail;
  }
}

TEST(Matrix, NoCaseIsThereTwice) {
  std::set<std::string> seen;
  for (const MatrixCase& one : stability_matrix())
    EXPECT_TRUE(seen.insert(one.name + ", " + one.method).second) << one.name << ", " << one.method;
  EXPECT_GT(seen.size(), 1000U);
}

// A case has one outcome, or says why two are right; where every outcome is, there is nothing to
// check.
TEST(Matrix, MoreThanOneOutcomeHasAReason) {
  std::size_t several = 0;
  const auto all = stability_matrix();
  for (const MatrixCase& one : all) {
    const Expected& e = one.expected;
    const int outcomes = (e.complete ? 1 : 0) + (e.stop ? 1 : 0) + (e.refuse ? 1 : 0);
    EXPECT_GE(outcomes, 1) << one.name;
    EXPECT_LE(outcomes, 2) << one.name;
    EXPECT_EQ(outcomes > 1, !e.why.empty()) << one.name << ", " << one.method;
    several += outcomes > 1 ? 1 : 0;
  }
  EXPECT_LT(several, all.size() / 12);
  MatrixCase one = all.front();
  one.expected.why = "a reason";
  EXPECT_EQ(run_case(one).why, "a reason");
}

TEST(Matrix, AWrongOutcomeIsSeen) {
  const auto all = stability_matrix(MatrixSize::small);
  const auto find = [&](const std::string& text) {
    return *std::ranges::find_if(
        all, [&](const MatrixCase& one) { return one.expected.text() == text; });
  };
  MatrixCase completes = find("completed"), stops = find("stopped"), refused = find("refused");
  for (MatrixCase* one : {&completes, &stops, &refused})
    EXPECT_TRUE(run_case(*one).ok) << one->name;
  std::swap(completes.expected, stops.expected);
  refused.expected = completes.expected;
  const MatrixResult result = run_matrix({completes, stops, refused}, {});
  for (const MatrixRow& row : result.rows) EXPECT_FALSE(row.ok) << row.name << row.outcome;
  EXPECT_FALSE(result.ok());
  EXPECT_EQ(result.rows[0].outcome, "completed");
  EXPECT_TRUE(result.rows[1].outcome.starts_with("stopped: "));
  EXPECT_FALSE(result.rows[2].detail.empty());
}

TEST(Matrix, StopsWhereItIsTold) {
  const auto all = stability_matrix(MatrixSize::small);
  const MatrixResult result =
      run_matrix({all[0], all[1]}, {}, [](const MatrixResult&, std::size_t of) {
        EXPECT_EQ(of, 2U);
        return false;
      });
  EXPECT_TRUE(result.stopped);
  EXPECT_EQ(result.rows.size(), 1U);
  EXPECT_EQ(result.left_out, 1U);
}

}  // namespace
