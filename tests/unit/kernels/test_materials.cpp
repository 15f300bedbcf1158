// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "support/gradients.hpp"
#include "support/tolerance.hpp"

// Every registered material, pointwise.
namespace {

using namespace plica;
using namespace plica::test;

template <class Test>
void for_each_material(const Test& test) {
  Materials::for_each([&](auto material) {
    SCOPED_TRACE(decltype(material)::name);
    test(material);
  });
}

std::vector<Mat3<double>> directions() {
  std::mt19937 random(17);
  std::uniform_real_distribution<double> within(-1, 1);
  std::vector<Mat3<double>> list(3);
  for (auto& D : list)
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) D[r][c] = within(random);
  return list;
}

TEST(Materials, StressIsTheDerivativeOfTheEnergy) {
  for_each_material([](auto material) {
    using M = decltype(material);
    for (const Gradient& g : gradients(M::survives_inversion))
      for (const Mat3<double>& D : directions()) {
        const Mat3<double> F = mat3<double>(g.F);
        const double h = 1e-4 * g.smallest;
        const auto slope = [&](double t) {
          return (M::energy(F + t * D, soft) - M::energy(F - t * D, soft)) / (2 * t);
        };
        const double fourth_order = (4 * slope(h / 2) - slope(h)) / 3;
        const Mat3<double> P = M::stress(F, soft);
        EXPECT_NEAR(inner(P, D), fourth_order, 1e-6 * eigen(P).norm() * eigen(D).norm()) << g.F;
      }
  });
}

TEST(Materials, StressChangeIsTheDerivativeOfTheStress) {
  for_each_material([](auto material) {
    using M = decltype(material);
    for (const Gradient& g : gradients(M::survives_inversion))
      for (const Mat3<double>& D : directions()) {
        const Mat3<double> F = mat3<double>(g.F);
        const double h = 1e-4 * g.smallest;
        const auto slope = [&](double t) -> Eigen::Matrix3d {
          return eigen(M::stress(F + t * D, soft) - M::stress(F - t * D, soft)) / (2 * t);
        };
        const Eigen::Matrix3d fourth_order = (4 * slope(h / 2) - slope(h)) / 3;
        const Eigen::Matrix3d dP = eigen(M::stress_change(F, D, soft));
        EXPECT_LE((dP - fourth_order).norm(), 1e-6 * dP.norm()) << g.F;
      }
  });
}

TEST(Materials, TangentIsSymmetric) {
  for_each_material([](auto material) {
    using M = decltype(material);
    const auto d = directions();
    for (const Gradient& g : gradients(M::survives_inversion)) {
      const Mat3<double> F = mat3<double>(g.F), A = M::stress_change(F, d[0], soft),
                         B = M::stress_change(F, d[1], soft);
      EXPECT_NEAR(inner(A, d[1]), inner(B, d[0]),
                  round_off<double>(1e5, (eigen(A).norm() + eigen(B).norm()) * eigen(d[0]).norm()))
          << g.F;
    }
  });
}

template <class Real>
void expect_rest() {
  for_each_material([](auto material) {
    using M = decltype(material);
    const Lame<Real> c{static_cast<Real>(soft.lambda), static_cast<Real>(soft.mu)};
    EXPECT_NEAR(static_cast<double>(M::energy(Mat3<Real>::identity(), c)), 0, round_off<Real>(16, soft.lambda));
    const Mat3<Real> P = M::stress(Mat3<Real>::identity(), c);
    for (int r = 0; r < 3; ++r)
      for (int k = 0; k < 3; ++k)
        EXPECT_NEAR(static_cast<double>(P[r][k]), 0, round_off<Real>(16, soft.lambda)) << r << k;
  });
}

TEST(Materials, RestIsFreeOfStress) {
  expect_rest<double>();
  expect_rest<float>();
}

TEST(Materials, AreHookesLawAtRest) {
  for_each_material([](auto material) {
    using M = decltype(material);
    for (const Mat3<double>& D : directions()) {
      const Eigen::Matrix3d e = 0.5 * eigen(D + transpose(D));
      const Eigen::Matrix3d want = 2 * soft.mu * e + soft.lambda * e.trace() * Eigen::Matrix3d::Identity();
      EXPECT_LE((eigen(M::stress_change(Mat3<double>::identity(), D, soft)) - want).norm(),
                round_off<double>(1e3, want.norm()));
    }
  });
}

TEST(Materials, RotationTurnsTheStressWithIt) {
  std::mt19937 random(5);
  for_each_material([&](auto material) {
    using M = decltype(material);
    if (!M::rotation_invariant) return;
    for (const Gradient& g : gradients(M::survives_inversion)) {
      const Eigen::Matrix3d R = random_rotation(random), RF = R * g.F;
      const double E = M::energy(mat3<double>(g.F), soft), turned = M::energy(mat3<double>(RF), soft);
      EXPECT_NEAR(turned, E, round_off<double>(1e4, std::abs(E)) / g.smallest) << g.F;
      const Eigen::Matrix3d P = R * eigen(M::stress(mat3<double>(g.F), soft)),
                            Q = eigen(M::stress(mat3<double>(RF), soft));
      EXPECT_LE((P - Q).norm(), round_off<double>(1e4, P.norm()) / g.smallest) << g.F;
    }
  });
}

TEST(Materials, OneThatIsNotRotationInvariantIsNot) {
  const double c = std::cos(0.3), s = std::sin(0.3);
  const Mat3<double> R = {Vec3<double>{c, -s, 0}, {s, c, 0}, {0, 0, 1}};
  const Mat3<double> P = Linear::stress(R, soft);
  const double turned = 2 * (soft.mu + soft.lambda) * (c - 1);
  EXPECT_NEAR(P[0][0], turned, round_off<double>(16, soft.lambda));
  EXPECT_NEAR(P[1][1], turned, round_off<double>(16, soft.lambda));
  EXPECT_NEAR(P[0][1], 0, round_off<double>(16, soft.lambda));
}

TEST(Materials, InvertedOnesThatSurviveStayFinite) {
  for_each_material([](auto material) {
    using M = decltype(material);
    if (!M::survives_inversion) return;
    std::vector<Eigen::Matrix3d> cases = {Eigen::Matrix3d::Zero(),
                                          -Eigen::Matrix3d::Identity(),
                                          Eigen::Vector3d(1, 1, 0).asDiagonal(),
                                          Eigen::Vector3d(1, 0, 0).asDiagonal(),
                                          Eigen::Vector3d(1, 1, -1).asDiagonal(),
                                          Eigen::Vector3d(2, 0.5, -0.5).asDiagonal()};
    for (const Eigen::Matrix3d& F : cases) {
      EXPECT_TRUE(std::isfinite(M::energy(mat3<double>(F), soft))) << F;
      EXPECT_TRUE(eigen(M::stress(mat3<double>(F), soft)).allFinite()) << F;
      EXPECT_TRUE(eigen(M::stress_change(mat3<double>(F), directions()[0], soft)).allFinite()) << F;
    }
  });
}

TEST(PolarRotation, IsTheNearestRotation) {
  for (const Gradient& g : gradients(true)) {
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(g.F, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Eigen::Vector3d sign(1, 1, (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1);
    const Eigen::Matrix3d want = svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
    const Eigen::Vector3d s = svd.singularValues();
    const double gap = (s[1] + sign[2] * s[2]) / s[0];  // how well defined it is
    EXPECT_LE((eigen(polar_rotation(mat3<double>(g.F))) - want).norm(), round_off<double>(200) / (gap * gap)) << g.F;
  }
}

}  // namespace
