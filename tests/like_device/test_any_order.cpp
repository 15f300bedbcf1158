// SPDX-License-Identifier: BSD-3-Clause
#include "any_order.hpp"

#include <algorithm>
#include <plica/kernels/him/inverse_mass.hpp>
#include <plica/kernels/linear/dense_inverse.hpp>
#include <plica/kernels/linear/vertex_blocks.hpp>
#include <set>

// Reductions, and what is done row by row.
namespace {

using namespace plica;
using namespace plica::test;

TEST(LikeDevice, OrdersArePermutations) {
  for (int n = 1; n < 200; n += 7)
    for (const unsigned order : {0U, 1U, 2U, 3U, 77U}) {
      const LikeDevice like(4, order);
      std::set<int> places;
      for (int i = 0; i < n; ++i) places.insert(like_device::place(i, n));
      EXPECT_EQ(static_cast<int>(places.size()), n);
      EXPECT_EQ(*places.begin(), 0);
      EXPECT_EQ(*places.rbegin(), n - 1);
    }
}

template <class B>
class InAnyOrder : public testing::Test {};
TYPED_TEST_SUITE(InAnyOrder, EachBackend);

template <class View>
View waves(std::size_t n, double shift = 0) {
  const View x("test.waves", n);
  for (std::size_t i = 0; i < x.span(); ++i)
    x.data()[i] =
        static_cast<typename View::value_type>(std::sin(1 + shift + 0.7 * static_cast<double>(i)));
  return x;
}

TYPED_TEST(InAnyOrder, HasADevicesShape) {
  using B = TypeParam;
  EXPECT_EQ(B::lanes, 1);
  EXPECT_EQ(slice_height<B>, 32);
  EXPECT_EQ(team_size<B>(128), std::min(4, typename B::Exec().concurrency()));
}

/// Two sums and the largest of a block's numbers.
template <class B>
struct Statistics {
  Vectors<B> x;
  KOKKOS_INLINE_FUNCTION Sums<3, 1> operator()(int i) const {
    const auto v = static_cast<double>(x(i, 0));
    return {{v, v * v, v < 0 ? -v : v}};
  }
};
template <class B>
struct Half {
  Doubles<B> result, half;
  KOKKOS_INLINE_FUNCTION void operator()() const {
    for (int k = 0; k < 3; ++k) half(k) = 0.5 * result(k);
  }
};

// A team of another size adds in another order, by design: that is compared to a tolerance. The
// largest number is the same.
TYPED_TEST(InAnyOrder, SumsAndLargest) {
  using B = TypeParam;
  const typename B::Exec exec;
  for (const int n : {3, 511, 513, 20000}) {
    const auto x = waves<Vectors<B>>(static_cast<std::size_t>(n));
    const BlockSums<B> blocks(n);
    const Doubles<B> result("test.result", 3), half("test.half", 3);
    for (const bool followed : {false, true}) {
      const auto work = [&] {
        if (followed)
          reduce<B, 3, Statistics<B>, Sums<3, 1>, Half<B>>(exec, "test", n, {x}, blocks, result,
                                                           {result, half});
        else
          reduce<B, 3, Statistics<B>, Sums<3, 1>>(exec, "test", n, {x}, blocks, result);
        return numbers(followed ? half : result);
      };
      std::vector<double> of_one;
      for (const int team : {1, 2, 4}) {
        std::vector<double> want;
        {
          const LikeDevice like(team, 0);
          want = work();
        }
        if (team == 1) of_one = want;
        for (std::size_t k = 0; k < 2; ++k)
          EXPECT_NEAR(want[k], of_one[k], round_off<double>(n, 8)) << n;
        EXPECT_EQ(want[2], of_one[2]);
        expect_any_order(work, team, want);
      }
    }
  }
}

TYPED_TEST(InAnyOrder, FilledFromAHash) {
  using B = TypeParam;
  const int n = 1300;
  const auto inverse_mass = waves<Scalars<B>>(n);
  const BlockSums<B> blocks(n);
  const Doubles<B> result("test.result", 1);
  const Vectors<B> x("test.x", n);
  expect_any_order([&] {
    fill_from_hash<B>({}, "test", inverse_mass, x, blocks, result);
    return numbers(x);
  });
}

// The sweeps read a row that other work items change, so that it is kept first.
TYPED_TEST(InAnyOrder, InverseOfADenseMatrix) {
  using B = TypeParam;
  const int vertices = 15, n = 3 * vertices;
  const DenseInverse<B> dense(vertices);
  const auto r = waves<Vectors<B>>(vertices);
  const Kokkos::View<typename B::Real* [4], Kokkos::LayoutRight, typename B::Memory> x("test.x",
                                                                                       vertices);
  const auto entry = [&](int i, int j) { return i == j ? 5.0 : 1.0 / (1 + i + j); };
  const auto work = [&] {
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) dense.matrix(i, j) = entry(i, j);
    for (int pivot = 0; pivot < n; ++pivot) {
      update_vertices<B>({}, "test", n, TakePivotRow<B>{dense, pivot});
      update_vertices<B>({}, "test", n, SweepRow<B>{dense, pivot});
    }
    update_vertices<B>({}, "test", n, PackInverse<B>{dense, -1});
    update_vertices<B>({}, "test", ApplyDense<B>::items(n), ApplyDense<B>{dense, r, x});
    return numbers(x);
  };
  expect_any_order(work);
  for (int i = 0; i < n; ++i) {
    double sum = 0;
    for (int j = 0; j < n; ++j) sum += entry(i, j) * static_cast<double>(x(j / 3, j % 3));
    EXPECT_NEAR(sum, static_cast<double>(r(i / 3, i % 3)), round_off<typename B::Real>(50));
  }
}

// Of 21 vertices, which are no whole number of a CPU's groups.
TYPED_TEST(InAnyOrder, AnswerOfTheCoarsestLevel) {
  using B = TypeParam;
  const int n = 21, columns = 3 * n;
  CoarseInverseMass<B> filter;
  constexpr int block = CoarseInverseMass<B>::block;
  filter.vertices = n;
  filter.matrix = waves<decltype(filter.matrix)>(
      static_cast<std::size_t>((columns + block - 1) / block * block * columns));
  filter.turned = Vectors<B>("test.turned", n), filter.rotation = waves<Vectors<B>>(3 * n);
  const auto force = waves<Vectors<B>>(n, 0.3);
  const Vectors<B> answer("test.answer", n);
  expect_any_order([&] {
    update_vertices<B>({}, "test", n, TurnForces<B>{filter, force});
    update_vertices<B>({}, "test", groups_of<B>(n), AnswerOfCoarsest<B>{filter, answer, 2});
    return numbers(answer);
  });
  const auto rotation = [&](int a, int i, int j) {
    return static_cast<double>(filter.rotation(3 * a + i, j));
  };
  for (int a = 0; a < n; ++a) {
    double product[3] = {};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < columns; ++j) {
        const int row = 3 * a + i;
        product[i] += static_cast<double>(filter.matrix(static_cast<std::size_t>(
                          row / block * columns * block + j * block + row % block))) *
                      static_cast<double>(filter.turned(j / 3, j % 3));
      }
    for (int i = 0; i < 3; ++i) {
      double want = 0;
      for (int j = 0; j < 3; ++j) want += 2 * rotation(a, i, j) * product[j];
      EXPECT_NEAR(static_cast<double>(answer(a, i)), want, round_off<typename B::Real>(200)) << a;
    }
  }
}

}  // namespace
