// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <plica/core/error.hpp>
#include <plica/drivers/solver/material_points.hpp>
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

/// S = 2 dW/dC of laws of tissue at the isochoric C, with the values that they have where nothing is given.
Matrix isochoric_stress(const std::string& material, const Matrix& C) {
  const Matrix I = Matrix::Identity();
  const Point f = Point(2, 2, 1) / 3, s = Point(-2, 1, 2) / 3, n = f.cross(s);
  const double I1 = C.trace(), I2 = (I1 * I1 - (C * C).trace()) / 2, x = I1 - 3, y = I2 - 3;
  const auto by_invariants = [&](double W1, double W2) -> Matrix { return 2 * W1 * I + 2 * W2 * (I1 * I - C); };
  if (material == "mooney_rivlin") return by_invariants(2500, 1000);
  if (material == "polynomial") return by_invariants(2500 + 2e3 * x + 500 * y, 1000 + 500 * x + 600 * y);
  if (material == "veronda_westmann") return by_invariants(7000 * std::exp(2 * x), -3500);
  if (material == "arruda_boyce") {
    const double z = I1 / 4;  // I1 / N
    return by_invariants(
        5e3 * (0.5 + z / 10 + 11 * z * z / 350 + 19 * z * z * z / 1750 + 519 * std::pow(z, 4) / 134750), 0);
  }
  if (material == "gent") return by_invariants(2500 / (1 - x / 2), 0);
  if (material == "transversely_isotropic") return 5e3 * I + 4e3 * (f.dot(C * f) - 1) * f * f.transpose();
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
    return eigen.eigenvectors() * Point(2400 * l2 - 2000 * l2.pow(-2)).asDiagonal() * eigen.eigenvectors().transpose();
  }
  ADD_FAILURE() << "no known stress of " << material;
  return Matrix::Zero();
}

/// Cauchy's stress in closed form; `R` is the rotation nearest to F.
Matrix known_stress(const std::string& material, const Matrix& F, const Matrix& R) {
  const Matrix I = Matrix::Identity(), E = (F.transpose() * F - I) / 2, e = (F + F.transpose()) / 2 - I;
  const double J = F.determinant();
  if (material == "st_venant_kirchhoff") return F * (2 * law.mu * E + law.lambda * E.trace() * I) * F.transpose() / J;
  if (material == "linear") return (2 * law.mu * e + law.lambda * e.trace() * I) * F.transpose() / J;
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
  const Matrix tau = r * r * F * isochoric_stress(material, r * r * F.transpose() * F) * F.transpose();
  return (tau - tau.trace() / 3 * I) / J + 33e3 / 2 * (J - 1 / J) * I;
}

double equivalent(const Matrix& sigma) {
  const Matrix s = (sigma + sigma.transpose()) / 2;
  return std::sqrt(1.5) * (s - s.trace() / 3 * Matrix::Identity()).norm();
}

template <class B>
void expect_everywhere(const Matrix& F, double stress, double J, const std::string& material) {
  Problem p = body_of({with_regions(jittered_box(decimetre, {3, 4, 3}), 0.05, "left", "right")}, material);
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
      expect_everywhere<TypeParam>(F, equivalent(known_stress(name, F, Matrix::Identity())), stretch, name);
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
    EXPECT_LE((motion.displacement[i] - linear(points[i])).norm(), round_off<typename TypeParam::Real>(20));
    EXPECT_LE((motion.velocity[i] - linear(2 * points[i])).norm(), round_off<typename TypeParam::Real>(20));
  }
}

TEST(MaterialPoints, OutsideGoToTheNearest) {
  const TetMesh mesh = jittered_box(decimetre, {2, 2, 2});
  const MaterialPoints<Host> watched(mesh, {{0.13, 0.04, 0.05}, {0.1, 0.02, 0.02}});
  EXPECT_LE((watched.rest()[0] - Point(0.1, 0.04, 0.05)).norm(), 1e-12);
  EXPECT_LE((watched.rest()[1] - Point(0.1, 0.02, 0.02)).norm(), 1e-12);
  EXPECT_THROW(MaterialPoints<Host>(mesh, {Point::Constant(std::nan(""))}), InputError);
}

// Rayleigh damping: its forces, what it does to motion, and what it takes from the explicit limits.

Problem two_halves(const std::string& material) {
  Problem p = body_of({with_regions(jittered_box(decimetre, {3, 3, 3}), 0.05, "left", "right")}, material);
  p.body.regions["left"] = {}, p.body.regions["right"] = {};
  return p;
}

template <class B>
class Damping : public testing::Test {};
TYPED_TEST_SUITE(Damping, EachBackend);

TYPED_TEST(Damping, ByStiffnessIsItsPartOfTheTangent) {
  for (const std::string& material : names(materials())) {
    Problem p = two_halves(material);
    const std::size_t n = p.body.levels[0].vertices.size();
    const auto u = random_field(n, 2e-3, 1), v = random_field(n, 1, 2);
    LevelProbe<TypeParam> plain(p);
    const auto elastic = plain.force(u), Kv = plain.stiffness(u, v);
    p.body.damping.stiffness = 2e-3;
    LevelProbe<TypeParam> damped(p);
    const auto f = damped.force(u, v);
    for (std::size_t a = 0; a < n; ++a)
      EXPECT_LE((f[a] - elastic[a] + 2e-3 * Kv[a]).norm(), round_off<typename TypeParam::Real>(100, largest(f)))
          << material;
  }
}

TEST(RegionDamping, IsOfItsElements) {
  Problem p = two_halves("linear");
  p.body.damping = {4, 0};
  p.body.regions["right"].damping = {10, 1e-3};
  LevelProbe<Host> probe(p);
  const auto& model = probe.at(0).model;
  const auto& x = p.body.levels[0].vertices;
  for (std::size_t a = 0; a < x.size(); ++a) {
    const double c = model.damping(static_cast<int>(a));
    if (x[a][0] < 1e-9) {
      EXPECT_NEAR(c, 4, 1e-12);
    }
    if (x[a][0] > 0.1 - 1e-9) {
      EXPECT_NEAR(c, 10, 1e-12);
    }
    EXPECT_GE(c, 4 - 1e-12);
    EXPECT_LE(c, 10 + 1e-12);
  }
  const auto v = random_field(x.size(), 1, 3), zero = probe.zero();
  const auto f = probe.force(zero, v);  // nothing but the damping of the right half
  for (std::size_t a = 0; a < x.size(); ++a)
    if (x[a][0] < 1e-9) {
      EXPECT_EQ(f[a].norm(), 0);
    }
  EXPECT_GT(largest(f), 0);
}

// The largest h with lambda_max(h^2 K + h r D) <= r^2, D the stiffness of each region times its own damping.
TEST(StiffnessDamping, LowersTheLimitAsPredicted) {
  for (const char* integrator : {"symplectic_euler", "central_difference", "rk4"}) {
    Problem p = two_halves("linear");
    p.integration.integrator = {integrator};
    const double radius = std::string(integrator) == "rk4" ? 2.78 : 2;
    const double undamped = Simulation<Host>(p).levels()[0].critical_step;
    p.body.regions["right"].damping.stiffness = 0.5 * undamped;
    LevelProbe<Host> probe(p);
    const double predicted = probe.built.reports[0].critical_step;
    const Eigen::MatrixXd K = probe.scaled_by_mass(probe.stiffness_matrix(probe.zero()));
    Eigen::MatrixXd D(3 * probe.vertices(), 3 * probe.vertices());
    std::vector<Point> v = probe.zero();
    for (Eigen::Index j = 0; j < D.cols(); ++j) {
      v[static_cast<std::size_t>(j / 3)][j % 3] = 1;
      const auto f = probe.force(probe.zero(), v);
      v[static_cast<std::size_t>(j / 3)][j % 3] = 0;
      for (Eigen::Index r = 0; r < D.rows(); ++r) D(r, j) = -f[static_cast<std::size_t>(r / 3)][r % 3];
    }
    const Eigen::MatrixXd S = predicted * predicted * K + predicted * radius * probe.scaled_by_mass(D);
    const double top =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(S, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff();
    EXPECT_LE(top, 1.001 * radius * radius) << integrator;
    EXPECT_GE(top, 0.95 * radius * radius) << integrator;
    EXPECT_LT(predicted, 0.9 * undamped) << integrator;
  }
}

// Integrators that grow undamped are stable with damping just below the predicted limit, and not well above it.
TEST(Damping, HoldsWhatGrows) {
  for (const char* integrator : {"euler", "rk2"}) {
    Problem p = small_cube("linear");
    p.body.damping.mass = 40, p.integration.substeps = {1};
    p.integration.integrator = {integrator}, p.integration.allow_unstable = true;
    const double limit = Simulation<Host>(p).levels()[0].critical_step;
    ASSERT_GT(limit, 0);
    for (const double part : {0.97, 1.5}) {
      p.integration.macro_step = part * limit;
      Simulation<Host> simulation(p);
      simulation.set_state(random_field(p.body.levels[0].vertices.size(), 1e-6, 5),
                           std::vector<Point>(p.body.levels[0].vertices.size(), Point::Zero()));
      const double before = simulation.energies().total();
      for (int n = 0; n < static_cast<int>(20 / (part * limit * 40)); ++n) simulation.step();
      EXPECT_EQ(simulation.energies().total() < before, part < 1) << integrator << " " << part;
    }
  }
}

// A mode's amplitude decays like exp(-(c + b w^2) t / 2).
TEST(Damping, DecaysAsRayleighSays) {
  for (const std::string& integrator : names(integrators())) {
    Problem p = small_cube("linear", 2);
    LevelProbe<Host> probe(p);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(
        probe.scaled_by_mass(probe.stiffness_matrix(probe.zero())));
    const double w = std::sqrt(modes.eigenvalues()[8]);  // beyond the six rigid ones
    const auto mass = probe.mass();
    std::vector<Point> shape = probe.zero();
    for (std::size_t a = 0; a < shape.size(); ++a)
      for (int k = 0; k < 3; ++k)
        shape[a][k] = 1e-4 * modes.eigenvectors()(static_cast<Eigen::Index>(3 * a) + k, 8) / std::sqrt(mass[a]);
    p.body.damping = {0.02 * w, 0.02 / w};
    p.integration.integrator = {integrator}, p.integration.allow_unstable = true;
    const double h = 5e-4 * 2 * M_PI / w;
    p.integration.macro_step = h, p.integration.implicit.relative_residual = 1e-10;
    Simulation<Host> simulation(p);
    simulation.set_state(shape, probe.zero());
    const double before = simulation.energies().total();
    for (int n = 0; n < 2000; ++n) simulation.step();  // one period
    const double decay = -std::log(simulation.energies().total() / before);
    EXPECT_NEAR(decay, 0.04 * 2 * M_PI, 0.1 * 0.04 * 2 * M_PI) << integrator;
  }
}

}  // namespace
