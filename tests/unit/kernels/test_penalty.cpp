// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/kernels/contact/penalty.hpp>

#include "support/tolerance.hpp"

namespace {

using namespace plica;
using test::round_off;
using V = Vec3<double>;

const V up{0, 0, 1};
const PenaltyLaw<double> law{1000, 10, 5, 0.3};

TEST(Penalty, PushesByDepthAndDampsTheApproach) {
  const auto c = penalty_contact(law, {-0.01, up}, V{0, 0, -0.2}, 0.0);
  EXPECT_TRUE(c.active);
  EXPECT_DOUBLE_EQ(c.force[2], 1000 * 0.01 + 10 * 0.2);
  EXPECT_EQ(c.force[0], 0);
}

TEST(Penalty, NeverPulls) {
  EXPECT_FALSE(penalty_contact(law, {0.001, up}, V{0, 0, -100}, 0.0).active);  // apart
  EXPECT_FALSE(penalty_contact(law, {-0.01, up}, V{0, 0, 1.1}, 0.0).active);   // leaves faster than it is pushed
  EXPECT_TRUE(penalty_contact(law, {-0.01, up}, V{0, 0, 0.9}, 0.0).active);
}

TEST(Penalty, PredictsForImplicitSteps) {
  const auto c = penalty_contact(law, {0.001, up}, V{0, 0, -1}, 0.01);
  EXPECT_TRUE(c.active);
  EXPECT_DOUBLE_EQ(c.force[2], 1000 * (0.01 - 0.001) + 10 * 1);
  EXPECT_FALSE(penalty_contact(law, {-0.001, up}, V{0, 0, 1}, 0.01).active);
}

TEST(Penalty, FrictionSticksViscouslyAndSlipsAtCoulombsLimit) {
  const auto slow = penalty_contact(law, {-0.01, up}, V{0.1, 0, 0}, 0.0);  // 5 * 0.1 < 0.3 * 10
  EXPECT_DOUBLE_EQ(slow.force[0], -0.5);
  EXPECT_EQ(slow.slip[0], 0);
  const auto fast = penalty_contact(law, {-0.01, up}, V{3, 4, 0}, 0.0);
  EXPECT_NEAR(fast.force[0], -3 * 0.6, round_off<double>(8));
  EXPECT_NEAR(fast.force[1], -3 * 0.8, round_off<double>(8));
  EXPECT_NEAR(fast.drag, 3.0 / 5, round_off<double>(8));
  EXPECT_NEAR(fast.slip[0], 0.6, round_off<double>(8));
  EXPECT_NEAR(fast.slip[1], 0.8, round_off<double>(8));
}

TEST(Penalty, RestsWithoutDivision) {
  const auto c = penalty_contact(PenaltyLaw<double>{1000, 10, 0, 0}, {-0.01, up}, V{0, 0, 0}, 0.0);
  EXPECT_DOUBLE_EQ(c.force[2], 10);
  EXPECT_EQ(c.force[0], 0);
}

}  // namespace
