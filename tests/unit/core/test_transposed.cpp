// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <numeric>
#include <plica/core/transposed.hpp>

// Vectors scattered in memory, taken into the lanes of packs and back. Packs may be wider than the registers of the processor.
namespace {

using namespace plica;

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
    for (int k = 0; k < 3; ++k) EXPECT_EQ(lane(v[k], l), row(l)[k]) << N << " lanes, lane " << l << ", component " << k;
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
  EXPECT_EQ(sum, T(4 * N * (4 * N + 1) / 2)) << N << " lanes: numbers that are no row's have changed";
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
