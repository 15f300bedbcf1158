// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <plica/drivers/study/stability.hpp>
#include <plica/drivers/study/verify.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/generators.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// Every problem of `plica verify`, on coarse meshes; and largest stable steps of bodies that are not among them.
namespace {

using namespace plica;
using namespace plica::test;

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

// A note is about its own row.
TEST(KnownAnswers, NotesOfTheCantileverAreTheirOwn) {
  for (const VerifyRow& row : verify({{"cantilever"}, true}).rows) {
    const bool extrapolated = row.judged == Judged::limit;
    const std::string percent = std::to_string(std::lround(100 * std::abs(row.ours.back().value / *row.accepted - 1)));
    EXPECT_EQ(row.note.find("lock") != std::string::npos, extrapolated) << row.quantity << ": " << row.note;
    EXPECT_EQ(row.note.find(" " + percent + " % off") != std::string::npos, extrapolated) << row.note;
    EXPECT_EQ(row.note.find("shear") != std::string::npos, row.quantity.starts_with("first bending frequency"))
        << row.quantity << ": " << row.note;
  }
}

TEST(LargestStableStep, OfAStiffInclusion) {
  Problem p = small_cube("linear", 4);
  p.body.levels[0] = with_regions(p.body.levels[0], 0.05, "stiff", "soft");
  p.body.regions["stiff"].young_modulus = 2e6;
  StudyOptions asked;
  asked.methods = {"single/symplectic_euler"};
  const StabilityRow row = stability(p, asked).rows.at(0);
  ASSERT_EQ(row.status, "limited") << row.reason;
  EXPECT_NEAR(*row.ratio, 1, 0.02);
}

// Deep in a plane that resists only along its normal every point is active: the prediction, which takes contact to act
// in all directions, is on the sure side, and not by much more than the friction-free directions account for.
TEST(LargestStableStep, InContactIsPredictedOnTheSureSide) {
  Problem p = small_cube("linear");
  p.body.surface = sphere_surface({0.05, 0.05, 0.05}, 0.049, 2);
  p.contact.obstacles.push_back({PlaneOptions{{0, 0, 0.5}, {0, 0, 1}}, {}, {}});
  p.contact.stiffness_scale = 5;
  p.body.fixed = {left_face()};
  p.integration.macro_step = 1e-7;
  const double predicted = Simulation<Host>(p).levels()[0].critical_step;
  const auto bounded = [&](double step) {
    Problem q = p;
    q.integration.macro_step = step, q.integration.substeps = {1}, q.integration.allow_unstable = true;
    Simulation<Host> simulation(q);
    for (int i = 0; i < 800; ++i) simulation.step();
    return largest(simulation.velocities()) < 1e3;
  };
  EXPECT_TRUE(bounded(0.999 * predicted));
  EXPECT_FALSE(bounded(1.6 * predicted));
}

}  // namespace
