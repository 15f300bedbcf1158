// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <benchmark/benchmark.h>

#include <algorithm>
#include <vector>

#include "limits.hpp"

namespace plica::bench {

/// What one repetition has to do at least.
struct Cost {
  double tets = 0;  ///< element evaluations
  /// compulsory: each input read once, each output written once, no buffers of our own
  double bytes = 0;
  double flops = 0;
};

/// Repeats work(), which enqueues on `exec`. All counters are of the median repetition: a neighbour
/// on the machine disturbs some.
template <class Real, class Exec, class Work>
double measure(benchmark::State& state, const Exec& exec, const Cost& cost, const Work& work) {
  work();
  exec.fence();
  std::vector<double> times;
  for (auto _ : state) {
    const Kokkos::Timer timer;
    work();
    exec.fence();
    times.push_back(timer.seconds());
  }
  if (times.empty()) return 0;
  const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
  std::nth_element(times.begin(), middle, times.end());
  state.counters["median"] = *middle;
  if (cost.tets > 0) {
    state.counters["tets_per_second"] = cost.tets / *middle;
    state.counters["bytes_per_tet"] = cost.bytes / cost.tets;
    state.counters["flops_per_tet"] = cost.flops / cost.tets;
  }
  if (cost.bytes > 0)
    state.counters["fraction_of_limit"] = least_time<Real>(cost.bytes, cost.flops) / *middle;
  return *middle;
}

}  // namespace plica::bench
