// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <numeric>
#include <plica/core/functions.hpp>
#include <plica/core/small.hpp>
#include <plica/core/transposed.hpp>
#include <random>

#include "support/tolerance.hpp"

namespace {

using namespace plica;

using test::round_off;

Eigen::Matrix3d eigen(const Mat3<double>& A) {
  Eigen::Matrix3d m;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) m(r, c) = A[r][c];
  return m;
}

Mat3<double> random_matrix(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> within(-1, 1);
  Mat3<double> A;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) A[r][c] = within(random);
  return A;
}

TEST(Small, AgreesWithEigen) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Mat3<double> A = random_matrix(seed), B = random_matrix(100 + seed);
    const Eigen::Matrix3d a = eigen(A), b = eigen(B);
    const Vec3<double> x = A[0], y = B[1];
    const Point ex = a.row(0), ey = b.row(1), Ax = a * ex, xy = ex.cross(ey);
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR((A * x)[k], Ax[k], round_off<double>(8));
      EXPECT_NEAR(cross(x, y)[k], xy[k], round_off<double>(8));
    }
    EXPECT_NEAR((eigen(A * B) - a * b).norm(), 0, round_off<double>(16));
    EXPECT_NEAR((eigen(transpose(A)) - a.transpose()).norm(), 0, 0);
    EXPECT_NEAR(determinant(A), a.determinant(), round_off<double>(16));
    EXPECT_NEAR(inner(A, B), (a.array() * b.array()).sum(), round_off<double>(16));
    EXPECT_NEAR(trace(A), a.trace(), round_off<double>(8));
    EXPECT_NEAR(
        (eigen(cofactor(A)).transpose() * a - a.determinant() * Eigen::Matrix3d::Identity()).norm(),
        0, round_off<double>(64));
  }
}

TEST(Small, CofactorChangeIsItsDerivative) {
  const Mat3<double> A = random_matrix(1), D = random_matrix(2);
  // the cofactor is quadratic: central differences are exact but for rounding
  const double h = 1e-4;
  const Mat3<double> difference = (1 / (2 * h)) * (cofactor(A + h * D) - cofactor(A - h * D));
  EXPECT_NEAR((eigen(difference) - eigen(cofactor_change(A, D))).norm(), 0,
              round_off<double>(64, 1 / h));
}

template <class Real>
void expect_cube_roots() {
  for (double x : {1e-30, 1e-12, 1e-3, 0.3, 0.999, 1.0, 1.7, 8.0, 12345.0, 1e12, 1e30}) {
    const double got = static_cast<double>(inverse_cube_root(static_cast<Real>(x))),
                 want = 1 / std::cbrt(x);
    EXPECT_NEAR(got, want, round_off<Real>(8, want)) << x;
  }
  for (Real x : {Real(0), Real(-1), Real(-1e-20)})
    EXPECT_TRUE(std::isnan(inverse_cube_root(x))) << x;
}

TEST(Functions, InverseCubeRootToRounding) {
  expect_cube_roots<double>();
  expect_cube_roots<float>();
}

TEST(Functions, PacksAgreeWithNumbersLaneByLane) {
  Pack<double, 4> a, b;
  for (int i = 0; i < 4; ++i) a.set(i, 0.3 + 1.7 * i), b.set(i, 2.1 - i);
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ((a + b)[i], a[i] + b[i]);
    EXPECT_EQ((a - b)[i], a[i] - b[i]);
    EXPECT_EQ((a * b)[i], a[i] * b[i]);
    EXPECT_EQ((a / b)[i], a[i] / b[i]);
    EXPECT_EQ((-b)[i], 0.0 - b[i]);
    EXPECT_EQ(sqrt(a)[i], std::sqrt(a[i]));
    EXPECT_EQ(log(a)[i], std::log(a[i]));
    EXPECT_EQ(max(a, b)[i], std::max(a[i], b[i]));
    EXPECT_NEAR(inverse_cube_root(a)[i], inverse_cube_root(a[i]), round_off<double>(2, a[i]));
  }
}

TEST(Functions, MaxKeepsNaN) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isnan(max(nan, 1.0)));
  EXPECT_TRUE(std::isnan(max(Pack<double, 2>(nan), Pack<double, 2>(1.0))[1]));
}

// One lane that is 0, negative or no number is enough, wherever it is
TEST(Functions, AllPositiveLooksAtEveryLane) {
  Pack<float, 16> a(1e-30F);
  EXPECT_TRUE(all_positive(a));
  for (const float bad : {0.0F, -1e-30F, std::numeric_limits<float>::quiet_NaN()})
    for (int i = 0; i < 16; ++i) {
      auto b = a;
      b.set(i, bad);
      EXPECT_FALSE(all_positive(b)) << bad << " " << i;
    }
}

// Vectors scattered in memory, taken into the lanes of packs and back. Packs may be wider than the
// registers of the processor.

template <class T, int N>
struct Rows {
  std::vector<T> memory = std::vector<T>(1 + 4 * 3 * N);  // from 1: rows need no alignment
  T* operator()(int l) { return memory.data() + 1 + 4 * ((5 * l + 3) % (3 * N)); }
};

template <class T, int N>
void expect_rows_in_lanes() {
  Rows<T, N> rows;
  std::iota(rows.memory.begin(), rows.memory.end(), T(0));
  const auto row = [&](int l) { return rows(l); };
  using Lanes = typename PackOf<T, N>::type;
  Vec3<Lanes> v;
  load_vectors(row, v);
  for (int l = 0; l < N; ++l)
    for (int k = 0; k < 3; ++k)
      EXPECT_EQ(lane(v[k], l), row(l)[k]) << N << " lanes, lane " << l << ", component " << k;
}

template <class T, int N>
void expect_lanes_in_rows() {
  Rows<T, N> rows;
  using Lanes = typename PackOf<T, N>::type;
  Lanes four[4];
  for (int k = 0; k < 4; ++k)
    for (int l = 0; l < N; ++l) set_lane(four[k], l, T(1 + 4 * l + k));
  store_fours(four, [&](int l) { return rows(l); });
  T sum = 0;
  for (const T& x : rows.memory) sum += x;
  EXPECT_EQ(sum, T(4 * N * (4 * N + 1) / 2))
      << N << " lanes: numbers that are no row's have changed";
  for (int l = 0; l < N; ++l)
    for (int k = 0; k < 4; ++k)
      EXPECT_EQ(rows(l)[k], T(1 + 4 * l + k)) << N << " lanes, lane " << l << ", number " << k;
}

template <class T, int... N>
void expect_both_ways() {
  (expect_rows_in_lanes<T, N>(), ...);
  (expect_lanes_in_rows<T, N>(), ...);
}

TEST(Transposed, IsWhatNumberByNumberGives) {
  expect_both_ways<double, 1, 2, 4, 8, 16>();
  expect_both_ways<float, 1, 2, 4, 8, 16>();
}

}  // namespace
