// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <plica/drivers/study/verify.hpp>

// Every problem of `plica verify`, on coarse meshes.
namespace {

using namespace plica;

class KnownAnswer : public testing::TestWithParam<std::string> {};

TEST_P(KnownAnswer, IsFound) {
  const VerifyResult result = verify({{GetParam()}, true});
  EXPECT_FALSE(result.rows.empty());
  for (const VerifyRow& row : result.rows) {
    EXPECT_NE(row.outcome, "not ok") << row.quantity << " " << (row.ours.empty() ? 0 : row.ours.back().value) << " "
                                     << row.note;
    EXPECT_FALSE(row.source.empty()) << row.quantity;
    for (const VerifyValue& v : row.ours) EXPECT_TRUE(std::isfinite(v.value)) << row.quantity << " " << v.mesh;
  }
}

INSTANTIATE_TEST_SUITE_P(Of, KnownAnswer, testing::ValuesIn(names(verify_problems())),
                         [](const auto& test) { return test.param; });

double finest(const std::string& problem, std::size_t row) {
  return verify({{problem}, true}).rows.at(row).ours.back().value;
}

// Values that no tolerance of the table stands between
TEST(KnownAnswers, AreTheseNumbers) {
  EXPECT_NEAR(finest("axial_bar", 0), 6.25, 0.002);
  EXPECT_NEAR(finest("tapered_membrane", 0), 44.623, 0.5);
  EXPECT_GT(finest("tapered_membrane", 0), 44.623);
  const double cube = finest("free_cube", 0);
  EXPECT_GT(cube, 0.2626);
  EXPECT_LT(cube, 0.28);
  EXPECT_NEAR(*verify({{"cook_membrane"}, true}).rows.at(0).limit, 14.74, 0.15);
  EXPECT_LT(finest("cook_membrane", 0), 14.74);
}

}  // namespace
