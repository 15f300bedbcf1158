// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <plica/core/dense.hpp>
#include <plica/drivers/elastic/largest_eigenvalue.hpp>
#include <plica/kernels/elastic/stiffness_lanczos.hpp>
#include <plica/kernels/followers.hpp>
#include <plica/kernels/halo.hpp>
#include <utility>

namespace plica {

namespace {

/// Sets y = K x and returns x.y.
template <class B>
double multiply(const typename B::Exec& exec, const StiffnessAt<B>& K, const Vectors<B>& x,
                const Vectors<B>& y, const BlockSums<B>& blocks, const Doubles<B>& result) {
  follow_masters(exec, K.level.model, x);
  K.elasticity.tangent(exec, K.level, K.u, x, K.damping_scale);
  complete_shares<B>(exec, K.level);
  reduce<B, 1>(exec, "plica::lanczos_stiffness", vertices_of<B>(K.level),
               StiffnessProduct<B>{K.level.model, K.level.partial, x, y}, blocks, result);
  return host_values(exec, result)[0];
}

/// Sets y = M^-1 x.
template <class B>
void multiply_by_inverse_mass(const typename B::Exec& exec, const LevelData<B>& level,
                              const Vectors<B>& x, const Vectors<B>& y) {
  update_vertices<B>(exec, "plica::lanczos_inverse_mass", level.model.vertices,
                     MultiplyByInverseMass<B>{level.model.inverse_mass, x, y});
}

/// Lanczos iteration for the products P and Q, which are K and A, or A and K.
/// Vectors v are not normalised: `scale` times v has length 1 in the inner product of P.
template <class B>
class Lanczos {
  using Real = typename B::Real;
  using Exec = typename B::Exec;

 public:
  Lanczos(const Exec& exec, const VectorMap<B>& A, const StiffnessAt<B>& K)
      : exec_(exec), A_(A), K_(K), n_(K.level.model.vertices), blocks_(n_, ranks_of<B>(K.level)) {}

  /// Returns the largest eigenvalue, from the inner product of K, or of A where K is indefinite.
  /// K of a compressed body may be indefinite. The iteration in its product then meets vectors
  /// without a length, and gives no bound. The product of A is always an inner product.
  double largest(double tolerance) {
    const auto A = [this](const Vectors<B>& x, const Vectors<B>& y) { return map(x, y); };
    const auto K = [this](const Vectors<B>& x, const Vectors<B>& y) { return stiffness(x, y); };
    const Found found = iterate(K, A, tolerance);
    return found.indefinite ? std::max(iterate(A, K, tolerance).bound, 0.0) : found.bound;
  }

 private:
  static constexpr int most_steps = 200;
  const Exec& exec_;
  const VectorMap<B>& A_;
  const StiffnessAt<B>& K_;
  int n_;
  Vectors<B> v_ = vectors("plica::lanczos.v"), pv_ = vectors("plica::lanczos.Pv"),
             w_ = vectors("plica::lanczos.w"), before_ = vectors("plica::lanczos.before");
  BlockSums<B> blocks_;
  Doubles<B> result_ = zeros<Doubles<B>>("plica::lanczos.result", 1);

  struct Found {
    double bound = 0;
    bool indefinite = false;  ///< true: P is indefinite, and `bound` is no bound
  };

  Vectors<B> vectors(const char* name) const {
    return zeros<Vectors<B>>(name, static_cast<std::size_t>(n_));
  }

  /// Iterates with P `product` and Q `other`: each sets y = P x or y = Q x, and returns x.y.
  template <class P, class Q>
  Found iterate(const P& product, const Q& other, double tolerance) {
    fill_from_hash<B>(exec_, "plica::lanczos_start", K_.level.model.inverse_mass, v_, blocks_,
                      result_, vertices_of<B>(K_.level),
                      K_.level.ranks ? K_.level.ranks->number : Indices<B>());
    double square = product(v_, pv_);
    if (!(square > 0)) return {0, square < 0};
    double beta = std::sqrt(square), scale = 1 / beta, scale_before = 0;
    dense::LargestRitz top(tolerance);
    for (int step = 0; step < most_steps; ++step) {
      const double alpha = scale * scale * other(pv_, w_);
      update_vertices<B>(exec_, "plica::lanczos_next", n_,
                         NextLanczosVector<B>{w_, v_, before_, static_cast<Real>(scale),
                                              static_cast<Real>(alpha * scale),
                                              static_cast<Real>(beta * scale_before)});
      std::swap(before_, v_), std::swap(v_, w_);
      square = product(v_, pv_);
      beta = square < 0 ? 0 : std::sqrt(square);
      if (top.add(alpha, beta)) break;
      scale_before = std::exchange(scale, 1 / beta);
    }
    return {top.bound(), square < 0};
  }

  double stiffness(const Vectors<B>& x, const Vectors<B>& y) {
    return multiply(exec_, K_, x, y, blocks_, result_);
  }

  double map(const Vectors<B>& x, const Vectors<B>& y) {
    A_(x, y);
    reduce<B, 1>(exec_, "plica::lanczos_product", vertices_of<B>(K_.level), Dot<B>{y, x}, blocks_,
                 result_);
    return host_values(exec_, result_)[0];
  }
};

}  // namespace

template <class B>
double largest_eigenvalue(const typename B::Exec& exec, const VectorMap<B>& A,
                          const StiffnessAt<B>& K, double tolerance) {
  return Lanczos<B>(exec, A, K).largest(tolerance);
}

template <class B>
double largest_eigenvalue(const typename B::Exec& exec, const StiffnessAt<B>& K) {
  const VectorMap<B> A = [&](const Vectors<B>& x, const Vectors<B>& y) {
    multiply_by_inverse_mass(exec, K.level, x, y);
  };
  return largest_eigenvalue<B>(exec, A, K, 1e-3);
}

template <class B>
double excited_eigenvalue(const typename B::Exec& exec, const StiffnessAt<B>& K,
                          const Vectors<B>& x) {
  const int n = K.level.model.vertices;
  const auto vectors = [&](const char* name) {
    return zeros<Vectors<B>>(name, static_cast<std::size_t>(n));
  };
  const Vectors<B> y = vectors("plica::excited.Kx"), w = vectors("plica::excited.w"),
                   z = vectors("plica::excited.Kw");
  const BlockSums<B> blocks(n, ranks_of<B>(K.level));
  const auto result = zeros<Doubles<B>>("plica::excited.result", 1);
  multiply(exec, K, x, y, blocks, result);
  multiply_by_inverse_mass(exec, K.level, y, w);
  // w.M w
  reduce<B, 1>(exec, "plica::excited_mass", vertices_of<B>(K.level), Dot<B>{w, y}, blocks, result);
  const double mass = host_values(exec, result)[0];
  return mass > 0 ? multiply(exec, K, w, z, blocks, result) / mass : 0.0;
}

#define PLICA_INSTANTIATE(Real, Exec)                                                              \
  template double largest_eigenvalue<Backend<Real, Exec>>(                                         \
      const Exec&, const VectorMap<Backend<Real, Exec>>&, const StiffnessAt<Backend<Real, Exec>>&, \
      double);                                                                                     \
  template double largest_eigenvalue<Backend<Real, Exec>>(                                         \
      const Exec&, const StiffnessAt<Backend<Real, Exec>>&);                                       \
  template double excited_eigenvalue<Backend<Real, Exec>>(                                         \
      const Exec&, const StiffnessAt<Backend<Real, Exec>>&, const Vectors<Backend<Real, Exec>>&);
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
