// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <plica/core/dense.hpp>
#include <plica/drivers/solver/largest_eigenvalue.hpp>
#include <plica/kernels/spectrum/lanczos.hpp>
#include <utility>

namespace plica {

namespace {

/// Its vectors are not made 1 long: `scale` times v is, in the product of K.
template <class B>
class Lanczos {
  using Real = typename B::Real;
  using Exec = typename B::Exec;

 public:
  Lanczos(const Exec& exec, const VectorMap<B>& A, const StiffnessAt<B>& K)
      : exec_(exec), A_(A), K_(K), n_(K.level.model.vertices), blocks_(n_) {}

  double largest(double tolerance) {
    fill_from_hash<B>(exec_, "plica::lanczos_start", K_.level.model.inverse_mass, v_, blocks_, result_);
    double beta = length(), scale = 1 / beta, scale_before = 0;
    if (!(beta > 0)) return 0;
    dense::LargestRitz top(tolerance);
    for (int step = 0; step < most_steps; ++step) {
      A_(kv_, w_);
      dot<B>(exec_, "plica::lanczos_product", w_, kv_, blocks_, result_);
      const double alpha = scale * scale * host_values(exec_, result_)[0];
      update_vertices<B>(
          exec_, "plica::lanczos_next", n_,
          NextLanczosVector<B>{w_, v_, before_, static_cast<Real>(scale), static_cast<Real>(alpha * scale),
                               static_cast<Real>(beta * scale_before)});
      std::swap(before_, v_), std::swap(v_, w_);
      beta = length();
      if (top.add(alpha, beta)) break;
      scale_before = std::exchange(scale, 1 / beta);
    }
    return top.bound();
  }

 private:
  static constexpr int most_steps = 200;
  const Exec& exec_;
  const VectorMap<B>& A_;
  const StiffnessAt<B>& K_;
  int n_;
  Vectors<B> v_ = vectors("plica::lanczos.v"), kv_ = vectors("plica::lanczos.Kv"), w_ = vectors("plica::lanczos.w"),
             before_ = vectors("plica::lanczos.before");
  BlockSums<B> blocks_;
  Doubles<B> result_ = zeros<Doubles<B>>("plica::lanczos.result", 1);

  Vectors<B> vectors(const char* name) const { return zeros<Vectors<B>>(name, static_cast<std::size_t>(n_)); }

  /// kv = K v; that of v in the product of K.
  double length() {
    K_.elasticity.tangent(exec_, K_.level, K_.u, v_, K_.over);
    reduce<B, 1>(exec_, "plica::lanczos_stiffness", n_, StiffnessProduct<B>{K_.level.model, K_.level.partial, v_, kv_},
                 blocks_, result_);
    return std::sqrt(std::max(0.0, host_values(exec_, result_)[0]));
  }
};

}  // namespace

template <class B>
double largest_eigenvalue(const typename B::Exec& exec, const VectorMap<B>& A, const StiffnessAt<B>& K,
                          double tolerance) {
  return Lanczos<B>(exec, A, K).largest(tolerance);
}

template <class B>
double largest_eigenvalue(const typename B::Exec& exec, const StiffnessAt<B>& K) {
  const VectorMap<B> A = [&](const Vectors<B>& x, const Vectors<B>& y) {
    update_vertices<B>(exec, "plica::lanczos_inverse_mass", K.level.model.vertices,
                       MultiplyByInverseMass<B>{K.level.model.inverse_mass, x, y});
  };
  return largest_eigenvalue<B>(exec, A, K, 1e-3);
}

#define PLICA_INSTANTIATE(Real, Exec)                                                                         \
  template double largest_eigenvalue<Backend<Real, Exec>>(const Exec&, const VectorMap<Backend<Real, Exec>>&, \
                                                          const StiffnessAt<Backend<Real, Exec>>&, double);   \
  template double largest_eigenvalue<Backend<Real, Exec>>(const Exec&, const StiffnessAt<Backend<Real, Exec>>&);
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
