// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <plica/core/dense.hpp>

namespace {

using namespace plica;
using Eigen::MatrixXd, Eigen::VectorXd;

/// Symmetric, with eigenvalues of at least `least`.
MatrixXd symmetric(int n, double least) {
  const MatrixXd A = MatrixXd::NullaryExpr(
      n, n, [](Eigen::Index i, Eigen::Index j) { return std::sin(static_cast<double>(7 * i + 3 * j * j + 1)); });
  return A * A.transpose() + least * MatrixXd::Identity(n, n);
}

// Sizes around those of vector registers and of Eigen's blocks.
TEST(Dense, Inverses) {
  for (const int n : {1, 3, 17, 150}) {
    const MatrixXd A = symmetric(n, 1);
    MatrixXd inverse = A;
    ASSERT_TRUE(dense::invert(n, inverse.data()));
    EXPECT_LT((A * inverse - MatrixXd::Identity(n, n)).norm(), 1e-9 * A.norm()) << n;
  }
}

TEST(Dense, ToldOfMatricesThatAreNotPositiveDefinite) {
  MatrixXd A = symmetric(5, 1);
  A(3, 3) = -1;
  EXPECT_FALSE(dense::invert(5, A.data()));
}

TEST(Dense, Eigenvectors) {
  const int n = 60;
  const MatrixXd K = symmetric(n, 0), M = symmetric(n, 1);
  VectorXd s(n);
  MatrixXd phi(n, n), back(n, n);
  dense::eigenvectors(n, K.data(), M.data(), s.data(), phi.data());
  EXPECT_LT((K * phi - M * phi * s.asDiagonal()).norm(), 1e-9 * K.norm());
  EXPECT_LT((phi.transpose() * M * phi - MatrixXd::Identity(n, n)).norm(), 1e-9);
  for (int i = 1; i < n; ++i) EXPECT_LE(s[i - 1], s[i]);
  const VectorXd ones = VectorXd::Ones(n);
  dense::recompose(n, ones.data(), phi.data(), back.data());  // phi phi^T = M^-1
  EXPECT_LT((back * M - MatrixXd::Identity(n, n)).norm(), 1e-9 * M.norm());
}

}  // namespace
