// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <gtest/gtest.h>

#include <cstring>
#include <plica/kernels/vectors.hpp>

#include "support/backends.hpp"
#include "support/tolerance.hpp"

// Work that is done again and again as a device might: teams of other sizes, in other orders.
namespace plica::test {

/// Teams of this size, in this order, until the end of the scope.
struct LikeDevice {
  LikeDevice(int team, unsigned order) { like_device::team = team, like_device::order = order; }
  ~LikeDevice() { like_device::team = 4, like_device::order = 0; }
  LikeDevice(const LikeDevice&) = delete;
  LikeDevice& operator=(const LikeDevice&) = delete;
};

/// What is in a view, in bits.
template <class View>
std::vector<double> numbers(const View& x) {
  Kokkos::fence();
  return {x.data(), x.data() + x.span()};
}

inline bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

/// work() has the same bits in any order, for teams of each size.
template <class Work>
void expect_any_order(const Work& work, int team, const std::vector<double>& want) {
  for (const double x : want) ASSERT_TRUE(std::isfinite(x));
  for (unsigned order = 0; order <= 60; ++order) {
    const LikeDevice like(team, order);
    ASSERT_TRUE(same_bits(work(), want)) << "teams of " << team << ", order " << order;
  }
}

/// And the same ones for all sizes of teams.
template <class Work>
void expect_any_order(const Work& work) {
  ASSERT_GE(Kokkos::DefaultHostExecutionSpace().concurrency(), 8);
  const std::vector<double> want = [&] {
    const LikeDevice like(1, 0);
    return work();
  }();
  for (const int team : {1, 2, 4, 8}) expect_any_order(work, team, want);
}

}  // namespace plica::test
