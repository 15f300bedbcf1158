// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <plica/kernels/materials/positive_tangent.hpp>

#include "support/gradients.hpp"
#include "support/tolerance.hpp"

// dP/dF of every registered material, as it is and projected.
namespace {

using namespace plica;
using namespace plica::test;

using Matrix9 = Eigen::Matrix<double, 9, 9>;

/// dP/dF in the order of F's entries, row by row.
template <class Material>
Matrix9 change_matrix(const Mat3<double>& F) {
  Matrix9 C;
  for (int j = 0; j < 9; ++j) {
    Mat3<double> dF;
    dF[j / 3][j % 3] = 1;
    const Mat3<double> dP = Material::stress_change(F, dF, sample_constants<Material>());
    for (int i = 0; i < 9; ++i) C(i, j) = dP[i / 3][i % 3];
  }
  return 0.5 * (C + C.transpose());
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

template <class Tangent>
void expect_blocks(const Tangent& tangent, const Matrix9& C) {
  const Eigen::Vector3d p(0.3, -1.2, 0.7), q(1.1, 0.4, -0.6);
  const auto corner = [&](const Eigen::Vector3d& g) { return tangent.corner({g[0], g[1], g[2]}); };
  const Eigen::Matrix3d want = contracted(C, p, q);
  EXPECT_LE((eigen(tangent.block(corner(p), corner(q))) - want).norm(), round_off<double>(1e4, C.norm()));
  EXPECT_LE((eigen(tangent.block(corner(q), corner(p))) - want.transpose()).norm(), round_off<double>(1e4, C.norm()));
}

TEST(Tangents, BlocksAreTheirContractions) {
  Materials::for_each([](auto material) {
    using M = decltype(material);
    SCOPED_TRACE(M::name);
    for (const Gradient& g : gradients(M::survives_inversion)) {
      const Mat3<double> F = mat3<double>(g.F);
      expect_blocks(typename M::template Tangent<double>(F, sample_constants<M>()), change_matrix<M>(F));
      const typename PositiveTangent<M>::template Of<double> projected(F, sample_constants<M>());
      expect_blocks(projected, matrix_of(projected.C));
    }
  });
}

TEST(Tangents, ProjectedOnesHaveNoNegativeEigenvalueAndKeepTheOthers) {
  int projected = 0, kept = 0;
  Materials::for_each([&](auto material) {
    using M = decltype(material);
    SCOPED_TRACE(M::name);
    for (const Gradient& g : gradients(M::survives_inversion)) {
      const Mat3<double> F = mat3<double>(g.F);
      const Matrix9 C = change_matrix<M>(F);
      const Eigen::SelfAdjointEigenSolver<Matrix9> exact(C);
      const Matrix9 want =
          exact.eigenvectors() * exact.eigenvalues().cwiseMax(0).asDiagonal() * exact.eigenvectors().transpose();
      const Matrix9 got = matrix_of(typename PositiveTangent<M>::template Of<double>(F, sample_constants<M>()).C);
      EXPECT_LE((got - want).norm(), round_off<double>(1e3, C.norm())) << g.F;
      (exact.eigenvalues().minCoeff() < -1e-9 * C.norm() ? projected : kept) += 1;
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
      for (int k = 0; k < 9; ++k) F[k / 3][k % 3].set(l, list[first + static_cast<std::size_t>(l)].F(k / 3, k % 3));
    const PositiveTangent<StVenantKirchhoff>::Of<T> packed(F, {T(soft.lambda), T(soft.mu)});
    for (int l = 0; l < 4; ++l) {
      const PositiveTangent<StVenantKirchhoff>::Of<double> single(
          mat3<double>(list[first + static_cast<std::size_t>(l)].F), soft);
      const Matrix9 want = matrix_of(single.C);
      for (int k = 0; k < 81; ++k)
        EXPECT_NEAR(packed.C.a[k / 9][k % 9][l], want(k / 9, k % 9), round_off<double>(1e3, want.norm()));
    }
  }
}

}  // namespace
