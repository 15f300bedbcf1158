// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <numeric>
#include <plica/core/transposed.hpp>

// Vectors scattered in memory, taken into the lanes of packs.
namespace {

using namespace plica;

template <class T, int N>
void expect_rows_in_lanes() {
  std::vector<T> memory(1 + 4 * 3 * N);  // from 1: rows need no alignment
  std::iota(memory.begin(), memory.end(), T(0));
  const auto row = [&](int l) { return memory.data() + 1 + 4 * ((5 * l + 3) % (3 * N)); };
  using Lanes = typename PackOf<T, N>::type;
  Vec3<Lanes> v;
  load_vectors(row, v);
  for (int l = 0; l < N; ++l)
    for (int k = 0; k < 3; ++k) EXPECT_EQ(lane(v[k], l), row(l)[k]) << N << " lanes, lane " << l << ", component " << k;
}

TEST(Transposed, IsWhatNumberByNumberGives) {
  expect_rows_in_lanes<double, 1>();
  expect_rows_in_lanes<double, 2>();
  expect_rows_in_lanes<double, 4>();
  expect_rows_in_lanes<double, 8>();
  expect_rows_in_lanes<float, 4>();
  expect_rows_in_lanes<float, 8>();
  expect_rows_in_lanes<float, 16>();
}

}  // namespace
