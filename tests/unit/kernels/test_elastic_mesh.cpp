// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <plica/drivers/elastic/materials.hpp>
#include <plica/drivers/study/level_probe.hpp>
#include <plica/kernels/elastic/damping_stress.hpp>
#include <plica/kernels/materials/positive_tangent.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/gradients.hpp"
#include "support/tolerance.hpp"

// The element kernels on a whole irregular mesh, in every material.
namespace {

using namespace plica;
using namespace plica::test;

std::vector<Point> affine(const TetMesh& mesh, const Eigen::Matrix3d& F, const Point& shift) {
  std::vector<Point> u;
  for (const Point& X : mesh.vertices) u.push_back(F * X + shift - X);
  return u;
}

// a soft material's force on a face of one cell at a strain of one
double force_size(const Problem& p) { return p.body.material.young_modulus * 0.03 * 0.03; }

TEST(ElasticMesh, ForceIsMinusTheGradientOfTheEnergy) {
  for_each_material_name([](const std::string& material) {
    const Problem problem = small_cube(material);
    LevelProbe<Host> probe(problem);
    const auto u = random_field(probe.vertices(), 0.003, 1),
               p = random_field(probe.vertices(), 0.003, 2);
    const double h = 1e-3,
                 slope = (probe.elastic_energy(along(u, h, p)) -
                          probe.elastic_energy(along(u, -h, p))) /
                         (2 * h),
                 half = (probe.elastic_energy(along(u, h / 2, p)) -
                         probe.elastic_energy(along(u, -h / 2, p))) /
                        h;
    const double work = -dot(probe.force(u), p);
    EXPECT_NEAR(work, (4 * half - slope) / 3, 1e-6 * std::abs(work));
  });
}

TEST(ElasticMesh, TangentIsMinusTheDerivativeOfTheForce) {
  for_each_material_name([](const std::string& material) {
    LevelProbe<Host> probe(small_cube(material));
    const auto u = random_field(probe.vertices(), 0.003, 1),
               p = random_field(probe.vertices(), 0.003, 2);
    const auto slope = [&](double h) {
      auto d = minus(probe.force(along(u, -h, p)), probe.force(along(u, h, p)));
      for (Point& x : d) x /= 2 * h;
      return d;
    };
    const auto Kp = probe.stiffness(u, p);
    auto want = slope(1e-3);
    const auto half = slope(5e-4);
    for (std::size_t a = 0; a < want.size(); ++a) want[a] = (4 * half[a] - want[a]) / 3;
    EXPECT_LE(largest_difference(Kp, want), 1e-6 * largest(Kp));
  });
}

TEST(ElasticMesh, StiffnessIsSymmetricAndItsBlocksAreTheDiagonals) {
  for_each_material_name([](const std::string& material) {
    const Problem problem = small_cube(material, 2);
    LevelProbe<Host> probe(problem);
    const auto u = random_field(probe.vertices(), 0.002, 1);
    const Eigen::MatrixXd K = probe.stiffness_matrix(u);
    EXPECT_LE((K - K.transpose()).cwiseAbs().maxCoeff(),
              round_off<Host::Real>(1e3, K.cwiseAbs().maxCoeff()));

    State<Host> state;
    state.u = device_field<Host>(u), state.v = device_field<Host>(probe.zero());
    const Blocks<Host> blocks("test.blocks", probe.vertices());
    const double h = 0.01;
    probe.at(0).diagonal(state, {h * h, h}, false, blocks);
    const auto m = probe.mass();
    for (Eigen::Index a = 0; a < static_cast<Eigen::Index>(m.size()); ++a) {
      const Eigen::Matrix3d A = h * h * K.block<3, 3>(3 * a, 3 * a) +
                                m[static_cast<std::size_t>(a)] * Eigen::Matrix3d::Identity();
      Eigen::Matrix3d D;
      const auto d = [&](int k) {
        return blocks(static_cast<std::size_t>(a), static_cast<std::size_t>(k));
      };
      D << d(0), d(3), d(4), d(3), d(1), d(5), d(4), d(5), d(2);
      EXPECT_LE((D - A).norm(), 1e-12 * A.norm());
    }
  });
}

template <class B>
class ElasticMeshOn : public testing::Test {};
TYPED_TEST_SUITE(ElasticMeshOn, EachBackend);

/// P of one material at F, with a body's constants.
template <class M>
Eigen::Matrix3d stress_of(const Eigen::Matrix3d& F, const Body& body) {
  const auto c =
      M::kernel_constants(parameter_values(*find_material(M::name), body.material, {}).data());
  return eigen(M::stress(mat3<double>(F), c));
}

template <class B>
void expect_forces_of(const Eigen::Matrix3d& P, const Eigen::Matrix3d& F, const Problem& problem) {
  using Real = typename B::Real;
  const TetMesh& mesh = problem.body.levels[0];
  LevelProbe<B> probe(problem);
  const auto f = probe.force(affine(mesh, F, {0.01, 0.02, -0.03}));
  Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
  int inner = 0;
  const double size = P.norm() * 0.025 * 0.025;
  for (std::size_t a = 0; a < f.size(); ++a) {
    moment -= f[a] * mesh.vertices[a].transpose();
    if (on_boundary(decimetre, mesh.vertices[a])) continue;
    ++inner;
    EXPECT_LE(f[a].norm(), round_off<Real>(200, size)) << a;
  }
  EXPECT_EQ(inner, 27);
  // the boundary's forces are those of the stress: sum f X^T = -V P
  const Eigen::Matrix3d VP = 1e-3 * P;
  EXPECT_LE((moment - VP).norm(), round_off<Real>(1000, VP.norm()));
}

TYPED_TEST(ElasticMeshOn, PatchTest) {
  std::mt19937 random(9);
  const Eigen::Matrix3d F = random_rotation(random) * Eigen::Vector3d(1.2, 0.9, 1.05).asDiagonal() *
                            random_rotation(random);
  for_each_material([&](auto material) {
    const Problem problem = small_cube(material.name, 4);
    expect_forces_of<TypeParam>(stress_of<decltype(material)>(F, problem.body), F, problem);
  });
}

template <class B>
void expect_no_force(const char* material, const Eigen::Matrix3d& R) {
  using Real = typename B::Real;
  const Problem problem = small_cube(material);
  LevelProbe<B> probe(problem);
  const auto u = affine(problem.body.levels[0], R, {0.05, -0.02, 0.01});
  EXPECT_LE(largest(probe.force(u)), round_off<Real>(200, force_size(problem)));
  EXPECT_NEAR(probe.elastic_energy(u), 0, round_off<Real>(200, 20e3 * 1e-3));
}

TYPED_TEST(ElasticMeshOn, RigidMotionHasNoForce) {
  std::mt19937 random(11);
  for_each_material([&](auto material) {
    const bool turns = decltype(material)::rotation_invariant;
    expect_no_force<TypeParam>(material.name,
                               turns ? random_rotation(random) : Eigen::Matrix3d::Identity());
  });
}

TEST(ElasticMesh, SmallStrainFeelsARotation) {
  const Problem problem = small_cube("linear");
  const TetMesh& mesh = problem.body.levels[0];
  LevelProbe<Host> probe(problem);
  const auto c =
      lame_constants(problem.body.material.young_modulus, problem.body.material.poisson_ratio);
  const double angle = 0.4;
  const Eigen::Matrix3d R = Eigen::AngleAxisd(angle, Point::UnitZ()).toRotationMatrix();
  Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
  const auto f = probe.force(affine(mesh, R, Point::Zero()));
  for (std::size_t a = 0; a < f.size(); ++a) moment -= f[a] * mesh.vertices[a].transpose() / 1e-3;
  EXPECT_NEAR(moment(0, 0), 2 * (c.mu + c.lambda) * (std::cos(angle) - 1),
              round_off<double>(100, c.lambda));
  EXPECT_NEAR(moment(2, 2), 2 * c.lambda * (std::cos(angle) - 1), round_off<double>(100, c.lambda));
  EXPECT_NEAR(moment(0, 1), 0, round_off<double>(100, c.lambda));
}

TYPED_TEST(ElasticMeshOn, AgreesWithDouble) {
  using Real = typename TypeParam::Real;
  for_each_material_name([](const std::string& material) {
    const Problem problem = small_cube(material, 5);  // several patches
    LevelProbe<TypeParam> probe(problem);
    LevelProbe<Host> reference(problem);
    EXPECT_GT(probe.at(0).model.patches.count, 1);
    const auto u = random_field(probe.vertices(), 0.001, 1),
               p = random_field(probe.vertices(), 0.001, 2);
    const auto f = reference.force(u), q = reference.stiffness(u, p);
    EXPECT_LE(largest_difference(probe.force(u), f), round_off<Real>(100, largest(f)));
    EXPECT_LE(largest_difference(probe.stiffness(u, p), q), round_off<Real>(100, largest(q)));
  });
}

TEST(ElasticMesh, LumpedMassesAddUpAndGravityIsTheirWeight) {
  Problem problem = small_cube();
  problem.body.levels[0] = with_regions(problem.body.levels[0], 0.05, "light", "heavy");
  problem.body.regions["heavy"].density = 4000;
  problem.gravity = {0, 0, -9.81};
  LevelProbe<Host> probe(problem);
  double want = 0, sum = 0;
  const TetMesh& mesh = problem.body.levels[0];
  for (std::size_t e = 0; e < mesh.tets.size(); ++e) {
    const auto x = [&](std::size_t k) {
      return mesh.vertices[static_cast<std::size_t>(mesh.tets[e][k])];
    };
    want += tet_volume(x(0), x(1), x(2), x(3)) * (mesh.region[e] == 1 ? 4000 : 1000);
  }
  const auto m = probe.mass();
  const auto f = probe.force(probe.zero());
  for (std::size_t a = 0; a < m.size(); ++a) {
    sum += m[a];
    EXPECT_LE((f[a] - m[a] * problem.gravity).norm(), round_off<double>(4, 9.81 * m[a]));
  }
  EXPECT_NEAR(sum, want, round_off<double>(100, want));
  EXPECT_NEAR(probe.built.reports[0].mass, want, round_off<double>(100, want));
}

// dP/dF of every registered material, as it is and projected, and its damping.

using Matrix9 = Eigen::Matrix<double, 9, 9>;

/// In the order of F's entries, row by row.
template <class Tangent>
Matrix9 matrix_of(const Tangent& tangent) {
  Matrix9 C;
  for (int j = 0; j < 9; ++j) {
    Mat3<double> dF;
    dF[j / 3][j % 3] = 1;
    const Mat3<double> dP = tangent(dF);
    for (int i = 0; i < 9; ++i) C(i, j) = dP[i / 3][i % 3];
  }
  return 0.5 * (C + C.transpose());
}

template <class Material>
Matrix9 change_matrix(const Mat3<double>& F) {
  return matrix_of(typename Material::template Tangent<double>(F, sample_constants<Material>()));
}

Matrix9 matrix_of(const Mat9<double>& A) {
  Matrix9 C;
  for (int i = 0; i < 9; ++i)
    for (int j = 0; j < 9; ++j) C(i, j) = A.a[i][j];
  return C;
}

/// a -> (C : a q^T) p
Eigen::Matrix3d contracted(const Matrix9& C, const Eigen::Vector3d& p, const Eigen::Vector3d& q) {
  Eigen::Matrix3d K = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 9; ++i)
    for (int j = 0; j < 9; ++j) K(i / 3, j / 3) += C(i, j) * p[i % 3] * q[j % 3];
  return K;
}

void expect_blocks(const Eigen::Matrix3d& pq, const Eigen::Matrix3d& qp, const Matrix9& C) {
  const Eigen::Matrix3d want = contracted(C, {0.3, -1.2, 0.7}, {1.1, 0.4, -0.6});
  EXPECT_LE((pq - want).norm(), round_off<double>(1e4, C.norm()));
  EXPECT_LE((qp - want.transpose()).norm(), round_off<double>(1e4, C.norm()));
}

template <class Tangent>
void expect_blocks_of(const Tangent& tangent, const Matrix9& C) {
  const auto p = tangent.corner({0.3, -1.2, 0.7}), q = tangent.corner({1.1, 0.4, -0.6});
  expect_blocks(eigen(tangent.block(p, q)), eigen(tangent.block(q, p)), C);
}

TEST(Tangents, BlocksAreTheirContractions) {
  Materials::for_each([](auto material) {
    using M = decltype(material);
    SCOPED_TRACE(M::name);
    for (const Gradient& g : gradients(M::survives_inversion)) {
      const Mat3<double> F = mat3<double>(g.F);
      expect_blocks_of(typename M::template Tangent<double>(F, sample_constants<M>()),
                       change_matrix<M>(F));
      const typename PositiveTangent<M>::template Of<double> projected(F, sample_constants<M>());
      expect_blocks_of(projected, matrix_of(projected.C));
      const DampingTangent<M, double> damping{F, sample_constants<M>()};
      expect_blocks_of(damping, matrix_of(damping));
    }
  });
}

/// Without what is negative; `least` is the lowest eigenvalue.
Matrix9 positive_part(const Matrix9& C, double& least) {
  const Eigen::SelfAdjointEigenSolver<Matrix9> exact(C);
  least = exact.eigenvalues().minCoeff();
  return exact.eigenvectors() * exact.eigenvalues().cwiseMax(0).asDiagonal() *
         exact.eigenvectors().transpose();
}

TEST(Tangents, ProjectedOnesHaveNoNegativeEigenvalueAndKeepTheOthers) {
  int projected = 0, kept = 0;
  Materials::for_each([&](auto material) {
    using M = decltype(material);
    SCOPED_TRACE(M::name);
    for (const Gradient& g : gradients(M::survives_inversion)) {
      const Mat3<double> F = mat3<double>(g.F);
      const Matrix9 C = change_matrix<M>(F);
      double least = 0;
      const Matrix9 want = positive_part(C, least);
      const Matrix9 got =
          matrix_of(typename PositiveTangent<M>::template Of<double>(F, sample_constants<M>()).C);
      EXPECT_LE((got - want).norm(), round_off<double>(1e3, C.norm())) << g.F;
      (least < -1e-9 * C.norm() ? projected : kept) += 1;
    }
  });
  EXPECT_GT(projected, 10);
  EXPECT_GT(kept, 10);
}

TEST(Tangents, PacksAreProjectedLaneByLane) {
  using T = Pack<double, 4>;
  const auto list = gradients(true);
  for (std::size_t first = 0; first + 4 <= list.size(); first += 4) {
    Mat3<T> F;
    for (int l = 0; l < 4; ++l)
      for (int k = 0; k < 9; ++k)
        F[k / 3][k % 3].set(l, list[first + static_cast<std::size_t>(l)].F(k / 3, k % 3));
    const PositiveTangent<StVenantKirchhoff>::Of<T> packed(F, {T(soft.lambda), T(soft.mu)});
    for (int l = 0; l < 4; ++l) {
      const PositiveTangent<StVenantKirchhoff>::Of<double> single(
          mat3<double>(list[first + static_cast<std::size_t>(l)].F), soft);
      const Matrix9 want = matrix_of(single.C);
      for (int k = 0; k < 81; ++k)
        EXPECT_NEAR(packed.C.a[k / 9][k % 9][l], want(k / 9, k % 9),
                    round_off<double>(1e3, want.norm()));
    }
  }
}

}  // namespace
