// SPDX-License-Identifier: BSD-3-Clause
#include <Kokkos_Profiling_ScopedRegion.hpp>
#include <algorithm>
#include <cmath>
#include <plica/core/dense.hpp>
#include <plica/drivers/solver/him/inertia.hpp>
#include <plica/kernels/him/momentum_of.hpp>
#include <plica/kernels/vectors.hpp>

namespace plica {

namespace {

template <class B>
class ProductLanczos {
  using Real = typename B::Real;

 public:
  ProductLanczos(const typename B::Exec& exec, const Level<B>& level, const VectorMap<B>& A, const VectorMap<B>& K)
      : exec_(exec), level_(level), A_(A), K_(K), n_(level.model.vertices), blocks_(n_) {}

  double largest(double tolerance) {
    fill_from_hash<B>(exec_, "plica::him_lanczos", level_.model.inverse_mass, v_, blocks_, result_);
    double beta = normalise(), value = 0;
    if (!(beta > 0)) return 0;
    std::vector<double> alphas, betas;
    for (int step = 1; step <= 200; ++step) {
      A_(kv_, w_);
      const double alpha = product(w_, kv_);
      add<B>(exec_, "plica::him_lanczos", static_cast<Real>(-alpha), v_, w_);
      if (!alphas.empty()) add<B>(exec_, "plica::him_lanczos", static_cast<Real>(-beta), before_, w_);
      alphas.push_back(alpha);
      std::swap(before_, v_), std::swap(v_, w_);
      beta = normalise();
      const bool last = !(beta > 1e-12 * std::abs(alpha));
      if (step % 5 == 0 || last) {
        const dense::RitzBound top = dense::largest_ritz_bound(alphas, betas, beta);
        value = top.value;
        if (top.residual < tolerance * value || last) return value + top.residual;
      }
      betas.push_back(beta);
    }
    return value * (1 + tolerance);
  }

 private:
  const typename B::Exec& exec_;
  const Level<B>& level_;
  const VectorMap<B>&A_, &K_;
  int n_;
  BlockSums<B> blocks_;
  Vectors<B> v_ = zeros<Vectors<B>>("plica::him_lanczos.v", static_cast<std::size_t>(n_)),
             w_ = zeros<Vectors<B>>("plica::him_lanczos.w", v_.extent(0)),
             before_ = zeros<Vectors<B>>("plica::him_lanczos.before", v_.extent(0)),
             kv_ = zeros<Vectors<B>>("plica::him_lanczos.Kv", v_.extent(0));
  Doubles<B> result_ = zeros<Doubles<B>>("plica::him_lanczos.result", 1);

  /// Kv, and v to length 1 in its product; its length before.
  double normalise() {
    K_(v_, kv_);
    const double size = std::sqrt(std::max(0.0, product(v_, kv_)));
    if (size > 0)
      for (const Vectors<B>& x : {v_, kv_}) scale<B>(exec_, "plica::him_lanczos", static_cast<Real>(1 / size), x);
    return size;
  }

  double product(const Vectors<B>& x, const Vectors<B>& y) {
    dot<B>(exec_, "plica::him_lanczos", x, y, blocks_, result_);
    return host_values(exec_, result_)[0];
  }
};

}  // namespace

template <class B>
double largest_of_product(const typename B::Exec& exec, const Level<B>& level, const VectorMap<B>& A,
                          const VectorMap<B>& K, double tolerance) {
  return ProductLanczos<B>(exec, level, A, K).largest(tolerance);
}

namespace {

constexpr double least_scale = 1e-4, finest_tolerance = 1e-3, parts_tolerance = 1e-2, fit_tolerance = 1e-2;
constexpr int halvings = 8;  // of the interval of the logarithm of the scale: to 4 %
constexpr int scales = 1 << halvings, most_guesses = 5;

/// Scale k of those from least_scale, k = 0, to 1, which would be the next after the last: what halving the interval finds.
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

/// A scale and t^2 lambda_max(A K) there.
struct Tried {
  double scale, product;
};

/// Where the product is `limit` if it is linear between these two, as it nearly is.
double between(const Tried& below, const Tried& above, double limit) {
  return below.scale + (above.scale - below.scale) * (limit - below.product) / (above.product - below.product);
}

double kappa_of(double sigma) { return 0.4 * 4 * sigma * sigma; }

std::vector<double> weights_of(const std::vector<double>& alpha) {
  std::vector<double> weights = alpha;
  for (std::size_t i = alpha.size(); i-- > 1;) weights[i] -= alpha[i - 1];
  return weights;
}

}  // namespace

template <class B>
InertiaFitter<B>::InertiaFitter(const typename B::Exec& exec, const Level<B>& level,
                                std::shared_ptr<const Elasticity<B>> elasticity, InverseMass<B>& inverse_mass,
                                std::optional<CoarseModes> modes)
    : exec_(exec),
      level_(level),
      elasticity_(std::move(elasticity)),
      inverse_mass_(inverse_mass),
      modes_(std::move(modes)) {
  const Kokkos::Profiling::ScopedRegion region("plica: critical steps of the parts of the inertia");
  const auto levels = static_cast<std::size_t>(inverse_mass_.levels());
  const Vectors<B> rest = zeros<Vectors<B>>("plica::him.rest", static_cast<std::size_t>(level.model.vertices));
  const auto n = modes_ ? static_cast<Eigen::Index>(3 * inverse_mass_.filter().vertices) : 0;
  inverse_mass_.set_answer(Eigen::MatrixXd::Zero(n, n));
  for (std::size_t i = 0; i + 1 < std::max<std::size_t>(levels, 2); ++i) {
    std::vector<double> alone(levels, 0.0);
    alone[i] = 1;
    inverse_mass_.set_weights(alone);
    critical_.push_back(2 / std::sqrt(largest(rest, i == 0 ? finest_tolerance : parts_tolerance)));
  }
}

template <class B>
double InertiaFitter<B>::largest(const Vectors<B>& u, double tolerance) const {
  const VectorMap<B> A = [this](const Vectors<B>& x, const Vectors<B>& y) { inverse_mass_.apply(exec_, x, y); };
  const VectorMap<B> K = [&](const Vectors<B>& x, const Vectors<B>& y) {
    elasticity_->tangent(exec_, level_, u, x, 0);
    update_vertices<B>(exec_, "plica::him_stiffness", level_.model.vertices,
                       GatherStiffness<B>{level_.model, level_.partial, y});
  };
  return largest_of_product<B>(exec_, level_, A, K, tolerance);
}

template <class B>
std::vector<double> InertiaFitter<B>::alphas(double t, double scale) const {
  std::vector<double> alpha;
  double before = 0;
  for (std::size_t i = 0; i + 1 < static_cast<std::size_t>(inverse_mass_.levels()); ++i) {
    before = std::max(before, std::min(1.0, scale * std::pow(critical_[i] / t, 2)));
    alpha.push_back(before);
  }
  alpha.push_back(1);
  return alpha;
}

template <class B>
void InertiaFitter<B>::set_answer(double t, double sigma) {
  if (modes_) inverse_mass_.set_answer(modes_->answer(t, kappa_of(sigma)));
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
  double product = 0;  // of the last scale that was tried
  const auto fits = [&](double gamma) {
    inverse_mass_.set_weights(weights_of(alphas(t, gamma)));
    product = t * t * largest(u, fit_tolerance);
    return product <= 4 * sigma * sigma;
  };
  const auto found = [&](double gamma) {
    InertiaFit fit = weigh(t, sigma, gamma);
    fit.product = product;
    return fit;
  };
  const double plain = std::pow(t / critical_.front(), 2);  // there alpha_0 is 1: no inertia is added
  if (plain <= 1 && fits(plain)) return found(plain);
  if (fits(1)) return found(1);
  if (!modes_) return {};
  // the largest of the scales that fits: the product grows with them, from the coarsest level's own
  const double limit = 4 * sigma * sigma;
  Tried below{0, modes_->largest(t, kappa_of(sigma))}, above{1, product};
  int fitting = -1, failing = scales;
  for (int guesses = 0; failing - fitting > 1; ++guesses) {
    const double guess = between(below, above, limit);
    int next = fitting + 1;  // the last below the guess; where that is known to fit the one after it
    while (next + 1 < failing && scale_at(next + 1) <= guess) ++next;
    if (guesses >= most_guesses) next = (fitting + failing) / 2;
    if (guesses == 1 && fitting < 0) next = 0;  // of a body that has stiffened none may fit
    const double gamma = scale_at(next);
    if (fits(gamma))
      fitting = next, below = {gamma, product};
    else
      failing = next, above = {gamma, product};
  }
  if (fitting < 0) return {};
  product = below.product;
  return found(below.scale);
}

#define PLICA_INSTANTIATE(Real, Exec)                                                                     \
  template class InertiaFitter<Backend<Real, Exec>>;                                                      \
  template double largest_of_product<Backend<Real, Exec>>(const Exec&, const Level<Backend<Real, Exec>>&, \
                                                          const VectorMap<Backend<Real, Exec>>&,          \
                                                          const VectorMap<Backend<Real, Exec>>&, double);
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
