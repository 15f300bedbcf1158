// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <plica/core/time_functions.hpp>
#include <plica/drivers/spaces/transfer_matrix.hpp>
#include <plica/kernels/loads/boundary_conditions.hpp>
#include <plica/kernels/transfer/transfer.hpp>
#include <plica/kernels/vectors.hpp>
#include <random>

#include "support/backends.hpp"
#include "support/bodies.hpp"
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
  for (std::size_t a = 0; a < n; ++a)
    m[a] = static_cast<Real>(1 + a % 3), inverse[a] = a % 5 == 0 ? 0 : 1 / m[a];
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
    ASSERT_NEAR(static_cast<double>(got[static_cast<std::size_t>(i)]), want(i),
                2e-5 * (1 + std::abs(want(i))))
        << i;
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
  using Other =
      Backend<std::conditional_t<sizeof(typename B::Real) == 8, float, double>, typename B::Exec>;
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
  expect_values<B>(out,
                   [](int i) { return i / 3 % 5 == 0 ? ramp(i, 7) : 2 * ramp(i, 0) + ramp(i, 5); });
  weigh<B>(exec, "test", model, -1, x, 1, y, out);
  expect_values<B>(
      out, [](int i) { return i / 3 % 5 == 0 ? 0.0 : ramp(i, 5) - (1 + i / 3 % 3) * ramp(i, 0); });
}

TYPED_TEST(Vocabulary, Sums) {
  using B = TypeParam;
  const typename B::Exec exec;
  const BlockSums<B> blocks(n);
  const auto result = zeros<Doubles<B>>("test.result", 1);
  const auto x = ramp<B>(0), y = ramp<B>(-70);
  dot<B>(exec, "test", x, y, blocks, result);
  double want = 0, first = 0;
  for (int i = 0; i < 3 * n; ++i)
    want += ramp(i, 0) * ramp(i, -70), first += i % 3 == 0 ? ramp(i, -70) : 0;
  EXPECT_NEAR(host_values(exec, result)[0], want, 1e-4 * std::abs(want));
  sum_first<B>(exec, "test", y, blocks, result);  // below 0
  EXPECT_NEAR(host_values(exec, result)[0], first, 1e-4 * std::abs(first));
}

/// Sum and maximum of one number per block of a sum; its other items have none.
template <class B>
struct OnePerBlock {
  Doubles<B> number;
  KOKKOS_INLINE_FUNCTION Sums<2, 1> operator()(int i) const {
    if (i % BlockSums<B>::block != 7) return {};
    const double x = number(i / BlockSums<B>::block);
    return {{x, x > 0 ? x : 0}};
  }
};
template <class B>
struct Doubled {
  Doubles<B> result;
  KOKKOS_INLINE_FUNCTION void operator()() const { result(0) *= 2; }
};

// The blocks' sums are added without loss: by one thread or by a team, whatever they are.
TYPED_TEST(Vocabulary, AddsBlocksExactly) {
  using B = TypeParam;
  const typename B::Exec exec;
  constexpr int count = 40, items = count * BlockSums<B>::block;
  const BlockSums<B> blocks(items);
  const auto result = zeros<Doubles<B>>("test.result", 2);
  std::mt19937_64 random(6);
  const auto expect_exact = [&](const std::vector<double>& numbers) {
    ExactSum all;
    for (const double x : numbers) all.add(x);
    const double want = all.take();
    const OnePerBlock<B> term{to_device<Doubles<B>>("test.numbers", numbers)};
    reduce<B, 2, OnePerBlock<B>, Sums<2, 1>>(exec, "test", items, term, blocks, result);
    const auto plain = host_values(exec, result);
    EXPECT_EQ(std::bit_cast<std::uint64_t>(plain[0]), std::bit_cast<std::uint64_t>(want));
    if (std::isfinite(want)) {
      EXPECT_EQ(plain[1], std::max(0.0, std::ranges::max(numbers)));
    }
    reduce<B, 2, OnePerBlock<B>, Sums<2, 1>, Doubled<B>>(exec, "test", items, term, blocks, result,
                                                         {result});
    const auto followed = host_values(exec, result);
    EXPECT_EQ(std::bit_cast<std::uint64_t>(followed[0]), std::bit_cast<std::uint64_t>(2 * want));
  };
  for (const double spread : {1.0, 20.0, 200.0}) {  // the last one is wider than a team's window
    std::normal_distribution<double> exponent(0, spread), sign;
    std::vector<double> numbers(count);
    for (double& x : numbers) x = sign(random) * std::exp(exponent(random));
    expect_exact(numbers);
    for (std::size_t i = 1; i < count; i += 2) numbers[i] = -numbers[i - 1];
    numbers.back() += std::exp(-spread);
    expect_exact(numbers);
  }
  expect_exact(std::vector<double>(count, 0.0));
  expect_exact(std::vector<double>(count, std::numeric_limits<double>::denorm_min()));
  std::vector<double> with_infinity(count, 1.0);
  with_infinity[9] = -std::numeric_limits<double>::infinity();
  expect_exact(with_infinity);
}

/// Waves, of which it is noted that they were asked for.
template <class B>
struct Visited {
  Doubles<B> visits;
  int first = 0;
  KOKKOS_INLINE_FUNCTION Sums<1> operator()(int i) const {
    visits(i) += 1;
    return {{Kokkos::sin(0.3 * (i - first))}};
  }
};

// Each term is computed once; the sum over owned items is that of these items alone, bit for bit.
TYPED_TEST(Vocabulary, SumsOverOwnedItems) {
  using B = TypeParam;
  const typename B::Exec exec;
  const BlockSums<B> blocks(n);
  const auto result = zeros<Doubles<B>>("test.result", 1);
  for (const auto& [first, last] : {std::pair(0, n), std::pair(0, 600), std::pair(100, 612),
                                    std::pair(700, n), std::pair(601, 1250), std::pair(400, 400)}) {
    const auto visits = zeros<Doubles<B>>("test.visits", n);
    reduce<B, 1>(exec, "test", Items(n, first, last), Visited<B>{visits, first}, blocks, result);
    const double own = host_values(exec, result)[0];
    for (const double count : host_values(exec, visits)) EXPECT_EQ(count, 1) << first;
    EXPECT_EQ(own == 0, first == last);
    if (first == last) continue;
    reduce<B, 1>(exec, "test", last - first, Visited<B>{visits}, blocks, result);
    EXPECT_EQ(own, host_values(exec, result)[0]) << first;
  }
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

// Motions as functions of time.

Point point(const Vec3<double>& v) { return {v[0], v[1], v[2]}; }

struct Made {
  explicit Made(const Motion& motion) : path(make_path(motion, knots)) {}
  std::vector<PathKnot> knots;
  Path path;
  Point at(double t) const { return point(path_at(path, knots.data(), t).displacement); }
  Point speed(double t) const { return point(path_at(path, knots.data(), t).velocity); }
};

const PathMotion polygon{
    {{0.1, {0, 0, 0}}, {0.3, {1, 0, -2}}, {0.4, {1, 5, -2}}, {1.0, {0, 0, 0}}}};
const SineMotion sine{{0.1, 0, -0.2}, 2.5, 0.7};

TEST(Path, SteadyMotionIsSpeedTimesTime) {
  const Made made(Point(1, -2, 3));
  EXPECT_LE((made.at(0.5) - Point(0.5, -1, 1.5)).norm(), round_off<double>(4));
  EXPECT_EQ(made.speed(7), Point(1, -2, 3));
}

TEST(Path, PolygonGoesThroughItsKnotsAndRestsOutside) {
  const Made made(polygon);
  for (const auto& knot : polygon.knots)
    EXPECT_LE((made.at(knot.time) - knot.displacement).norm(), round_off<double>(16)) << knot.time;
  EXPECT_LE((made.at(0.2) - Point(0.5, 0, -1)).norm(), round_off<double>(16));
  EXPECT_LE((made.speed(0.2) - Point(5, 0, -10)).norm(), round_off<double>(64));
  for (double t : {0.0, 0.05, 1.0, 1.5, 1e6}) {
    EXPECT_EQ(made.at(t), Point::Zero()) << t;
    EXPECT_EQ(made.speed(t), Point::Zero()) << t;
  }
  const Made still(PathMotion{{{0, {1, 2, 3}}}});
  EXPECT_EQ(still.at(0), Point(1, 2, 3));
  EXPECT_EQ(still.at(9), Point(1, 2, 3));
}

TEST(Path, SineBeginsAtRestsPlaceAndComesBack) {
  const Made made(sine);
  EXPECT_EQ(made.at(0), Point::Zero());
  for (double t : {0.013, 0.2, 1.7}) {
    const double want = std::sin(2 * std::numbers::pi * 2.5 * t + 0.7) - std::sin(0.7);
    EXPECT_LE((made.at(t) - want * sine.amplitude).norm(), round_off<double>(64)) << t;
  }
  EXPECT_LE(made.at(4000).norm(), round_off<double>(1e5));  // ten thousand periods later
  const Made gentle(SineMotion{{1, 0, 0}, 3, -std::numbers::pi / 2});
  EXPECT_LE(gentle.speed(0).norm(), round_off<double>(64));
  EXPECT_NEAR(gentle.at(1.0 / 6)[0], 2, round_off<double>(64));
}

TEST(Path, SpeedIsTheSlope) {
  for (const Motion& motion :
       {Motion(SteadyMotion(Point(1, -2, 3))), Motion(polygon), Motion(sine)}) {
    const Made made(motion);
    for (double t : {0.15, 0.27, 0.33, 0.55, 0.9, 2.0}) {
      const double h = 1e-6;
      const Point slope = (made.at(t + h) - made.at(t - h)) / (2 * h);
      EXPECT_LE((slope - made.speed(t)).norm(), 1e-7) << t;
    }
  }
}

TEST(Path, AStepAheadEndsWhereThePathDoes) {
  for (const Motion& motion : {Motion(polygon), Motion(sine)}) {
    const Made made(motion);
    for (double t : {0.0, 0.25, 0.38, 0.95})
      for (double h : {1e-3, 0.1, 1.0}) {
        const PathPoint p = path_step(made.path, made.knots.data(), t, h);
        EXPECT_EQ(point(p.displacement), made.at(t));
        EXPECT_LE((point(p.displacement) + h * point(p.velocity) - made.at(t + h)).norm(),
                  round_off<double>(64));
      }
  }
}

TEST(Path, SeveralShareOneListOfKnots) {
  std::vector<PathKnot> knots;
  make_path(PathMotion{{{0, {7, 7, 7}}, {1, {8, 8, 8}}}}, knots);
  const Path second = make_path(polygon, knots);
  EXPECT_LE((point(path_at(second, knots.data(), 0.2).displacement) - Point(0.5, 0, -1)).norm(),
            round_off<double>(16));
}

TEST(Path, KnowsWhetherItMoves) {
  EXPECT_FALSE(moves({}));
  EXPECT_TRUE(moves(Point(0, 1, 0)));
  EXPECT_TRUE(moves(sine));
  EXPECT_TRUE(moves(polygon));
  EXPECT_FALSE(moves(PathMotion{{{0, {1, 2, 3}}, {1, {1, 2, 3}}}}));
  EXPECT_FALSE(moves(SineMotion{}));
}

// Rows of no, one, two ... entries; the last vector of all is among them.
TYPED_TEST(Vocabulary, RowsOfAMatrixAreSummedUp) {
  using B = TypeParam;
  using Real = typename B::Real;
  const typename B::Exec exec;
  // ascending, to n - 1
  const auto entry = [](int row, int i) { return n - 1 - 3 * (row % 12 - 1 - i); };
  const auto weight = [](int row, int i) {
    return static_cast<float>(1 + row % 7) / static_cast<float>(2 + i);
  };
  RowMatrix A(n, n);
  for (int row = 0; row < n; ++row)
    for (int i = 0; i < row % 12; ++i)
      A.insert(row, entry(row, i)) = static_cast<double>(weight(row, i));
  const Vectors<B> x = ramp<B>(1), y = zeros<Vectors<B>>("test.y", n);
  update_vertices<B>(exec, "test", n,
                     MultiplyRows<B, float>{sparse_rows<B, float>("test", A), x, y});
  expect_values<B>(y, [&](int i) {
    double sum = 0;
    for (int s = 0; s < i / 3 % 12; ++s)
      sum += static_cast<double>(weight(i / 3, s)) *
             static_cast<double>(static_cast<Real>(ramp(3 * entry(i / 3, s) + i % 3, 1)));
    return sum;
  });
}

// A row that has the last vector alone, of a field of one vector, and of one of none.
TYPED_TEST(Vocabulary, RowsReadNoFurtherThanTheLastVector) {
  using B = TypeParam;
  for (const int vectors : {0, 1, 2}) {
    RowMatrix A(1, vectors);
    if (vectors > 0) A.insert(0, vectors - 1) = 2;
    const Vectors<B> x = zeros<Vectors<B>>("test.x", static_cast<std::size_t>(vectors)),
                     y = zeros<Vectors<B>>("test.y", 1);
    fill(typename B::Exec(), x, typename B::Real(3));
    update_vertices<B>({}, "test", 1, MultiplyRows<B>{sparse_rows<B>("test", A), x, y});
    Kokkos::fence();
    for (int k = 0; k < 3; ++k)
      EXPECT_EQ(static_cast<double>(y(0, k)), vectors > 0 ? 6.0 : 0.0) << vectors;
  }
}

}  // namespace
