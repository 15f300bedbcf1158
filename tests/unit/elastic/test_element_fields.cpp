// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <plica/core/error.hpp>
#include <plica/drivers/run/material_points.hpp>
#include <plica/drivers/study/level_probe.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/gradients.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// Stress of deformations for which it is known in closed form, for every material.
namespace {

using namespace plica;
using namespace plica::test;

using Matrix = Eigen::Matrix3d;

constexpr double young = 20e3, poisson = 0.35;
const Lame<double> law = lame_constants(young, poisson);

/// S = 2 dW/dC of laws of tissue at the isochoric C, with the values that they have where nothing
/// is given.
Matrix isochoric_stress(const std::string& material, const Matrix& C) {
  const Matrix I = Matrix::Identity();
  const Point f = Point(2, 2, 1) / 3, s = Point(-2, 1, 2) / 3, n = f.cross(s);
  const double I1 = C.trace(), I2 = (I1 * I1 - (C * C).trace()) / 2, x = I1 - 3, y = I2 - 3;
  const auto by_invariants = [&](double W1, double W2) -> Matrix {
    return 2 * W1 * I + 2 * W2 * (I1 * I - C);
  };
  if (material == "mooney_rivlin") return by_invariants(2500, 1000);
  if (material == "polynomial")
    return by_invariants(2500 + 2e3 * x + 500 * y, 1000 + 500 * x + 600 * y);
  if (material == "veronda_westmann") return by_invariants(7000 * std::exp(2 * x), -3500);
  if (material == "arruda_boyce") {
    const double z = I1 / 4;  // I1 / N
    return by_invariants(5e3 * (0.5 + z / 10 + 11 * z * z / 350 + 19 * z * z * z / 1750 +
                                519 * std::pow(z, 4) / 134750),
                         0);
  }
  if (material == "gent") return by_invariants(2500 / (1 - x / 2), 0);
  if (material == "transversely_isotropic")
    return 5e3 * I + 4e3 * (f.dot(C * f) - 1) * f * f.transpose();
  if (material == "holzapfel_gasser_ogden") {
    Matrix S = 5e3 * I;
    for (const double side : {1.0, -1.0}) {
      const Point a = std::cos(0.6) * f + side * std::sin(0.6) * s;
      const double E = std::max(a.dot(C * a) - 1, 0.0);
      S += 2e3 * E * std::exp(0.8 * E * E) * a * a.transpose();
    }
    return S;
  }
  if (material == "costa") {
    Matrix axes, b;
    axes << f, s, n;
    b << 8, 4, 3.5, 4, 3, 2.5, 3.5, 2.5, 2;
    const Matrix E = axes.transpose() * (C - I) / 2 * axes, bE = b.cwiseProduct(E);
    return 2e3 * std::exp(bE.cwiseProduct(E).sum()) * axes * bE * axes.transpose();
  }
  if (material == "ogden") {  // sum of c alpha l^(alpha - 2) n n^T
    const Eigen::SelfAdjointEigenSolver<Matrix> eigen(C);
    const Eigen::Array3d l2 = eigen.eigenvalues().array();
    return eigen.eigenvectors() * Point(2400 * l2 - 2000 * l2.pow(-2)).asDiagonal() *
           eigen.eigenvectors().transpose();
  }
  ADD_FAILURE() << "no known stress of " << material;
  return Matrix::Zero();
}

/// Cauchy's stress in closed form; `R` is the rotation nearest to F.
Matrix known_stress(const std::string& material, const Matrix& F, const Matrix& R) {
  const Matrix I = Matrix::Identity(), E = (F.transpose() * F - I) / 2,
               e = (F + F.transpose()) / 2 - I;
  const double J = F.determinant();
  if (material == "st_venant_kirchhoff")
    return F * (2 * law.mu * E + law.lambda * E.trace() * I) * F.transpose() / J;
  if (material == "linear")
    return (2 * law.mu * e + law.lambda * e.trace() * I) * F.transpose() / J;
  if (material == "corotational") {
    const Matrix U = R.transpose() * F;
    return R * (2 * law.mu * (U - I) + law.lambda * (U - I).trace() * I) * F.transpose() / J;
  }
  if (material == "neo_hookean") {  // Simo & Hughes, eq. 9.2.7
    const Matrix b = std::pow(J, -2.0 / 3) * F * F.transpose();
    const double bulk = law.lambda + 2 * law.mu / 3;
    return (bulk / 2 * (J * J - 1) * I + law.mu * (b - b.trace() / 3 * I)) / J;
  }
  const double r = std::cbrt(1 / J);
  const Matrix tau =
      r * r * F * isochoric_stress(material, r * r * F.transpose() * F) * F.transpose();
  return (tau - tau.trace() / 3 * I) / J + 33e3 / 2 * (J - 1 / J) * I;
}

double equivalent(const Matrix& sigma) {
  const Matrix s = (sigma + sigma.transpose()) / 2;
  return std::sqrt(1.5) * (s - s.trace() / 3 * Matrix::Identity()).norm();
}

template <class B>
void expect_everywhere(const Matrix& F, double stress, double J, const std::string& material) {
  Problem p =
      body_of({with_regions(jittered_box(decimetre, {3, 4, 3}), 0.05, "left", "right")}, material);
  p.body.material.poisson_ratio = poisson;
  Simulation<B> simulation(p);
  std::vector<Point> u;
  for (const Point& X : p.body.levels[0].vertices) u.push_back((F - Matrix::Identity()) * X);
  simulation.set_state(u, std::vector<Point>(u.size(), Point::Zero()));
  const ElementFields fields = simulation.element_fields();
  ASSERT_EQ(fields.von_mises.size(), p.body.levels[0].tets.size());
  ASSERT_EQ(fields.J.size(), p.body.levels[0].tets.size());
  using Real = typename B::Real;
  for (std::size_t e = 0; e < fields.J.size(); ++e) {
    EXPECT_NEAR(fields.von_mises[e], stress, round_off<Real>(500, young)) << e;
    EXPECT_NEAR(fields.J[e], J, round_off<Real>(100)) << e;
  }
}

template <class B>
class ElementFieldsOn : public testing::Test {};
TYPED_TEST_SUITE(ElementFieldsOn, EachBackend);

TYPED_TEST(ElementFieldsOn, KnownDeformations) {
  Materials::for_each([](auto material) {
    const std::string name = decltype(material)::name;
    SCOPED_TRACE(name);
    for (const double stretch : {0.8, 1.3}) {
      const Matrix F = Eigen::Vector3d(stretch, 1, 1).asDiagonal();
      expect_everywhere<TypeParam>(F, equivalent(known_stress(name, F, Matrix::Identity())),
                                   stretch, name);
    }
    const double shear = 0.4, angle = std::atan(shear / 2);
    Matrix F = Matrix::Identity(), R = Matrix::Identity();
    F(0, 1) = shear;
    R.topLeftCorner<2, 2>() << std::cos(angle), std::sin(angle), -std::sin(angle), std::cos(angle);
    expect_everywhere<TypeParam>(F, equivalent(known_stress(name, F, R)), 1, name);
  });
}

TEST(ElementFields, ShearInNumbers) {  // mu sqrt(g^4 + 3 g^2) where sigma = mu dev b
  Matrix F = Matrix::Identity();
  F(0, 1) = 0.4;
  expect_everywhere<Host>(F, law.mu * std::sqrt(std::pow(0.4, 4) + 3 * 0.16), 1, "neo_hookean");
}

TEST(ElementFields, RotationFeelsNothing) {
  std::mt19937 random(11);
  Materials::for_each([&](auto material) {
    if (decltype(material)::rotation_invariant)
      expect_everywhere<Host>(random_rotation(random), 0, 1, decltype(material)::name);
  });
}

Point linear(const Point& X) { return {0.1 + X.x(), 2 * X.y() - X.z(), 0.5 * X.x() + X.z()}; }

template <class B>
class MaterialPointsOn : public testing::Test {};
TYPED_TEST_SUITE(MaterialPointsOn, EachBackend);

TYPED_TEST(MaterialPointsOn, FollowLinearFields) {
  const TetMesh mesh = jittered_box(decimetre, {3, 3, 3});
  std::vector<Point> points = random_field(20, 0.05, 4);
  for (Point& p : points) p += Point::Constant(0.05);
  const MaterialPoints<TypeParam> watched(mesh, points);
  std::vector<Point> u, v;
  for (const Point& X : mesh.vertices) u.push_back(linear(X)), v.push_back(linear(2 * X));
  const auto motion = watched.sample({}, device_field<TypeParam>(u), device_field<TypeParam>(v));
  ASSERT_EQ(motion.displacement.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_LE((watched.rest()[i] - points[i]).norm(), round_off<double>(20, 0.1));
    EXPECT_LE((motion.displacement[i] - linear(points[i])).norm(),
              round_off<typename TypeParam::Real>(20));
    EXPECT_LE((motion.velocity[i] - linear(2 * points[i])).norm(),
              round_off<typename TypeParam::Real>(20));
  }
}

TEST(MaterialPoints, OutsideGoToTheNearest) {
  const TetMesh mesh = jittered_box(decimetre, {2, 2, 2});
  const MaterialPoints<Host> watched(mesh, {{0.13, 0.04, 0.05}, {0.1, 0.02, 0.02}});
  EXPECT_LE((watched.rest()[0] - Point(0.1, 0.04, 0.05)).norm(), 1e-12);
  EXPECT_LE((watched.rest()[1] - Point(0.1, 0.02, 0.02)).norm(), 1e-12);
  EXPECT_THROW(MaterialPoints<Host>(mesh, {Point::Constant(std::nan(""))}), InputError);
}

}  // namespace
