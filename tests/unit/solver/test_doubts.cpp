// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "support/bodies.hpp"

// What a simulation takes, but a user should know.
namespace {

using namespace plica;
using namespace plica::test;

TEST(Doubts, DampingByStiffnessWhereNothingHoldsTheBody) {
  Problem p = small_cube();
  p.body.fixed.clear();
  p.body.damping.stiffness = 1e-3;
  ASSERT_EQ(other_doubts(p).size(), 1);
  EXPECT_EQ(other_doubts(p)[0].find("body.damping.stiffness: nothing holds the body"), 0);
  p.body.fixed = {left_face()};
  EXPECT_TRUE(other_doubts(p).empty());
}

}  // namespace
