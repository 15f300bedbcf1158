// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "support/gradients.hpp"
#include "support/tolerance.hpp"

// The lanes of a pack are independent and compute what a plain number does.
namespace {

using namespace plica;
using namespace plica::test;

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
      const Mat3<Real> F = mat3<Real>(g.F), p = M::stress(F, c), dp = M::stress_change(F, D, c);
      const double much = round_off<Real>(500, 1 / g.smallest);
      const double e = static_cast<double>(M::energy(F, c)), size = std::sqrt(static_cast<double>(inner(p, p)));
      const double change = std::sqrt(static_cast<double>(inner(dp, dp)));
      EXPECT_NEAR(static_cast<double>(E[l]), e, much * std::abs(e) + round_off<Real>(100, soft.lambda));
      for (int r = 0; r < 3; ++r)
        for (int k = 0; k < 3; ++k) {
          EXPECT_NEAR(static_cast<double>(P[r][k][l]), static_cast<double>(p[r][k]), much * size) << l;
          EXPECT_NEAR(static_cast<double>(dP[r][k][l]), static_cast<double>(dp[r][k]), much * change) << l;
        }
    }
  });
}

TEST(MaterialPacks, AgreeWithNumbersInDouble) { expect_lanes<double, 8>(); }
TEST(MaterialPacks, AgreeWithNumbersInFloat) { expect_lanes<float, 16>(); }

}  // namespace
