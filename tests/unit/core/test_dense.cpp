// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <plica/core/dense.hpp>

namespace {

using namespace plica;
using Eigen::MatrixXd, Eigen::VectorXd;

/// Symmetric, with eigenvalues of at least `least`.
MatrixXd symmetric(int n, double least) {
  const MatrixXd A = MatrixXd::NullaryExpr(n, n, [](Eigen::Index i, Eigen::Index j) {
    return std::sin(static_cast<double>(7 * i + 3 * j * j + 1));
  });
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
  const MatrixXd before = A;
  EXPECT_FALSE(dense::invert(5, A.data()));
  EXPECT_EQ(A, before);
}

TEST(Dense, ToldOfMatricesThatAreNotFinite) {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()})
    for (const Eigen::Index column : {0, 2, 4}) {
      MatrixXd A = symmetric(5, 1);
      A(4, column) = bad;
      EXPECT_FALSE(dense::invert(5, A.data())) << bad << " " << column;
      A = symmetric(5, 1);
      MatrixXd inverse = A;
      inverse(0, 4) = bad;  // of the upper half, which is not read
      ASSERT_TRUE(dense::invert(5, inverse.data()));
      EXPECT_LT((A * inverse - MatrixXd::Identity(5, 5)).norm(), 1e-9 * A.norm());
    }
}

/// M times the 3x3 unit matrix.
MatrixXd on_vectors(const MatrixXd& M) {
  MatrixXd full = MatrixXd::Zero(3 * M.rows(), 3 * M.cols());
  for (Eigen::Index i = 0; i < M.rows(); ++i)
    for (Eigen::Index j = 0; j < M.cols(); ++j)
      full.block<3, 3>(3 * i, 3 * j).diagonal().setConstant(M(i, j));
  return full;
}

TEST(Dense, Modes) {
  const int n = 20;
  const MatrixXd K = symmetric(3 * n, 0), M = symmetric(n, 1), full = on_vectors(M);
  VectorXd s(3 * n);
  MatrixXd phi(3 * n, 3 * n), back(3 * n, 3 * n);
  ASSERT_EQ(dense::modes(n, K.data(), M.data(), s.data(), phi.data()), 3 * n);
  EXPECT_LT((K * phi - full * phi * s.asDiagonal()).norm(), 1e-9 * K.norm());
  EXPECT_LT((phi.transpose() * full * phi - MatrixXd::Identity(3 * n, 3 * n)).norm(), 1e-9);
  for (int i = 1; i < 3 * n; ++i) EXPECT_LE(s[i - 1], s[i]);
  const VectorXd ones = VectorXd::Ones(3 * n);
  dense::recompose(3 * n, 3 * n, ones.data(), phi.data(), back.data());  // phi phi^T = M^-1
  EXPECT_LT((back * full - MatrixXd::Identity(3 * n, 3 * n)).norm(), 1e-9 * full.norm());
}

// A function twice, and one that is nothing: what is left is the problem without them.
TEST(Dense, ModesLeaveOutWhatHasNoMassOfItsOwn) {
  const int n = 6;
  const MatrixXd K = symmetric(3 * n, 0), M = symmetric(n, 1);
  MatrixXd repeat = MatrixXd::Zero(n, n + 2);
  repeat.leftCols(n).setIdentity();
  repeat(2, n) = 1;
  const MatrixXd wide = on_vectors(repeat), more_K = wide.transpose() * K * wide,
                 more_M = repeat.transpose() * M * repeat;
  VectorXd s(3 * n), more_s(3 * n + 6);
  MatrixXd phi(3 * n, 3 * n), more_phi(3 * n + 6, 3 * n + 6);
  ASSERT_EQ(dense::modes(n, K.data(), M.data(), s.data(), phi.data()), 3 * n);
  ASSERT_EQ(dense::modes(n + 2, more_K.data(), more_M.data(), more_s.data(), more_phi.data()),
            3 * n);
  EXPECT_LT((more_s.head(3 * n) - s).norm(), 1e-7 * s.norm());
}

}  // namespace
