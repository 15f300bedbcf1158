// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <plica/core/exact_sum.hpp>
#include <random>
#include <vector>

// Sums without loss, against integers and numbers of 128 bits.
namespace {

using plica::ExactSum;

constexpr double least = std::numeric_limits<double>::denorm_min(),
                 largest = std::numeric_limits<double>::max(),
                 infinity = std::numeric_limits<double>::infinity(),
                 nan = std::numeric_limits<double>::quiet_NaN();

double sum(const std::vector<double>& terms) {
  ExactSum all;
  for (const double x : terms) all.add(x);
  return all.take();
}

std::uint64_t bits(double x) { return std::bit_cast<std::uint64_t>(x); }

/// A finite double with random bits.
double any_double(std::mt19937_64& random) {
  for (;;)
    if (const auto x = std::bit_cast<double>(random()); std::isfinite(x)) return x;
}

TEST(ExactSum, OfOneTermIsTheTerm) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 10000; ++i) {
    const double x = any_double(random);
    EXPECT_EQ(bits(sum({x})), bits(x)) << x;
  }
  for (const double x : {least, -least, std::numeric_limits<double>::min(), largest, -largest})
    EXPECT_EQ(bits(sum({x})), bits(x)) << x;
}

TEST(ExactSum, NothingIsPositiveZero) {
  EXPECT_EQ(bits(sum({})), bits(0.0));
  EXPECT_EQ(bits(sum({-0.0, -0.0})), bits(0.0));
  EXPECT_EQ(bits(sum({-1.5, 1.5})), bits(0.0));
}

#ifdef __SIZEOF_FLOAT128__
// Terms whose exponents differ by less than 50 have an exact sum in 113 bits, which is rounded
// once.
TEST(ExactSum, IsRoundedOnce) {
  __extension__ using Quad = __float128;
  std::mt19937_64 random(2);
  for (int i = 0; i < 100000; ++i) {
    const int exponent = static_cast<int>(random() % 2050) - 1074 - 52;
    std::vector<double> terms(1 + random() % 8);
    Quad exact = 0;
    for (double& x : terms) {
      x = std::ldexp(static_cast<double>(random() >> 11),
                     exponent + static_cast<int>(random() % 50));
      if (random() % 2 == 0) x = -x;
      if (!std::isfinite(x)) x = 1;
      exact += static_cast<Quad>(x);
    }
    const auto want = static_cast<double>(exact);
    EXPECT_EQ(bits(sum(terms)), bits(want + 0.0)) << want;
  }
}
#endif

// Pairs of opposite numbers over the whole range of exponents, and a rest far below their rounding
TEST(ExactSum, KeepsWhatCancellationLeaves) {
  std::mt19937_64 random(3);
  for (const double rest : {least, 3 * least, 1e-300, -7e-200, 0.1, 0.0}) {
    std::vector<double> terms{rest};
    for (int i = 0; i < 500; ++i) {
      const double x = any_double(random);
      terms.push_back(x), terms.push_back(-x);
    }
    for (int order = 0; order < 20; ++order) {
      std::shuffle(terms.begin(), terms.end(), random);
      EXPECT_EQ(bits(sum(terms)), bits(rest));
    }
  }
}

TEST(ExactSum, DoesNotDependOnTheOrder) {
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  std::vector<double> terms;
  for (int i = 0; i < 3000; ++i) terms.push_back(normal(random) * std::exp(30 * normal(random)));
  const std::uint64_t want = bits(sum(terms));
  double plain = 0;
  bool plain_differs = false;
  for (int order = 0; order < 50; ++order) {
    const double before = plain;
    std::shuffle(terms.begin(), terms.end(), random);
    EXPECT_EQ(bits(sum(terms)), want);
    plain = 0;
    for (const double x : terms) plain += x;
    plain_differs |= order > 0 && plain != before;
  }
  EXPECT_TRUE(plain_differs);
}

TEST(ExactSum, TiesGoToEven) {
  const double big = 0x1p53;
  EXPECT_EQ(sum({big, 1}), big);
  EXPECT_EQ(sum({big, 1, least}), big + 2);
  EXPECT_EQ(sum({big, 1, -least}), big);
  EXPECT_EQ(sum({big + 2, 1}), big + 4);
  EXPECT_EQ(sum({-big, -1}), -big);
  EXPECT_EQ(sum({-big, -1, -least}), -big - 2);
}

TEST(ExactSum, PassesBeyondTheRangeAndBack) {
  const double half_unit = 0x1p970;  // of the last bit of the largest double
  EXPECT_EQ(sum({largest, largest}), infinity);
  EXPECT_EQ(sum({-largest, -largest}), -infinity);
  EXPECT_EQ(sum({largest, largest, -largest}), largest);
  EXPECT_EQ(sum({largest, half_unit}), infinity);
  EXPECT_EQ(sum({largest, half_unit, -least}), largest);
  EXPECT_EQ(sum(std::vector<double>(1 << 16, least)), 0x1p-1058);
  EXPECT_EQ(sum(std::vector<double>(1 << 16, 0x1p1000)), 0x1p1016);
}

TEST(ExactSum, KnowsWhatIsNotFinite) {
  EXPECT_EQ(sum({1, infinity, -largest}), infinity);
  EXPECT_EQ(sum({-infinity, 1, -infinity}), -infinity);
  const std::uint64_t want = bits(sum({nan}));
  EXPECT_TRUE(std::isnan(std::bit_cast<double>(want)));
  EXPECT_EQ(bits(sum({infinity, 1, -infinity})), want);
  EXPECT_EQ(bits(sum({-infinity, infinity})), want);
  EXPECT_EQ(bits(sum({-nan, infinity})), want);
}

/// Sum of terms that several ranks have: their integers are added number by number.
double sum_of_parts(const std::vector<double>& terms, std::size_t parts) {
  std::vector<std::int64_t> all(ExactSum::words, 0), own(ExactSum::words);
  for (std::size_t part = 0; part < parts; ++part) {
    ExactSum some;
    for (std::size_t i = part; i < terms.size(); i += parts) some.add(terms[i]);
    some.store(own.data());
    for (std::size_t i = 0; i < own.size(); ++i) all[i] += own[i];
  }
  return ExactSum::load(all.data()).take();
}

TEST(ExactSum, IsThatOfTheIntegersOfItsParts) {
  std::mt19937_64 random(7);
  for (int i = 0; i < 2000; ++i) {
    std::vector<double> terms(random() % 40);
    for (double& x : terms) x = any_double(random);
    for (const std::size_t parts : {1u, 2u, 7u, 50u})
      EXPECT_EQ(bits(sum_of_parts(terms, parts)), bits(sum(terms)));
  }
  const std::vector<std::vector<double>> special = {{1, infinity, infinity},      {-infinity, 2},
                                                    {infinity, 0, -infinity},     {nan, 1},
                                                    {largest, largest, -largest}, {-0.0, -0.0}};
  for (const std::vector<double>& terms : special)
    for (const std::size_t parts : {1u, 2u, 3u})
      EXPECT_EQ(bits(sum_of_parts(terms, parts)), bits(sum(terms)));
}

}  // namespace
