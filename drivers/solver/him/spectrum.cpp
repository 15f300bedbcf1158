// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <plica/drivers/solver/him/spectrum.hpp>
#include <plica/drivers/solver/tridiagonal.hpp>
#include <plica/kernels/explicit/updates.hpp>
#include <plica/kernels/him/product_lanczos.hpp>
#include <plica/kernels/spectrum/scaled_operator.hpp>

namespace plica {

namespace {

template <class B>
class ProductLanczos {
  using Real = typename B::Real;

 public:
  ProductLanczos(const typename B::Exec& exec, const Level<B>& level, const VectorMap<B>& A, const VectorMap<B>& K)
      : exec_(exec), level_(level), A_(A), K_(K), n_(level.model.vertices), blocks_(n_) {}

  double largest(double tolerance) {
    fill();
    double beta = normalise(), value = 0;
    if (!(beta > 0)) return 0;
    std::vector<double> alphas, betas;
    for (int step = 1; step <= 200; ++step) {
      A_(kv_, w_);
      const double alpha = sum(DotVectors<B>{w_, kv_});
      update_vertices<B>(exec_, "plica::him_lanczos", n_,
                         OrthogonaliseToTwo<B>{w_, v_, before_, static_cast<Real>(alpha),
                                               static_cast<Real>(alphas.empty() ? 0 : beta)});
      alphas.push_back(alpha);
      std::swap(before_, v_), std::swap(v_, w_);
      beta = normalise();
      const bool last = !(beta > 1e-12 * std::abs(alpha));
      if (step % 5 == 0 || last) {
        const RitzBound top = largest_ritz_bound(alphas, betas, beta);
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
  Vectors<B> v_{"plica::him_lanczos.v", static_cast<std::size_t>(n_)}, w_{"plica::him_lanczos.w", v_.extent(0)},
      before_{"plica::him_lanczos.before", v_.extent(0)}, kv_{"plica::him_lanczos.Kv", v_.extent(0)};
  Kokkos::View<double*, typename B::Memory> result_{"plica::him_lanczos.result", 1};

  void fill() { sum(FillFromHash<B>{level_.model.inverse_mass, v_}); }

  /// Kv, and v to length 1 in its product; its length before.
  double normalise() {
    K_(v_, kv_);
    const double size = std::sqrt(std::max(0.0, sum(DotVectors<B>{v_, kv_})));
    if (size > 0)
      update_vertices<B>(exec_, "plica::him_lanczos", n_, ScaleBoth<B>{v_, kv_, static_cast<Real>(1 / size)});
    return size;
  }

  template <class Term>
  double sum(const Term& term) {
    reduce<B, 1>(exec_, "plica::him_lanczos", n_, term, blocks_, result_);
    exec_.fence("plica::him_lanczos");
    return Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), result_)(0);
  }
};

}  // namespace

template <class B>
double largest_of_product(const typename B::Exec& exec, const Level<B>& level, const VectorMap<B>& A,
                          const VectorMap<B>& K, double tolerance) {
  return ProductLanczos<B>(exec, level, A, K).largest(tolerance);
}

#define PLICA_INSTANTIATE(Real, Exec)                                                                     \
  template double largest_of_product<Backend<Real, Exec>>(const Exec&, const Level<Backend<Real, Exec>>&, \
                                                          const VectorMap<Backend<Real, Exec>>&,          \
                                                          const VectorMap<Backend<Real, Exec>>&, double);
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
