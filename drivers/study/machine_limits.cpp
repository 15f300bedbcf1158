// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/core/backend.hpp>
#include <plica/core/pack.hpp>
#include <plica/drivers/study/machine_limits.hpp>

namespace plica {

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

template <class Functor>
double best_time(int n, int repeats, const Functor& functor) {
  double best = 1e30;
  for (int r = 0; r < repeats; ++r) {
    const Kokkos::Timer timer;
    Kokkos::parallel_for("plica::limit", Kokkos::RangePolicy<Exec>(0, n), functor);
    Kokkos::fence();
    best = std::min(best, timer.seconds());
  }
  return best;
}

}  // namespace

double triad_bandwidth(double footprint) {
  const int n = std::max(1, static_cast<int>(footprint / (3 * sizeof(double))));
  using View = Kokkos::View<double*, Exec>;
  const Triad triad{View("plica::limit_a", n), View("plica::limit_b", n),
                    View("plica::limit_c", n)};
  const int repeats = static_cast<int>(std::clamp(4e9 / footprint, 20.0, 4000.0));
  return 3.0 * sizeof(double) * n / best_time(n, repeats, triad);
}

template <class Real>
double fma_peak() {
  using Kernel = MultiplyAdds<Real>;
  const int n = 64 * Exec().concurrency();
  const Kernel kernel{Kokkos::View<Real*, Exec>("plica::limit_result", n), Real(0.5)};
  return 2.0 * Kernel::lanes * Kernel::chains * Kernel::length * n / best_time(n, 50, kernel);
}
template double fma_peak<float>();
template double fma_peak<double>();

}  // namespace plica
