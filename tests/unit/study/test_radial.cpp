// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <plica/drivers/study/verify/radial.hpp>

// Exact solutions of thick walls under pressure, against closed forms in their limits.
namespace {

using namespace plica;

constexpr double mu = 1000;  // [Pa]

/// Neo-Hookean wall with radii of 1 and 2 m.
RadialWall neo_hookean_wall(bool ball, double bulk) {
  return {1, 2, ball, 1, [=](const Radial& l) { return neo_hookean_stress(l, mu, bulk); }};
}

TEST(RadialWalls, BallIsTheIncompressibleOneInItsLimit) {
  const RadialState found = inflated(neo_hookean_wall(true, 1e7 * mu), 1.1);
  const double b = 1.1, a = std::cbrt(1 + 8 * (b * b * b - 1));  // stretches outside and inside
  const auto term = [](double l) { return 4 / l + std::pow(l, -4); };
  EXPECT_NEAR(found.inner, a, 1e-6);
  EXPECT_NEAR(found.pressure, mu / 2 * (term(b) - term(a)), 1e-5 * found.pressure);
}

TEST(RadialWalls, TubeIsTheIncompressibleOneInItsLimit) {
  const RadialState found = inflated(neo_hookean_wall(false, 1e7 * mu), 1.1);
  const double b = 1.1, a = std::sqrt(1 + 4 * (b * b - 1));
  const double pressure = mu * (std::log(a / b) + (1 / (b * b) - 1 / (a * a)) / 2);
  EXPECT_NEAR(found.inner, a, 1e-6);
  EXPECT_NEAR(found.pressure, pressure, 1e-5 * pressure);
}

// Lame's tube in plane strain: the sum of radial and hoop stress is the same everywhere.
TEST(RadialWalls, SmallGrowthIsLamesTube) {
  const double bulk = 2.5 * mu, lambda = bulk - 2 * mu / 3, nu = lambda / (2 * (lambda + mu)),
               growth = 1e-6;
  const RadialState found = inflated(neo_hookean_wall(false, bulk), 1 + growth);
  // outer growth = p A^2/(B^2 - A^2) (1/(2 (lambda + mu)) + 1/(2 mu)) with A = 1, B = 2
  const double pressure = growth * 3 / (1 / (2 * (lambda + mu)) + 1 / (2 * mu));
  EXPECT_NEAR(found.pressure, pressure, 3e-5 * pressure);
  EXPECT_NEAR(found.axial, 2 * nu * pressure * std::numbers::pi, 3e-5 * found.axial);
}

}  // namespace
