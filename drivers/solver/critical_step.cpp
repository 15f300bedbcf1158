// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <plica/core/dense.hpp>
#include <plica/drivers/solver/critical_step.hpp>
#include <plica/kernels/spectrum/scaled_operator.hpp>
#include <plica/kernels/vectors.hpp>

namespace plica {

namespace {

/// The Lanczos iteration's vectors and its products.
template <class B>
class Lanczos {
  using Real = typename B::Real;
  using Exec = typename B::Exec;

 public:
  Lanczos(const Exec& exec, const Level<B>& level, const Elasticity<B>& elasticity, const Vectors<B>& u, double over)
      : exec_(exec),
        level_(level),
        elasticity_(elasticity),
        u_(u),
        over_(over),
        n_(level.model.vertices),
        v_(zeros<Vectors<B>>("plica::lanczos.v", n_)),
        w_(zeros<Vectors<B>>("plica::lanczos.w", n_)),
        before_(zeros<Vectors<B>>("plica::lanczos.before", n_)),
        p_(zeros<Vectors<B>>("plica::lanczos.p", n_)),
        blocks_(n_),
        result_(zeros<Doubles<B>>("plica::lanczos.result", 1)) {}

  double largest() {
    fill_from_hash<B>(exec_, "plica::lanczos_start", level_.model.inverse_mass, w_, blocks_, result_);
    const double size = std::sqrt(host_values(exec_, result_)[0]);
    if (!(size > 0)) return 0;
    double beta = 0, scale = 1 / size, value = 0;
    std::vector<double> alphas, betas;
    for (int k = 0; k < 150; ++k) {
      each("plica::lanczos_shift", LanczosShift<B>{v_, w_, before_, static_cast<Real>(scale)});
      const double alpha = product(beta);
      beta = std::sqrt(sum("plica::lanczos_orthogonalise", LanczosOrthogonalise<B>{v_, w_, static_cast<Real>(alpha)}));
      alphas.push_back(alpha);
      const bool last = !(beta > 1e-12 * std::abs(alpha));
      if (k % 5 == 4 || last) {
        const dense::RitzBound top = dense::largest_ritz_bound(alphas, betas, beta);
        value = top.value;
        if (top.residual < 1e-3 * value || last) return value + top.residual;
      }
      betas.push_back(beta);
      scale = 1 / beta;
    }
    return value * 1.02;
  }

 private:
  const Exec& exec_;
  const Level<B>& level_;
  const Elasticity<B>& elasticity_;
  const Vectors<B>& u_;
  double over_;
  int n_;
  Vectors<B> v_, w_, before_, p_;
  BlockSums<B> blocks_;
  Doubles<B> result_;

  template <class Work>
  void each(const char* label, const Work& work) {
    update_vertices<B>(exec_, label, n_, work);
  }
  template <class Term>
  double sum(const char* label, const Term& term) {
    reduce<B, 1>(exec_, label, n_, term, blocks_, result_);
    return host_values(exec_, result_)[0];
  }

  /// w = M^-1/2 (K + over D) M^-1/2 v - beta before; v.w
  double product(double beta) {
    each("plica::lanczos_scale", ScaleByMass<B>{level_.model.inverse_mass, v_, p_, Real(1)});
    elasticity_.tangent(exec_, level_, u_, p_, over_);
    return sum("plica::lanczos_product",
               LanczosProduct<B>{level_.model, level_.partial, v_, before_, w_, static_cast<Real>(beta)});
  }
};

}  // namespace

template <class B>
double largest_eigenvalue(const typename B::Exec& exec, const Level<B>& level, const Elasticity<B>& elasticity,
                          const Vectors<B>& u, double over) {
  return Lanczos<B>(exec, level, elasticity, u, over).largest();
}

template <class B>
double critical_step(const typename B::Exec& exec, const Level<B>& level, const Elasticity<B>& elasticity,
                     const Vectors<B>& u, const StabilityLimit& limit, const DampingLimit& damping, double beside) {
  const auto frequency = [&](double over) {
    return std::sqrt(largest_eigenvalue(exec, level, elasticity, u, over) + beside);
  };
  const double infinite = std::numeric_limits<double>::infinity();
  const double w = frequency(0);
  const double most = damping.most_mass + damping.most_stiffness * w * w;
  const double by_damping = limit.damping > 0 && most > 0 ? limit.damping / most : infinite;
  if (!(w > 0)) return by_damping;
  if (limit.growth > 0) {
    const double least = damping.least_mass + damping.least_stiffness * w * w;
    return std::min(std::pow(least / (limit.growth * std::pow(w, limit.power)), 1.0 / (limit.power - 1)), by_damping);
  }
  if (limit.radius <= 0) return infinite;
  // damping acts like the stiffness radius D / h: the limit is where step(h) = h, reached from above. There ln step has a
  // slope of at most 1/2 over ln h (the eigenvalue is convex in 1/h), so that it is not below step^2 / h.
  double h = limit.radius / w;
  for (int i = 0; i < 20 && damping.most_stiffness > 0; ++i) {
    const double step = limit.radius / frequency(limit.radius / h);
    const bool close = std::abs(step - h) < 5e-3 * h;
    h = close ? std::min(step, step * step / h) : step;
    if (close) break;
  }
  const double by_mass = damping.most_mass > 0 && limit.damping > 0 ? limit.damping / damping.most_mass : infinite;
  return std::min(h, by_mass);
}

#define PLICA_INSTANTIATE(Real, Exec)                                                                     \
  template double largest_eigenvalue<Backend<Real, Exec>>(const Exec&, const Level<Backend<Real, Exec>>&, \
                                                          const Elasticity<Backend<Real, Exec>>&,         \
                                                          const Vectors<Backend<Real, Exec>>&, double);   \
  template double critical_step<Backend<Real, Exec>>(                                                     \
      const Exec&, const Level<Backend<Real, Exec>>&, const Elasticity<Backend<Real, Exec>>&,             \
      const Vectors<Backend<Real, Exec>>&, const StabilityLimit&, const DampingLimit&, double);
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
