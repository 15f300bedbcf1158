// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/core/error.hpp>
#include <plica/drivers/elastic/materials.hpp>

#include "support/bodies.hpp"
#include "support/gradients.hpp"
#include "support/refusal.hpp"
#include "support/three_constants.hpp"
#include "support/tolerance.hpp"

// Every registered material, pointwise.
namespace {

using namespace plica;
using namespace plica::test;

std::vector<Mat3<double>> directions() {
  std::mt19937 random(17);
  std::uniform_real_distribution<double> within(-1, 1);
  std::vector<Mat3<double>> list(3);
  for (auto& D : list)
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) D[r][c] = within(random);
  return list;
}

template <class M>
void expect_stress_of_energy() {
  for (const Gradient& g : gradients(M::survives_inversion))
    for (const Mat3<double>& D : directions()) {
      const Mat3<double> F = mat3<double>(g.F);
      const double h = 1e-4 * g.smallest;
      const auto slope = [&](double t) {
        return (M::energy(F + t * D, sample_constants<M>()) -
                M::energy(F - t * D, sample_constants<M>())) /
               (2 * t);
      };
      const double fourth_order = (4 * slope(h / 2) - slope(h)) / 3;
      const Mat3<double> P = M::stress(F, sample_constants<M>());
      EXPECT_NEAR(inner(P, D), fourth_order, 1e-6 * eigen(P).norm() * eigen(D).norm()) << g.F;
    }
}

TEST(Materials, StressIsTheDerivativeOfTheEnergy) {
  for_each_material([](auto material) { expect_stress_of_energy<decltype(material)>(); });
  expect_stress_of_energy<ThreeConstants>();
}

template <class M>
void expect_change_of_stress() {
  for (const Gradient& g : gradients(M::survives_inversion))
    for (const Mat3<double>& D : directions()) {
      const Mat3<double> F = mat3<double>(g.F);
      const double h = 1e-4 * g.smallest;
      const auto slope = [&](double t) -> Eigen::Matrix3d {
        return eigen(M::stress(F + t * D, sample_constants<M>()) -
                     M::stress(F - t * D, sample_constants<M>())) /
               (2 * t);
      };
      const Eigen::Matrix3d fourth_order = (4 * slope(h / 2) - slope(h)) / 3;
      const Eigen::Matrix3d dP = eigen(M::stress_change(F, D, sample_constants<M>()));
      EXPECT_LE((dP - fourth_order).norm(), 1e-6 * dP.norm()) << g.F;
    }
}

TEST(Materials, StressChangeIsTheDerivativeOfTheStress) {
  for_each_material([](auto material) { expect_change_of_stress<decltype(material)>(); });
  expect_change_of_stress<ThreeConstants>();
}

TEST(Materials, TangentIsSymmetric) {
  for_each_material([](auto material) {
    using M = decltype(material);
    const auto d = directions();
    for (const Gradient& g : gradients(M::survives_inversion)) {
      const Mat3<double> F = mat3<double>(g.F),
                         A = M::stress_change(F, d[0], sample_constants<M>()),
                         B = M::stress_change(F, d[1], sample_constants<M>());
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
    const auto c = sample_constants_as<M, Real>();
    EXPECT_NEAR(static_cast<double>(M::energy(Mat3<Real>::identity(), c)), 0,
                round_off<Real>(16, soft.lambda));
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

template <class M>
constexpr bool isotropic = true;
template <class M>
requires(!M::isotropic) constexpr bool isotropic<M> = false;

// Those of fibres at most
template <class M>
void expect_hookes_law() {
  const Lame<double> small = M::small_strains(sample_constants<M>());
  for (const Mat3<double>& D : directions()) {
    const Eigen::Matrix3d e = 0.5 * eigen(D + transpose(D));
    const Eigen::Matrix3d want =
        2 * small.mu * e + small.lambda * e.trace() * Eigen::Matrix3d::Identity();
    const Eigen::Matrix3d dP =
        eigen(M::stress_change(Mat3<double>::identity(), D, sample_constants<M>()));
    if constexpr (isotropic<M>) {
      EXPECT_LE((dP - want).norm(), round_off<double>(1e3, want.norm()));
    } else {
      const double stiffness = dP.cwiseProduct(e).sum();
      EXPECT_GT(stiffness, 0);
      EXPECT_LT(stiffness, want.cwiseProduct(e).sum());
    }
  }
}

TEST(Materials, AreHookesLawAtRest) {
  for_each_material([](auto material) { expect_hookes_law<decltype(material)>(); });
  expect_hookes_law<ThreeConstants>();
}

// Fibres of holzapfel_gasser_ogden under the least tension
TEST(Materials, StressAtRestIsTheirTangentThere) {
  for_each_material([](auto material) {
    using M = decltype(material);
    const auto c = sample_constants<M>();
    Mat3<double> F = Mat3<double>::identity();
    if constexpr (requires { c.axis; })
      F = F + 1e-8 * (outer(c.axis[0], c.axis[0]) + outer(c.axis[1], c.axis[1]));
    for (const Mat3<double>& D : directions()) {
      const Eigen::Matrix3d S = eigen(M::stress_at_rest(D, c)),
                            dP = eigen(M::stress_change(F, D, c));
      EXPECT_LE((S - dP).norm(), 1e-6 * dP.norm());
      EXPECT_EQ(S, S.transpose());
      EXPECT_LE(eigen(M::stress_at_rest(D - transpose(D), c)).norm(),
                round_off<double>(10, dP.norm()));
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
      const double E = M::energy(mat3<double>(g.F), sample_constants<M>()),
                   turned = M::energy(mat3<double>(RF), sample_constants<M>());
      EXPECT_NEAR(turned, E, round_off<double>(1e4, std::abs(E)) / g.smallest) << g.F;
      const Eigen::Matrix3d P = R * eigen(M::stress(mat3<double>(g.F), sample_constants<M>())),
                            Q = eigen(M::stress(mat3<double>(RF), sample_constants<M>()));
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

// In a plane, in a line, in a point; reflected, and by as much as a rotation is no longer the one
// nearest
std::vector<Eigen::Matrix3d> degenerate() {
  std::vector<Eigen::Matrix3d> cases = {Eigen::Matrix3d::Zero(), -Eigen::Matrix3d::Identity()};
  const std::vector<Eigen::Vector3d> stretches = {{1, 1, 0},         {1, 0, 0},       {1, 1, -1},
                                                  {2, 0.5, -0.5},    {1e-160, 0, 0},  {1e5, 1e5, 0},
                                                  {1, 0.5, -0.4999}, {1, 1e-6, -1e-5}};
  std::mt19937 random(11);
  for (const Eigen::Vector3d& s : stretches) {
    cases.emplace_back(s.asDiagonal());
    cases.emplace_back(random_rotation(random) * s.asDiagonal() * random_rotation(random));
  }
  return cases;
}

TEST(Materials, InvertedOnesThatSurviveStayFinite) {
  for_each_material([](auto material) {
    using M = decltype(material);
    if (!M::survives_inversion) return;
    for (const Eigen::Matrix3d& F : degenerate()) {
      EXPECT_TRUE(std::isfinite(M::energy(mat3<double>(F), sample_constants<M>()))) << F;
      EXPECT_TRUE(eigen(M::stress(mat3<double>(F), sample_constants<M>())).allFinite()) << F;
      EXPECT_TRUE(eigen(M::stress_change(mat3<double>(F), directions()[0], sample_constants<M>()))
                      .allFinite())
          << F;
    }
  });
}

// Above its threshold the extended energy is the law itself, and on the way to it nothing jumps
TEST(NeoHookeanMaterial, IsTheLawAboveItsThresholdAndSmoothAcrossIt) {
  const double kappa = soft.lambda + 2 * soft.mu / 3,
               edge = std::cbrt(VolumeRatio<double>::smallest);
  for (const Gradient& g : gradients(false)) {
    const double J = g.F.determinant(), I = g.F.squaredNorm();
    if (J < VolumeRatio<double>::smallest) continue;
    const double law =
        kappa / 4 * (J * J - 1 - 2 * std::log(J)) + soft.mu / 2 * (std::pow(J, -2.0 / 3) * I - 3);
    EXPECT_NEAR(NeoHookean::energy(mat3<double>(g.F), soft), law, round_off<double>(100, kappa))
        << g.F;
  }
  for (const Eigen::Vector3d& s :
       {Eigen::Vector3d(edge, edge, edge), Eigen::Vector3d(1.2, 0.5, 0.1 / 0.6)}) {
    const Eigen::Matrix3d above = (1 + 1e-9) * Eigen::Matrix3d(s.asDiagonal()),
                          below = (1 - 1e-9) * Eigen::Matrix3d(s.asDiagonal());
    for (const Mat3<double>& D : directions()) {
      const auto P = [](const Eigen::Matrix3d& F) {
        return eigen(NeoHookean::stress(mat3<double>(F), soft));
      };
      const auto dP = [&](const Eigen::Matrix3d& F) {
        return eigen(NeoHookean::stress_change(mat3<double>(F), D, soft));
      };
      EXPECT_LE((P(above) - P(below)).norm(), 1e-6 * P(above).norm());
      EXPECT_LE((dP(above) - dP(below)).norm(), 1e-6 * dP(above).norm());
    }
  }
}

// Downhill from an F, in steps of at most a tenth, to where the stress is gone; its energy there
template <class M>
double downhill(Mat3<double>& F) {
  double energy = M::energy(F, sample_constants<M>()), step = 1e-6;
  for (int n = 0; n < 20000; ++n) {
    const Mat3<double> P = M::stress(F, sample_constants<M>());
    const double size = std::sqrt(inner(P, P));
    if (size < 1e-6 * soft.mu) break;
    step = std::min(step, 0.1 / size);
    Mat3<double> next = F - step * P;
    for (; step * size > 1e-15 &&
           M::energy(next, sample_constants<M>()) > energy - 1e-4 * step * size * size;
         next = F - step * P)
      step /= 2;
    F = next, energy = M::energy(F, sample_constants<M>()), step *= 2;
  }
  return energy;
}

// Where a material says that it recovers, no inverted or flattened element is at rest but one that
// rests: the way downhill ends in a rotation. One that says it does not has a start from which it
// does not.
TEST(Materials, RecoverWhereTheySaySo) {
  std::vector<Eigen::Matrix3d> starts;
  std::mt19937 random(23);
  std::uniform_real_distribution<double> within(-1.5, 1.5);
  for (int i = 0; i < 40; ++i) {
    Eigen::Matrix3d F = Eigen::Matrix3d::NullaryExpr([&] { return within(random); });
    starts.push_back(i % 4 == 0 ? Eigen::Matrix3d(0.05 * F) : F);
  }
  for (const Eigen::Vector3d& s :
       {Eigen::Vector3d(-1, -1, -1), Eigen::Vector3d(1, 1, -1), Eigen::Vector3d(1, 1, 0)})
    starts.push_back(
        starts.front() * 1e-3 +
        Eigen::Matrix3d(s.asDiagonal()));  // not just on the ridge between two ways out
  for_each_material([&](auto material) {
    using M = decltype(material);
    int stuck = 0;
    for (const Eigen::Matrix3d& start : starts) {
      Mat3<double> F = mat3<double>(start);
      if (downhill<M>(F) < 1e-3 * soft.mu && determinant(F) > 0) continue;
      ++stuck;
      if (M::recovers) ADD_FAILURE() << "from\n" << start << "\nto\n" << eigen(F);
    }
    EXPECT_EQ(stuck == 0, M::recovers);
  });
}

TEST(PolarRotation, IsARotationWhereSeveralAreNearest) {
  for (const Eigen::Matrix3d& F : degenerate()) {
    const Eigen::Matrix3d R = eigen(polar_rotation(mat3<double>(F)));
    EXPECT_LE((R.transpose() * R - Eigen::Matrix3d::Identity()).norm(), round_off<double>(1e3))
        << F;
    EXPECT_GT(R.determinant(), 0) << F;
    const Eigen::Vector3d s = Eigen::JacobiSVD<Eigen::Matrix3d>(F).singularValues();
    const double most = s[0] + s[1] + (F.determinant() < 0 ? -s[2] : s[2]);
    EXPECT_NEAR((R.transpose() * F).trace(), most, 1e-5 * s[0]) << F;
  }
}

TEST(PolarRotation, IsTheNearestRotation) {
  for (const Gradient& g : gradients(true)) {
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(g.F, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Eigen::Vector3d sign(1, 1,
                         (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1);
    const Eigen::Matrix3d want = svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
    const Eigen::Vector3d s = svd.singularValues();
    const double gap = (s[1] + sign[2] * s[2]) / s[0];  // how well defined it is
    EXPECT_LE((eigen(polar_rotation(mat3<double>(g.F))) - want).norm(),
              round_off<double>(200) / (gap * gap))
        << g.F;
  }
}

// The kernels' choice among laws at run time is each law, in all its volumes, on numbers and packs
TEST(TissueLaws, AreEachLaw) {
  using T = Pack<double, 4>;
  IsochoricLaws::for_each([](auto law) {
    using M = decltype(law);
    SCOPED_TRACE(M::name);
    const MaterialInfo& info = *find_material(M::name);
    for (const std::string& volume : names(volumes())) {
      MaterialOptions options;
      options.volume = volume;
      const std::vector<double> c = info.kernel_constants(parameter_values(info, options, {}));
      const auto at = [&](int k) { return c[static_cast<std::size_t>(k)]; };
      const auto one = load_constants<M, double>(at, 0);
      const auto four = load_constants<TissueLaws, T>(at, 0);
      for (const Gradient& g : gradients(true)) {
        const Mat3<double> F = mat3<double>(g.F), D = directions()[0];
        const Eigen::Matrix3d P = eigen(M::stress(F, one)), dP = eigen(M::stress_change(F, D, one)),
                              S = eigen(M::stress_at_rest(F, one));
        const Mat3<T> Fs = mat3<T>(g.F), Ps = TissueLaws::stress(Fs, four),
                      dPs = TissueLaws::stress_change(Fs, mat3<T>(eigen(D)), four),
                      Ss = TissueLaws::stress_at_rest(Fs, four);
        const double E = M::energy(F, one);
        // 2916 of ogden
        EXPECT_NEAR(TissueLaws::energy(Fs, four)[3], E, round_off<double>(5900, std::abs(E)))
            << g.F;
        for (int r = 0; r < 3; ++r)
          for (int k = 0; k < 3; ++k) {
            EXPECT_NEAR(Ps[r][k][3], P(r, k), round_off<double>(1e4, P.norm())) << g.F;
            EXPECT_NEAR(dPs[r][k][3], dP(r, k), round_off<double>(1e6, dP.norm())) << g.F;
            EXPECT_NEAR(Ss[r][k][3], S(r, k), round_off<double>(100, S.norm())) << g.F;
          }
      }
    }
  });
}

// W as published, above the threshold
TEST(TissueLaws, OgdensConventionsAreThree) {
  MaterialOptions options;
  options.terms = {{1200, 3}};
  const MaterialInfo& info = *find_material("ogden");
  const std::vector<std::pair<const char*, double>> shear = {
      {"mu_over_alpha2", 600}, {"mu_over_alpha", 1800}, {"two_mu_over_alpha2", 1200}};
  for (const auto& [convention, mu] : shear) {
    options.convention = convention;
    EXPECT_NEAR(info.small_strains(parameter_values(info, options, {})).mu, mu, 1e-9) << convention;
  }
}

// On a Pack, and where two stretches are the same, nearly so, or just not
TEST(OgdenMaterial, IsSmoothWhereStretchesMeet) {
  const auto c = sample_constants<Ogden>();
  for (const double gap : {0.0, 1e-12, 1e-9, 1e-7, 3e-6, 1e-5, 1e-3}) {
    const Eigen::Matrix3d F = Eigen::Vector3d(1.2, 1.2 * (1 + gap), 0.8).asDiagonal();
    for (const Mat3<double>& D : directions()) {
      const double h = 1e-5;
      const auto P = [&](double t) {
        return eigen(Ogden::stress(mat3<double>(Eigen::Matrix3d(F + t * eigen(D))), c));
      };
      const Eigen::Matrix3d dP = eigen(Ogden::stress_change(mat3<double>(F), D, c)),
                            slope = (P(h) - P(-h)) / (2 * h);
      EXPECT_LE((dP - slope).norm(), 1e-8 * dP.norm()) << gap;
    }
  }
}

// Along a stretch l that keeps the volume: 2 W' (l^2 - 1/l) with W' = mu/2 / (1 - x/J_m), x = I1 -
// 3, on its tangent from x = 15/16 J_m
TEST(GentMaterial, GoesOnBeyondItsLock) {
  const auto c = sample_constants<Gent>();  // mu 5 kPa, J_m 2
  const auto slope = [&](double l) {
    const Eigen::Matrix3d F = Eigen::Vector3d(l, 1 / std::sqrt(l), 1 / std::sqrt(l)).asDiagonal();
    const Mat3<double> sigma = cauchy_stress<Gent>(mat3<double>(F), c);
    return (sigma[0][0] - sigma[1][1]) / (2 * (l * l - 1 / l));
  };
  EXPECT_NEAR(slope(1.9), 2500 / (1 - (1.9 * 1.9 + 2 / 1.9 - 3) / 2), 1e-6);
  EXPECT_NEAR(slope(2), 40e3 + (2 - 1.875) * 320e3, 1e-6);     // x = 2: its lock
  EXPECT_NEAR(slope(4), 40e3 + (13.5 - 1.875) * 320e3, 1e-4);  // x = 13.5
}

}  // namespace
