// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/kernels/contact/contact_law.hpp>
#include <random>

// The law of one contact over a step; see kernels/contact/contact_law.hpp.
namespace {

using namespace plica;
using V = Vec3<double>;

constexpr double h = 1e-3;
const ContactLaw<double> law{1000, 2, 400, 1, 0.3, 0};

// What stays bears the spring alone; what approaches is damped too; what leaves is never pulled.
TEST(ContactLaw, IsASpringAndADamperThatNeverPulls) {
  const LawOfStep<double> of(law, h);
  EXPECT_NEAR(of.normal_force(0.01, 0.01), 10, 1e-12);
  EXPECT_NEAR(of.normal_force(0.01, 0.011), 11 + 2 * 0.001 / h, 1e-12);
  EXPECT_EQ(of.normal_force(0.01, 0.001), 0);
  EXPECT_EQ(of.normal_force(-0.01, -0.001), 0);
}

// A damper by itself would jump where a site touches: the force is continuous in the depth at the
// end, from 0.
TEST(ContactLaw, SetsInWithoutAJump) {
  const LawOfStep<double> of(law, h);
  EXPECT_EQ(of.normal_force(-0.5, 0), 0);
  EXPECT_NEAR(of.normal_force(-0.5, 1e-9), 1e-9 * of.kn, 1e-15);
  const double shift = of.shift * 0.01;
  EXPECT_NEAR(of.normal_force(0.01, shift + 1e-9), 1e-9 * of.kn, 1e-12);
}

// Over any way in and out: what the force takes is what the spring stores, and more.
TEST(ContactLaw, GivesBackNoMoreThanTheSpringHad) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> depth(-0.01, 0.01), power(-2, 2);
  const auto stored = [](double k, double d) { return d > 0 ? 0.5 * k * d * d : 0.0; };
  for (int n = 0; n < 100000; ++n) {
    ContactLaw<double> one = law;
    one.stiffness *= std::pow(10, power(random)), one.damping *= std::pow(10, power(random));
    const LawOfStep<double> of(one, h);
    const double start = depth(random), end = depth(random),
                 taken = of.normal_force(start, end) * (end - start);
    ASSERT_GE(taken - (stored(one.stiffness, end) - stored(one.stiffness, start)), -1e-15);
  }
}

// A stretch that stays is held by its spring; damping adds to a way alone.
TEST(ContactLaw, HoldsAStretch) {
  const LawOfStep<double> of(law, h);
  const double s = 1e-4, D = 2e-5;
  EXPECT_NEAR(of.kt * of.memory * s, 400 * s, 1e-12);
  EXPECT_NEAR(of.kt * (D + of.memory * s), 400 * (s + D) + 1 / h * D, 1e-12);
}

TEST(ContactLaw, OfATieActsInAllDirections) {
  ContactLaw<double> tie = law;
  tie.strength = 5;
  const LawOfStep<double> of(tie, h);
  EXPECT_TRUE(tie.is_tie());
  EXPECT_NEAR(of.kt, 1000 + 2 / h, 1e-12);
  const V cut = at_most(V{3, 4, 0}, 1.0), kept = at_most(V{0.3, 0.4, 0}, 1.0);
  EXPECT_NEAR(cut[0], 0.6, 1e-15);
  EXPECT_EQ(kept[1], 0.4);
}

}  // namespace
