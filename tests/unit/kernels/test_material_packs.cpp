// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/kernels/materials/list.hpp>

#include "support/gradients.hpp"
#include "support/tolerance.hpp"

// The lanes of a pack are independent and compute what a plain number does.
namespace {

using namespace plica;
using namespace plica::test;

/// What a material gives for one gradient, in double.
struct Answers {
  double energy;
  Eigen::Matrix3d stress, change;
};

void expect_close(const Answers& got, const Answers& want, double much, double least) {
  EXPECT_NEAR(got.energy, want.energy, much * std::abs(want.energy) + least);
  for (int k = 0; k < 9; ++k) {
    EXPECT_NEAR(got.stress(k), want.stress(k), much * want.stress.norm());
    EXPECT_NEAR(got.change(k), want.change(k), much * want.change.norm());
  }
}

template <class Real>
Eigen::Matrix3d in_double(const Mat3<Real>& A) {
  Eigen::Matrix3d numbers;
  for (int k = 0; k < 9; ++k) numbers(k / 3, k % 3) = static_cast<double>(A[k / 3][k % 3]);
  return numbers;
}

template <class Real, int N>
Mat3<Real> lane(const Mat3<Pack<Real, N>>& A, int l) {
  Mat3<Real> numbers;
  for (int k = 0; k < 9; ++k) numbers[k / 3][k % 3] = A[k / 3][k % 3][l];
  return numbers;
}

template <class Real, int N>
void expect_lanes() {
  using T = Pack<Real, N>;
  Materials::for_each([](auto material) {
    using M = decltype(material);
    SCOPED_TRACE(M::name);
    const auto list = gradients(M::survives_inversion);
    const auto c = sample_constants_as<M, Real>();
    const auto cs = sample_constants_as<M, T>();
    Mat3<T> Fs;
    for (int l = 0; l < N; ++l) {
      const auto F = mat3<Real>(list[static_cast<std::size_t>(l) % list.size()].F);
      for (int r = 0; r < 3; ++r)
        for (int k = 0; k < 3; ++k) Fs[r][k].set(l, F[r][k]);
    }
    const Mat3<Real> D = mat3<Real>(list[1].F);
    const Mat3<T> Ds = mat3<T>(list[1].F), P = M::stress(Fs, cs), dP = M::stress_change(Fs, Ds, cs);
    const T E = M::energy(Fs, cs);
    for (int l = 0; l < N; ++l) {
      const Gradient& g = list[static_cast<std::size_t>(l) % list.size()];
      const Mat3<Real> F = mat3<Real>(g.F);
      expect_close({static_cast<double>(E[l]), in_double(lane(P, l)), in_double(lane(dP, l))},
                   {static_cast<double>(M::energy(F, c)), in_double(M::stress(F, c)),
                    in_double(M::stress_change(F, D, c))},
                   round_off<Real>(500, 1 / g.smallest), round_off<Real>(100, soft.lambda));
    }
  });
}

TEST(MaterialPacks, AgreeWithNumbersInDouble) { expect_lanes<double, 8>(); }
TEST(MaterialPacks, AgreeWithNumbersInFloat) { expect_lanes<float, 16>(); }

}  // namespace
