// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/kernels/vectors.hpp>

#include "support/backends.hpp"
#include "support/tolerance.hpp"

// The vocabulary of the vertex kernels, number by number.
namespace {

using namespace plica;
using namespace plica::test;

constexpr int n = 1300;  // more than two blocks of a sum

/// x_ak = a/10 + k + shift
template <class B>
Vectors<B> ramp(double shift) {
  std::vector<std::array<typename B::Real, 3>> rows(n);
  for (int a = 0; a < n; ++a)
    for (int k = 0; k < 3; ++k)
      rows[static_cast<std::size_t>(a)][static_cast<std::size_t>(k)] =
          static_cast<typename B::Real>(0.1 * a + k + shift);
  return to_device<Vectors<B>>("test.ramp", rows);
}
double ramp(int i, double shift) { return 0.1 * (i / 3) + i % 3 + shift; }

/// Masses 1, 2, 3, 1, ...; every fifth vertex is held.
template <class B>
Model<B> masses() {
  using Real = typename B::Real;
  Model<B> model;
  std::vector<Real> m(n), inverse(n);
  for (std::size_t a = 0; a < n; ++a) m[a] = static_cast<Real>(1 + a % 3), inverse[a] = a % 5 == 0 ? 0 : 1 / m[a];
  model.vertices = n;
  model.mass = to_device<Scalars<B>>("test.mass", m);
  model.inverse_mass = to_device<Scalars<B>>("test.inverse_mass", inverse);
  return model;
}

template <class B, class Want>
void expect_values(const Vectors<B>& x, const Want& want) {
  const auto got = host_values(typename B::Exec(), x);
  ASSERT_EQ(got.size(), 3U * n);
  for (int i = 0; i < 3 * n; ++i)
    ASSERT_NEAR(static_cast<double>(got[static_cast<std::size_t>(i)]), want(i), 2e-5 * (1 + std::abs(want(i)))) << i;
}

template <class B>
class Vocabulary : public testing::Test {};
TYPED_TEST_SUITE(Vocabulary, EachBackend);

TYPED_TEST(Vocabulary, FieldsAreMadeFilledAndCopied) {
  using B = TypeParam;
  const typename B::Exec exec;
  const auto x = zeros<Vectors<B>>("test.x", n), y = zeros<Vectors<B>>("test.y", n);
  expect_values<B>(x, [](int) { return 0.0; });
  fill(exec, x, 3);
  copy(exec, y, x);
  fill(exec, x, 1);
  expect_values<B>(y, [](int) { return 3.0; });
  const auto numbers = to_device<Indices<B>>("test.numbers", std::vector<int>{4, 5, 6});
  EXPECT_EQ(host_values(exec, numbers), (std::vector<int>{4, 5, 6}));
  EXPECT_EQ(host_values(exec, Indices<B>()).size(), 0U);
}

TYPED_TEST(Vocabulary, Updates) {
  using B = TypeParam;
  const typename B::Exec exec;
  const auto x = ramp<B>(0), y = ramp<B>(5), out = zeros<Vectors<B>>("test.out", n);
  combine<B>(exec, "test", 2, x, -3, y, out);
  expect_values<B>(out, [](int i) { return 2 * ramp(i, 0) - 3 * ramp(i, 5); });
  add<B>(exec, "test", 3, y, out);
  expect_values<B>(out, [](int i) { return 2 * ramp(i, 0); });
  scale<B>(exec, "test", 0.25, out);
  expect_values<B>(out, [](int i) { return 0.5 * ramp(i, 0); });
  using Other = Backend<std::conditional_t<sizeof(typename B::Real) == 8, float, double>, typename B::Exec>;
  const auto other = zeros<Vectors<Other>>("test.other", n);
  convert(exec, "test", y, other);
  expect_values<Other>(other, [](int i) { return ramp(i, 5); });
}

TYPED_TEST(Vocabulary, UpdatesByMassLeaveHeldVertices) {
  using B = TypeParam;
  const typename B::Exec exec;
  const Model<B> model = masses<B>();
  const auto x = ramp<B>(0), y = ramp<B>(5), out = ramp<B>(7);
  combine_free<B>(exec, "test", model.inverse_mass, 2, x, 1, y, out);
  expect_values<B>(out, [](int i) { return i / 3 % 5 == 0 ? ramp(i, 7) : 2 * ramp(i, 0) + ramp(i, 5); });
  weigh<B>(exec, "test", model, -1, x, 1, y, out);
  expect_values<B>(out, [](int i) { return i / 3 % 5 == 0 ? 0.0 : ramp(i, 5) - (1 + i / 3 % 3) * ramp(i, 0); });
}

TYPED_TEST(Vocabulary, Sums) {
  using B = TypeParam;
  const typename B::Exec exec;
  const BlockSums<B> blocks(n);
  const auto result = zeros<Doubles<B>>("test.result", 1);
  const auto x = ramp<B>(0), y = ramp<B>(-70);
  dot<B>(exec, "test", x, y, blocks, result);
  double want = 0, first = 0;
  for (int i = 0; i < 3 * n; ++i) want += ramp(i, 0) * ramp(i, -70), first += i % 3 == 0 ? ramp(i, -70) : 0;
  EXPECT_NEAR(host_values(exec, result)[0], want, 1e-4 * std::abs(want));
  sum_first<B>(exec, "test", y, blocks, result);  // below 0
  EXPECT_NEAR(host_values(exec, result)[0], first, 1e-4 * std::abs(first));
}

TEST(SymmetricBlock, InverseAndProduct) {
  const SymMat3<double> A{{4, 5, 6, 1, -2, 0.5}};
  SymMat3<double> inverse;
  ASSERT_TRUE(invert_positive(A, inverse));
  const Vec3<double> x{1, 2, 3}, back = inverse * (A * x);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(back[k], x[k], 1e-14);
  EXPECT_FALSE(invert_positive(SymMat3<double>{{4, 5, 6, 1, -2, 9}}, inverse));
  EXPECT_FALSE(invert_positive(SymMat3<double>{}, inverse));
}

}  // namespace
