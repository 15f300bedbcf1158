// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <plica/core/error.hpp>
#include <plica/drivers/study/about_rest.hpp>
#include <plica/drivers/study/arnoldi.hpp>
#include <plica/drivers/study/cycle_map.hpp>
#include <random>

namespace plica {

namespace {

constexpr int burst = 20;  // macro steps between two looks at the size, which may grow by a large factor in each

/// A random state under way, brought back to size 1 from time to time.
template <class B>
class LongRun {
 public:
  explicit LongRun(const CycleMap<B>& map) : map_(map), x_(map.size()) {
    std::mt19937 random(1);
    for (double& value : x_) value = std::uniform_real_distribution<double>(-1, 1)(random);
    x_.normalize();
  }

  long macro_steps() const { return static_cast<long>(log_size_.size() - 1) * burst; }
  double last_growth() const { return last_; }

  /// False where it ends before, at zero or beyond all numbers: see last_growth().
  bool until(long macro_steps) {
    while (this->macro_steps() < macro_steps) {
      x_ = map_.apply(x_, burst);
      last_ = x_.allFinite() ? x_.norm() : std::numeric_limits<double>::infinity();
      if (last_ == 0 || std::isinf(last_)) return false;
      x_ /= last_;
      log_size_.push_back(log_size_.back() + std::log(last_));
    }
    return true;
  }

  /// Of log |x| per macro step, over the last 1/n of them.
  double mean_growth(std::size_t n) const {
    const std::size_t bursts = log_size_.size() - 1, last = std::max<std::size_t>(1, bursts / n);
    if (bursts == 0) return 0;
    return (log_size_.back() - log_size_[bursts - last]) / static_cast<double>(last * burst);
  }

  RitzValue largest(Eigen::Index dimension) const {
    return largest_ritz_value([&](const Eigen::VectorXd& y) { return map_.apply(y); }, x_, dimension);
  }

 private:
  const CycleMap<B>& map_;
  Eigen::VectorXd x_;
  std::vector<double> log_size_ = {0};  // after each burst
  double last_ = 1;
};

}  // namespace

template <class B>
CycleMap<B>::CycleMap(const Problem& problem, const Exec& exec)
    : built_(build_hierarchy<B>(about_rest<B>(problem, exec), exec)) {
  const auto inverse =
      Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), (*built_.hierarchy)[0].level.model.inverse_mass);
  for (std::size_t a = 0; a < inverse.extent(0); ++a)
    if (inverse(a) > 0) free_.push_back(a);
  if (free_.empty()) throw InputError("every vertex of level 0 is held: nothing moves");
}

template <class B>
Eigen::VectorXd CycleMap<B>::apply(const Eigen::VectorXd& x, int macro_steps) const {
  Hierarchy<B>& hierarchy = *built_.hierarchy;
  const State<B>& state = hierarchy[0].level.state;
  const auto u = Kokkos::create_mirror_view(state.u), v = Kokkos::create_mirror_view(state.v);
  const auto each = [&](const auto& visit) {
    Eigen::Index i = 0;
    for (const std::size_t a : free_)
      for (std::size_t k = 0; k < 3; ++k, ++i) visit(u(a, k), v(a, k), i, i + size() / 2);
  };
  hierarchy.exec().fence("plica::cycle_map");
  each([&](auto& ua, auto& va, Eigen::Index iu, Eigen::Index iv) {
    using Real = typename B::Real;
    ua = static_cast<Real>(x[iu]), va = static_cast<Real>(x[iv] / macro_step());
  });
  Kokkos::deep_copy(state.u, u);
  Kokkos::deep_copy(state.v, v);
  built_.cycle->begin(hierarchy);
  for (int n = 0; n < macro_steps; ++n) {
    for (auto& part : hierarchy.levels) part.forces->begin_macro_step();
    built_.cycle->step(hierarchy, 0, macro_step());
  }
  hierarchy.exec().fence("plica::cycle_map");
  Kokkos::deep_copy(u, state.u);
  Kokkos::deep_copy(v, state.v);
  Eigen::VectorXd y(size());
  each([&](auto ua, auto va, Eigen::Index iu, Eigen::Index iv) {
    y[iu] = static_cast<double>(ua), y[iv] = static_cast<double>(va) * macro_step();
  });
  return y;
}

template <class B>
Eigen::MatrixXd CycleMap<B>::matrix() const {
  Eigen::MatrixXd A(size(), size());
  for (Eigen::Index j = 0; j < size(); ++j) A.col(j) = apply(Eigen::VectorXd::Unit(size(), j));
  return A;
}

template <class B>
CycleGrowth cycle_growth(const CycleMap<B>& map, const CycleGrowthOptions& options) {
  CycleGrowth found;
  found.macro_step = map.macro_step();
  LongRun<B> run(map);
  for (long target = 10 * burst; !found.converged && 2 * found.macro_steps < options.macro_steps; target *= 2) {
    const bool sound = run.until(target);
    const RitzValue ritz = sound ? run.largest(options.dimension) : RitzValue{run.last_growth(), 0};
    found.macro_steps = run.macro_steps() + options.dimension;
    found.converged = ritz.residual <= options.tolerance;
    const double whole = run.mean_growth(2), part = run.mean_growth(4);
    found.radius = found.converged ? std::abs(ritz.value) : std::exp(whole);
    found.uncertainty = found.radius * (found.converged ? ritz.residual : std::abs(std::expm1(whole - part)));
  }
  found.per_second = std::log(found.radius) / found.macro_step;
  return found;
}

#define PLICA_INSTANTIATE(Real, Exec)           \
  template class CycleMap<Backend<Real, Exec>>; \
  template CycleGrowth cycle_growth(const CycleMap<Backend<Real, Exec>>&, const CycleGrowthOptions&);
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
