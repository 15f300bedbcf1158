// SPDX-License-Identifier: BSD-3-Clause
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <plica/core/backend.hpp>
#include <plica/core/pack.hpp>

#include "limits.hpp"
#include "suites.hpp"

namespace plica::bench {

namespace {

using Exec = Kokkos::DefaultExecutionSpace;

struct Triad {
  Kokkos::View<double*, Exec> a, b, c;
  KOKKOS_INLINE_FUNCTION void operator()(int i) const { a(i) = b(i) + 0.5 * c(i); }
};

/// Chains of multiply-adds side by side, enough to hide their latency.
template <class Real>
struct MultiplyAdds {
  static constexpr int lanes = Backend<Real, Exec>::lanes, chains = 16, length = 4096;
  using T = typename PackOf<Real, lanes>::type;
  Kokkos::View<Real*, Exec> result;
  Real factor;

  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    T x[chains];
    for (int k = 0; k < chains; ++k) x[k] = T(static_cast<Real>(k));
    const T a(factor), b(static_cast<Real>(i + 1));
    for (int n = 0; n < length; ++n)
      for (int k = 0; k < chains; ++k) x[k] = x[k] * a + b;
    T sum(Real(0));
    for (int k = 0; k < chains; ++k) sum = sum + x[k];
    result(i) = lane(sum, 0);
  }
};

/// The best of many short runs: what else goes on in the machine only ever adds time.
template <class Functor>
double best_time(int n, int repeats, const Functor& functor) {
  double best = 1e30;
  for (int r = 0; r < repeats; ++r) {
    const Kokkos::Timer timer;
    Kokkos::parallel_for("bench::limit", Kokkos::RangePolicy<Exec>(0, n), functor);
    Kokkos::fence();
    best = std::min(best, timer.seconds());
  }
  return best;
}

}  // namespace

double triad_bandwidth(double footprint) {
  static std::map<int, double> known;  // by the binary logarithm of the footprint, to a quarter
  const int step = static_cast<int>(std::lround(4 * std::log2(std::max(footprint, 4096.0))));
  if (const auto found = known.find(step); found != known.end()) return found->second;
  const double bytes = std::exp2(step / 4.0);
  const int n = static_cast<int>(bytes / (3 * sizeof(double)));
  using View = Kokkos::View<double*, Exec>;
  const Triad triad{View("bench::a", n), View("bench::b", n), View("bench::c", n)};
  const int repeats = static_cast<int>(std::clamp(4e9 / bytes, 20.0, 4000.0));
  return known[step] = 3.0 * sizeof(double) * n / best_time(n, repeats, triad);
}

template <class Real>
double fma_peak() {
  static double peak = 0;
  if (peak > 0) return peak;
  using Kernel = MultiplyAdds<Real>;
  const int n = 64 * Exec().concurrency();
  const Kernel kernel{Kokkos::View<Real*, Exec>("bench::result", n), Real(0.5)};
  peak = 2.0 * Kernel::lanes * Kernel::chains * Kernel::length * n / best_time(n, 50, kernel);
  return peak;
}
template double fma_peak<float>();
template double fma_peak<double>();

void register_limits() {
  const auto show = [](const std::string& name, const char* counter, double (*measure)(double), double argument) {
    benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
      double value = 0;
      for (auto _ : state) value = measure(argument);
      state.counters[counter] = value;
    })->Iterations(1);
  };
  for (const double megabytes : {0.5, 8.0, 64.0, 512.0})
    show("limit/triad/" + std::to_string(static_cast<int>(1000 * megabytes)) + "kB", "bytes_per_second",
         triad_bandwidth, megabytes * 1e6);
  show(
      "limit/fma/float", "flops_per_second", [](double) { return fma_peak<float>(); }, 0);
  show(
      "limit/fma/double", "flops_per_second", [](double) { return fma_peak<double>(); }, 0);
}

}  // namespace plica::bench
