// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <plica/drivers/solver/registry.hpp>
#include <plica/drivers/study/stability_matrix.hpp>
#include <set>

// The far end of every line of the matrix of stiff and extreme cases; `plica stability --matrix` runs all of it.
namespace {

using namespace plica;

class Matrix : public testing::TestWithParam<std::string> {};

TEST_P(Matrix, EveryCaseEndsAsItMust) {
  std::vector<MatrixCase> mine;
  for (const MatrixCase& one : stability_matrix(MatrixSize::small))
    if (one.name.ends_with(", " + GetParam())) mine.push_back(one);
  ASSERT_GT(mine.size(), 20U);
  const MatrixResult result = run_matrix(mine, {});
  for (const MatrixRow& row : result.rows)
    EXPECT_TRUE(row.ok) << row.name << ", " << row.method << ": " << row.outcome << "; expected " << row.expected
                        << ". " << row.detail;
}

INSTANTIATE_TEST_SUITE_P(Materials, Matrix, testing::ValuesIn(names(materials())),
                         [](const auto& material) { return material.param; });

TEST(Matrix, BodiesInOtherWordsMoveAlike) {
  for (const auto& run : invariance_cases(MatrixSize::small)) {
    const MatrixRow row = run();
    EXPECT_TRUE(row.ok) << row.name << ", " << row.method << ": " << row.outcome << "; expected " << row.expected;
  }
}

TEST(Matrix, NoCaseIsThereTwice) {
  std::set<std::string> seen;
  for (const MatrixCase& one : stability_matrix())
    EXPECT_TRUE(seen.insert(one.name + ", " + one.method).second) << one.name << ", " << one.method;
  EXPECT_GT(seen.size(), 1000U);
}

// A case has one outcome, or says why two are right; where every outcome is, there is nothing to check.
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
  EXPECT_LT(several, all.size() / 20);
  MatrixCase one = all.front();
  one.expected.why = "a reason";
  EXPECT_EQ(run_case(one).why, "a reason");
}

TEST(Matrix, AWrongOutcomeIsSeen) {
  const auto all = stability_matrix(MatrixSize::small);
  const auto find = [&](const std::string& text) {
    return *std::ranges::find_if(all, [&](const MatrixCase& one) { return one.expected.text() == text; });
  };
  MatrixCase completes = find("completed"), stops = find("stopped"), refused = find("refused");
  for (MatrixCase* one : {&completes, &stops, &refused}) EXPECT_TRUE(run_case(*one).ok) << one->name;
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
  const MatrixResult result = run_matrix({all[0], all[1]}, {}, [](const MatrixResult&, std::size_t of) {
    EXPECT_EQ(of, 2U);
    return false;
  });
  EXPECT_TRUE(result.stopped);
  EXPECT_EQ(result.rows.size(), 1U);
  EXPECT_EQ(result.left_out, 1U);
}

}  // namespace
