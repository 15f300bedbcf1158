// SPDX-License-Identifier: BSD-3-Clause
#include <Kokkos_Profiling_ScopedRegion.hpp>
#include <algorithm>
#include <cmath>
#include <plica/drivers/cycles/him/inertia.hpp>
#include <plica/drivers/elastic/largest_eigenvalue.hpp>

namespace plica {

namespace {

constexpr double rounding = 1e-12, least_scale = 1e-4, parts_tolerance = 1e-2;
constexpr int halvings = 8;  // halvings of the interval of log(scale): to 4 %
constexpr int scales = 1 << halvings, most_guesses = 5;

/// Returns scale k of the `scales` that halving the interval from least_scale to 1 can find.
/// Scale 0 is least_scale; the next after the last would be 1.
double scale_at(int k) {
  double low = least_scale, high = 1;
  for (int half = scales / 2, at = 0; at != k; half /= 2) {
    const double middle = std::sqrt(low * high);
    if (k >= at + half)
      low = middle, at += half;
    else
      high = middle;
  }
  return low;
}

/// A scale gamma, and t^2 lambda_max(A K) with it.
struct Tried {
  double scale, product;
};

/// Returns the scale at which the product is `limit`, by linear interpolation between two tries.
/// The product is nearly linear in the scale.
double between(const Tried& below, const Tried& above, double limit) {
  return below.scale +
         (above.scale - below.scale) * (limit - below.product) / (above.product - below.product);
}

double kappa_of(double sigma) { return 0.4 * 4 * sigma * sigma; }

std::vector<double> weights_of(const std::vector<double>& alpha) {
  std::vector<double> weights = alpha;
  for (std::size_t i = alpha.size(); i-- > 1;) weights[i] -= alpha[i - 1];
  return weights;
}

}  // namespace

template <class B>
InertiaFitter<B>::InertiaFitter(const typename B::Exec& exec, const LevelData<B>& level,
                                const RowsOfBody& rows,
                                std::shared_ptr<const Elasticity<B>> elasticity,
                                std::optional<double> eigenvalue, InverseMass<B>& inverse_mass,
                                std::optional<CoarseModes> modes)
    : exec_(exec),
      level_(level),
      rows_(rows),
      elasticity_(std::move(elasticity)),
      inverse_mass_(inverse_mass),
      modes_(std::move(modes)) {
  const Kokkos::Profiling::ScopedRegion region("plica: critical steps of the parts of the inertia");
  const auto levels = static_cast<std::size_t>(inverse_mass_.levels());
  const Vectors<B> rest =
      zeros<Vectors<B>>("plica::him.rest", static_cast<std::size_t>(level.model.vertices));
  if (modes_) {
    const auto n = static_cast<Eigen::Index>(3 * inverse_mass_.filter().vertices);
    inverse_mass_.set_answer(InverseMass<B>::to_device(Eigen::MatrixXd::Zero(n, n)));
  }
  if (eigenvalue) critical_.push_back(2 / std::sqrt(*eigenvalue));
  for (std::size_t i = critical_.size(); i == 0 || i + 1 < levels; ++i) {
    std::vector<double> alone(levels, 0.0);
    alone[i] = 1;
    inverse_mass_.set_weights(alone);
    critical_.push_back(2 / std::sqrt(largest(rest, parts_tolerance)));
  }
}

template <class B>
double InertiaFitter<B>::largest(const Vectors<B>& u, double tolerance) const {
  const VectorMap<B> A = [this](const Vectors<B>& x, const Vectors<B>& y) {
    if (rows_.count < level_.model.vertices) fill(exec_, y, typename B::Real(0));
    inverse_mass_.apply(exec_, rows_.of(x), rows_.of(y));
  };
  return largest_eigenvalue<B>(exec_, A, {level_, *elasticity_, u}, tolerance);
}

template <class B>
std::vector<double> InertiaFitter<B>::alphas(double t, double scale) const {
  std::vector<double> alpha;
  double before = 0;
  for (std::size_t i = 0; i + 1 < static_cast<std::size_t>(inverse_mass_.levels()); ++i) {
    const double own = scale * std::pow(critical_[i] / t, 2);
    before = std::max(
        before,
        own < 1 - rounding ? own : 1.0);  // at 1 the coarser levels have weight 0 and are left out
    alpha.push_back(before);
  }
  alpha.push_back(1);
  return alpha;
}

template <class B>
void InertiaFitter<B>::set_answer(double t, double sigma) {
  if (!modes_) return;
  auto& answer = answers_[{t, sigma}];
  if (answer.extent(0) == 0) answer = InverseMass<B>::to_device(modes_->answer(t, kappa_of(sigma)));
  inverse_mass_.set_answer(answer);
}

template <class B>
InertiaFit InertiaFitter<B>::use(double t, double sigma, double scale) {
  set_answer(t, sigma);
  return weigh(t, sigma, scale);
}

template <class B>
InertiaFit InertiaFitter<B>::weigh(double t, double sigma, double scale) {
  const std::vector<double> alpha = alphas(t, scale), weights = weights_of(alpha);
  inverse_mass_.set_weights(weights);
  InertiaFit fit;
  fit.step = t, fit.scale = scale;
  fit.bound = modes_ ? weights.back() * modes_->largest(t, kappa_of(sigma)) : 0;
  for (std::size_t i = 0; i < alpha.size(); ++i) {
    fit.inertia.push_back(1 / alpha[i]);
    if (i < critical_.size()) fit.bound += weights[i] * 4 * std::pow(t / critical_[i], 2);
  }
  return fit;
}

template <class B>
std::optional<InertiaFit> InertiaFitter<B>::fit(double t, double sigma, const Vectors<B>& u) {
  const Kokkos::Profiling::ScopedRegion region("plica: fitting the inertia");
  set_answer(t, sigma);
  double tried = 0;  // product of the last scale that was tried
  const auto fits = [&](double gamma) {
    inverse_mass_.set_weights(weights_of(alphas(t, gamma)));
    tried = product(t, u);
    return tried <= 4 * sigma * sigma;
  };
  const auto found = [&](double gamma) {
    InertiaFit fit = weigh(t, sigma, gamma);
    fit.product = tried;
    return fit;
  };
  // scale at which alpha_0 is 1: no inertia is added
  const double plain = std::pow(t / critical_.front(), 2);
  if (plain <= 1 && fits(plain)) return found(plain);
  if (fits(1)) return found(1);
  if (!modes_) return {};
  // Search for the largest scale that fits. The product grows with the scale. At 0 it is that of
  // the coarsest level alone.
  const double limit = 4 * sigma * sigma;
  Tried below{0, modes_->largest(t, kappa_of(sigma))}, above{1, tried};
  int fitting = -1, failing = scales;
  for (int guesses = 0; failing - fitting > 1; ++guesses) {
    const double guess = between(below, above, limit);
    // the last scale below the guess, or the one after it where that scale is known to fit
    int next = fitting + 1;
    while (next + 1 < failing && scale_at(next + 1) <= guess) ++next;
    if (guesses >= most_guesses) next = (fitting + failing) / 2;
    if (guesses == 1 && fitting < 0) next = 0;  // after stiffening maybe none fits
    const double gamma = scale_at(next);
    if (fits(gamma))
      fitting = next, below = {gamma, tried};
    else
      failing = next, above = {gamma, tried};
  }
  if (fitting < 0) return {};
  tried = below.product;
  return found(below.scale);
}

#define PLICA_INSTANTIATE(Real, Exec) template class InertiaFitter<Backend<Real, Exec>>;
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
