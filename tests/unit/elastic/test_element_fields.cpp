// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SVD>
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

/// The fields of a body in a state x = F X, of linear or nodal elements.
template <class B>
ElementFields fields_of(const Matrix& F, const std::string& material, const std::string& element,
                        const std::string& pressure = "auto") {
  Problem p =
      body_of({with_regions(jittered_box(decimetre, {3, 4, 3}), 0.05, "left", "right")}, material);
  p.body.material.poisson_ratio = poisson;
  p.body.element = {element}, p.body.pressure = pressure;
  Simulation<B> simulation(p);
  std::vector<Point> u;
  for (const Point& X : p.body.levels[0].vertices) u.push_back((F - Matrix::Identity()) * X);
  simulation.set_state(u, std::vector<Point>(u.size(), Point::Zero()));
  ElementFields fields = simulation.element_fields(0, true);
  const std::size_t rows =
      element == "nodal" ? p.body.levels[0].vertices.size() : p.body.levels[0].tets.size();
  EXPECT_EQ(fields.von_mises.size(), rows);
  EXPECT_EQ(fields.J.size(), rows);
  EXPECT_EQ(fields.stress.size(), 6 * rows);
  EXPECT_EQ(fields.pressure.size(), rows);
  EXPECT_EQ(fields.principal_stretches.size(), 3 * rows);
  EXPECT_TRUE(simulation.element_fields().stress.empty());
  return fields;
}

/// The stress of a row.
Matrix stress_of(const ElementFields& fields, std::size_t row) {
  const double* const s = &fields.stress[6 * row];
  Matrix sigma;
  sigma << s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2];
  return sigma;
}

/// All fields against a state's F and its stress, of whose symmetric part they are.
template <class B>
void expect_fields(const ElementFields& fields, const Matrix& F, const Matrix& stress) {
  using Real = typename B::Real;
  const Matrix sigma = (stress + stress.transpose()) / 2;
  const double close = round_off<Real>(500, std::max(young, sigma.norm()));
  const Point stretches = Eigen::JacobiSVD<Matrix>(F).singularValues();
  for (std::size_t e = 0; e < fields.J.size(); ++e) {
    EXPECT_NEAR(fields.von_mises[e], equivalent(sigma), close) << e;
    EXPECT_NEAR(fields.J[e], F.determinant(), round_off<Real>(100)) << e;
    const Matrix written = stress_of(fields, e);
    EXPECT_LE((written - sigma).norm(), close) << e << "\n" << written << "\n" << sigma;
    EXPECT_NEAR(equivalent(written), fields.von_mises[e], close) << e;
    EXPECT_NEAR(fields.pressure[e], -sigma.trace() / 3, close) << e;
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(fields.principal_stretches[3 * e + static_cast<std::size_t>(k)], stretches[k],
                  round_off<Real>(200))
          << e;
  }
}

template <class B>
void expect_everywhere(const Matrix& F, const Matrix& stress, const std::string& material) {
  for (const char* element : {"linear", "nodal"}) {
    SCOPED_TRACE(element);
    expect_fields<B>(fields_of<B>(F, material, element), F, stress);
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
      expect_everywhere<TypeParam>(F, known_stress(name, F, Matrix::Identity()), name);
    }
    const double shear = 0.4, angle = std::atan(shear / 2);
    Matrix F = Matrix::Identity(), R = Matrix::Identity();
    F(0, 1) = shear;
    R.topLeftCorner<2, 2>() << std::cos(angle), std::sin(angle), -std::sin(angle), std::cos(angle);
    expect_everywhere<TypeParam>(F, known_stress(name, F, R), name);
  });
}

TEST(ElementFields, ShearInNumbers) {  // sigma = mu dev b: von Mises mu sqrt(g^4 + 3 g^2)
  Matrix F = Matrix::Identity(), b;
  const double g = 0.4;
  F(0, 1) = g;
  b << 1 + g * g, g, 0, g, 1, 0, 0, 0, 1;
  expect_everywhere<Host>(F, law.mu * (b - (1 + g * g / 3) * Matrix::Identity()), "neo_hookean");
  const ElementFields fields = fields_of<Host>(F, "neo_hookean", "linear");
  EXPECT_NEAR(fields.von_mises[0], law.mu * std::sqrt(std::pow(g, 4) + 3 * g * g), 1e-8);
  EXPECT_NEAR(fields.stress[3], law.mu * g, 1e-8);  // xy is the fourth, xz the last
  EXPECT_NEAR(fields.stress[5], 0, 1e-8);
  const double most = (g + std::sqrt(g * g + 4)) / 2;
  EXPECT_NEAR(fields.principal_stretches[0], most, 1e-12);
  EXPECT_NEAR(fields.principal_stretches[1], 1, 1e-12);
  EXPECT_NEAR(fields.principal_stretches[2], 1 / most, 1e-12);
}

// P F^T / J with the nominal stress P of Hooke's law. Stretched by 1.2 along x: P_xx = (lambda + 2
// mu) 0.2 acts on an area that stays, P_yy = lambda 0.2 on one that is 1.2 times as large.
TEST(ElementFields, LinearIsCauchysStress) {
  const Matrix F = Point(1.2, 1, 1).asDiagonal();
  const double along = 0.2 * (law.lambda + 2 * law.mu), across = 0.2 * law.lambda / 1.2;
  for (const char* element : {"linear", "nodal"}) {
    const ElementFields fields = fields_of<Host>(F, "linear", element);
    EXPECT_NEAR(fields.von_mises[0], along - across, 1e-8);
    EXPECT_NEAR(fields.pressure[0], -(along + 2 * across) / 3, 1e-8);
  }
}

// A body that turns takes its stress with it; the other fields stay.
TEST(ElementFields, TurnWithTheBody) {
  std::mt19937 random(5);
  Matrix F;
  F << 1.15, 0.2, -0.1, 0.05, 0.9, 0.15, -0.1, 0.1, 1.05;
  const Matrix Q = random_rotation(random);
  Materials::for_each([&](auto material) {
    if (!decltype(material)::rotation_invariant) return;
    const std::string name = decltype(material)::name;
    SCOPED_TRACE(name);
    for (const char* element : {"linear", "nodal"}) {
      const Matrix before = stress_of(fields_of<Host>(F, name, element), 0);
      EXPECT_GT(before.norm(), 100);
      expect_fields<Host>(fields_of<Host>(Q * F, name, element), Q * F, Q * before * Q.transpose());
    }
  });
}

/// S x by its definition: the mean over a vertex's tetrahedra of the means over their vertices.
std::vector<double> smooth(const TetMesh& mesh, const std::vector<double>& x) {
  std::vector<double> sum(x.size(), 0), volume(x.size(), 0);
  for (const auto& t : mesh.tets) {
    const auto X = [&](std::size_t k) { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
    const double V = tet_volume(X(0), X(1), X(2), X(3));
    double mean = 0;
    for (const int v : t) mean += x[static_cast<std::size_t>(v)] / 4;
    for (const int v : t)
      sum[static_cast<std::size_t>(v)] += V * mean, volume[static_cast<std::size_t>(v)] += V;
  }
  for (std::size_t a = 0; a < sum.size(); ++a) sum[a] /= volume[a];
  return sum;
}

/// The volume ratio of each vertex's own F, the mean of its tetrahedra's.
std::vector<double> own_volume_ratios(const TetMesh& mesh, const std::vector<Point>& u) {
  std::vector<Matrix> F(u.size(), Matrix::Zero());
  std::vector<double> volume(u.size(), 0), J;
  for (const auto& t : mesh.tets) {
    Matrix X, x;
    for (int c = 0; c < 3; ++c) {
      const auto v = static_cast<std::size_t>(t[static_cast<std::size_t>(c) + 1]),
                 o = static_cast<std::size_t>(t[0]);
      X.col(c) = mesh.vertices[v] - mesh.vertices[o], x.col(c) = X.col(c) + u[v] - u[o];
    }
    const double V = X.determinant();
    for (const int v : t) {
      F[static_cast<std::size_t>(v)] += V * x * X.inverse();
      volume[static_cast<std::size_t>(v)] += V;
    }
  }
  for (std::size_t a = 0; a < u.size(); ++a) J.push_back((F[a] / volume[a]).determinant());
  return J;
}

// Smoothed pressures, in a state of disorder. J is J~ = S J, and the other fields go with it: the
// pressure is that of lambda = 2 mu at J~, and the smoothed one of the rest.
TEST(ElementFields, SmoothedPressureIsWritten) {
  Problem p = body_of({jittered_box(decimetre, {4, 4, 4})}, "neo_hookean");
  p.body.material.poisson_ratio = 0.499, p.body.element = {"nodal"}, p.body.pressure = "smoothed";
  const TetMesh mesh = p.body.levels[0];
  const auto u = random_field(mesh.vertices.size(), 0.002, 3);
  Simulation<Host> simulation(p);
  simulation.set_state(u, std::vector<Point>(u.size(), Point::Zero()));
  const ElementFields fields = simulation.element_fields(0, true);
  const auto c = lame_constants(young, 0.499);
  const std::vector<double> own = own_volume_ratios(mesh, u), J = smooth(mesh, own);
  std::vector<double> excess;
  for (const double j : J) excess.push_back((c.lambda - 2 * c.mu) / 2 * (j - 1 / j));
  excess = smooth(mesh, excess);
  double apart = 0;
  for (std::size_t a = 0; a < J.size(); ++a) {
    apart = std::max(apart, std::abs(own[a] - J[a]));
    EXPECT_NEAR(fields.J[a], J[a], 1e-12) << a;
    const double* const l = &fields.principal_stretches[3 * a];
    EXPECT_NEAR(l[0] * l[1] * l[2], J[a], 1e-10) << a;
    const double pressure = -excess[a] - 8 * c.mu / 3 / 2 * (J[a] - 1 / J[a]);
    EXPECT_NEAR(fields.pressure[a], pressure, 1e-10 * c.lambda) << a;
    EXPECT_NEAR(fields.pressure[a], -stress_of(fields, a).trace() / 3, 1e-10 * c.lambda) << a;
    EXPECT_NEAR(fields.von_mises[a], equivalent(stress_of(fields, a)), 1e-10 * c.lambda) << a;
  }
  EXPECT_GT(apart, 0.02);
}

// Affine states have no need of smoothing: all laws that can be smoothed have their own fields.
TEST(ElementFields, SmoothedFieldsOfAffineStates) {
  Matrix F;
  F << 1.1, 0.2, -0.1, 0.05, 0.95, 0.1, 0, 0.1, 0.98;
  Materials::for_each([&](auto material) {
    using M = decltype(material);
    if (!smooths_dilatation<M>) return;
    SCOPED_TRACE(M::name);
    const Matrix plain = stress_of(fields_of<Host>(F, M::name, "nodal", "plain"), 0);
    expect_fields<Host>(fields_of<Host>(F, M::name, "nodal", "smoothed"), F, plain);
  });
}

TEST(ElementFields, RotationFeelsNothing) {
  std::mt19937 random(11);
  Materials::for_each([&](auto material) {
    if (decltype(material)::rotation_invariant)
      expect_everywhere<Host>(random_rotation(random), Matrix::Zero(), decltype(material)::name);
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
