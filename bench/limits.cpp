// SPDX-License-Identifier: BSD-3-Clause
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <plica/drivers/study/machine_limits.hpp>

#include "limits.hpp"
#include "suites.hpp"

namespace plica::bench {

double triad_bandwidth(double footprint) {
  static std::map<int, double> known;  // by the binary logarithm of the footprint, to a quarter
  const int step = static_cast<int>(std::lround(4 * std::log2(std::max(footprint, 4096.0))));
  const auto [found, is_new] = known.try_emplace(step);
  if (is_new) found->second = plica::triad_bandwidth(std::exp2(step / 4.0));
  return found->second;
}

template <class Real>
double fma_peak() {
  static const double peak = plica::fma_peak<Real>();
  return peak;
}
template double fma_peak<float>();
template double fma_peak<double>();

void register_limits() {
  const auto show = [](const std::string& name, const char* counter, double (*measure)(double),
                       double argument) {
    benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
      double value = 0;
      for (auto _ : state) value = measure(argument);
      state.counters[counter] = value;
    })->Iterations(1);
  };
  for (const double megabytes : {0.5, 8.0, 64.0, 512.0})
    show("limit/triad/" + std::to_string(static_cast<int>(1000 * megabytes)) + "kB",
         "bytes_per_second", triad_bandwidth, megabytes * 1e6);
  show(
      "limit/fma/float", "flops_per_second", [](double) { return fma_peak<float>(); }, 0);
  show(
      "limit/fma/double", "flops_per_second", [](double) { return fma_peak<double>(); }, 0);
}

}  // namespace plica::bench
