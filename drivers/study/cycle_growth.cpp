// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <plica/core/error.hpp>
#include <plica/drivers/study/cycle_growth.hpp>
#include <plica/drivers/study/eigenvalues.hpp>
#include <plica/drivers/study/small_motion.hpp>
#include <random>

namespace plica {

namespace {

// macro steps between two normalisations of the state, whose size may grow much in each step
constexpr int burst = 20;

/// Long run from a random state, which is scaled back to size 1 after every burst.
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

  /// Runs until this number of macro steps. Returns false where the state becomes zero or overflows
  /// before: last_growth() then returns 0 or infinity.
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

  /// Returns the mean growth of log |x| per macro step, over the last 1/n of the run.
  double mean_growth(std::size_t n) const {
    const std::size_t bursts = log_size_.size() - 1, last = std::max<std::size_t>(1, bursts / n);
    if (bursts == 0) return 0;
    return (log_size_.back() - log_size_[bursts - last]) / static_cast<double>(last * burst);
  }

  RitzValue largest(Eigen::Index dimension) const {
    return largest_ritz_value([&](const Eigen::VectorXd& y) { return map_.apply(y); }, x_,
                              dimension);
  }

 private:
  const CycleMap<B>& map_;
  Eigen::VectorXd x_;
  std::vector<double> log_size_ = {0};  // log |x| after each burst
  double last_ = 1;
};

}  // namespace

template <class B>
CycleMap<B>::CycleMap(const Problem& problem, const Exec& exec)
    : built_(build_hierarchy<B>(about_rest<B>(problem, exec), exec)) {
  const auto inverse = Kokkos::create_mirror_view_and_copy(
      Kokkos::HostSpace(), (*built_.hierarchy)[0].model.inverse_mass);
  for (std::size_t a = 0; a < inverse.extent(0); ++a)
    if (inverse(a) > 0) free_.push_back(a);
  if (free_.empty()) throw InputError("every vertex of level 0 is held: nothing moves");
}

template <class B>
Eigen::VectorXd CycleMap<B>::apply(const Eigen::VectorXd& x, int macro_steps) const {
  Hierarchy<B>& hierarchy = *built_.hierarchy;
  const State<B>& state = hierarchy[0].state;
  auto u = host_values(hierarchy.exec(), state.u), v = host_values(hierarchy.exec(), state.v);
  const auto each = [&](const auto& visit) {
    Eigen::Index i = 0;
    for (const std::size_t a : free_)
      for (std::size_t k = 0; k < 3; ++k, ++i) visit(u[3 * a + k], v[3 * a + k], i, i + size() / 2);
  };
  each([&](auto& ua, auto& va, Eigen::Index iu, Eigen::Index iv) {
    using Real = typename B::Real;
    ua = static_cast<Real>(x[iu]), va = static_cast<Real>(x[iv] / macro_step());
  });
  fields::upload<typename B::Memory>(state.u.data(), u.data(), fields::bytes_of(state.u));
  fields::upload<typename B::Memory>(state.v.data(), v.data(), fields::bytes_of(state.v));
  built_.stepper->begin(hierarchy);
  for (int n = 0; n < macro_steps; ++n) {
    for (auto& part : hierarchy.levels) part.begin_macro_step();
    built_.stepper->step(hierarchy, 0, macro_step());
  }
  u = host_values(hierarchy.exec(), state.u), v = host_values(hierarchy.exec(), state.v);
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
  for (long target = 10 * burst; !found.converged && 2 * found.macro_steps < options.macro_steps;
       target *= 2) {
    const bool sound = run.until(target);
    const RitzValue ritz = sound ? run.largest(options.dimension) : RitzValue{run.last_growth(), 0};
    found.macro_steps = run.macro_steps() + options.dimension;
    found.converged = ritz.residual <= options.tolerance;
    const double whole = run.mean_growth(2), part = run.mean_growth(4);
    found.radius = found.converged ? std::abs(ritz.value) : std::exp(whole);
    found.uncertainty =
        found.radius * (found.converged ? ritz.residual : std::abs(std::expm1(whole - part)));
  }
  found.per_second = std::log(found.radius) / found.macro_step;
  return found;
}

#define PLICA_INSTANTIATE(Real, Exec)                                     \
  template class CycleMap<Backend<Real, Exec>>;                           \
  template CycleGrowth cycle_growth(const CycleMap<Backend<Real, Exec>>&, \
                                    const CycleGrowthOptions&);
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

namespace {

constexpr CycleGrowthOptions bounded_growth{.macro_steps = 500, .tolerance = 1e-6, .dimension = 40};

constexpr Eigen::Index most_dense = 800;
constexpr double close_to_one = 1.001;

template <class B>
CycleGrowth of_all_modes(const CycleMap<B>& map) {
  CycleGrowth found;
  found.macro_step = map.macro_step(), found.macro_steps = map.size();
  found.radius = spectral_radius(map.matrix()),
  found.per_second = std::log(found.radius) / found.macro_step;
  found.uncertainty = 1e-6,
  // eigenvalue pairs that coincide at 1 (free bodies) are only found to the root of rounding
      found.converged = true;
  return found;
}

// Returns the options on which the linearised cycle depends. Its mappings do not switch, and rsv
// and rsv_sv equal rv: see CycleMap
IntegrationOptions map_of(const StudyCase& one, double macro_step) {
  IntegrationOptions o = one.integration;
  if (o.cycle == "rsv" || o.cycle == "rsv_sv") o.cycle = "rv";
  o.macro_step = macro_step, o.allow_unstable = true;
  return o;
}

}  // namespace

const GrowthOfCycles::Found* GrowthOfCycles::known(const IntegrationOptions& map) const {
  const auto found =
      std::ranges::find_if(found_, [&](const Found& f) { return steps_alike(f.first, map); });
  return found == found_.end() ? nullptr : &*found;
}

std::optional<CycleGrowth> GrowthOfCycles::of(const StudyCase& one, double macro_step,
                                              std::optional<double> told_from) {
  const IntegrationOptions map = map_of(one, macro_step);
  const auto clear = [&](const CycleGrowth& g) {
    return g.converged || !told_from || std::abs(g.radius - *told_from) > 2 * g.uncertainty;
  };
  if (const Found* before = known(map);
      before != nullptr && (!before->second || clear(*before->second)))
    return before->second;
  std::erase_if(found_, [&](const Found& f) { return steps_alike(f.first, map); });
  std::optional<CycleGrowth>& growth = found_.emplace_back(map, std::nullopt).second;
  Problem problem = problem_;
  problem.integration = map;
  try {
    using B = Backend<double, Kokkos::DefaultExecutionSpace>;
    const CycleMap<B> cycle(problem);
    CycleGrowthOptions options = bounded_growth;
    const bool few = told_from && *told_from < close_to_one && cycle.size() <= most_dense;
    growth = few ? of_all_modes(cycle) : cycle_growth(cycle, options);
    for (int i = 0; i < 2 && !clear(*growth); ++i)
      options.macro_steps *= 4, growth = cycle_growth(cycle, options);
  } catch (const InputError&) {
  }
  return growth;
}

double GrowthOfCycles::predicted_evaluations(const StudyCase& one, double macro_step,
                                             double duration) const {
  if (known(map_of(one, macro_step)) != nullptr) return 0;
  return one.predicted_evaluations * macro_step / duration *
         static_cast<double>(bounded_growth.macro_steps);
}

}  // namespace plica
