// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <functional>
#include <plica/core/level.hpp>
#include <plica/drivers/elastic/elasticity.hpp>

namespace plica {

/// A level's stiffness at the state u, K; with D over a step [s] added, D its damping:
/// kernels/elastic/damping_stress.hpp.
template <class B>
struct StiffnessAt {
  const Level<B>& level;
  const Elasticity<B>& elasticity;
  Vectors<B> u;
  double over = 0;  ///< times D [1/s]
};

/// y = A x
template <class B>
using VectorMap = std::function<void(const Vectors<B>& x, const Vectors<B>& y)>;

/// The largest eigenvalue of A K for a symmetric positive definite A, by the Lanczos iteration in
/// the inner product of K (Parlett, The Symmetric Eigenvalue Problem, 15.4), of A where K is
/// indefinite, to a relative residual of `tolerance`, which is added: on the sure side. It
/// converges where the power iteration still crawls. 0 where none is above it. Waits.
template <class B>
double largest_eigenvalue(const typename B::Exec& exec, const VectorMap<B>& A,
                          const StiffnessAt<B>& K, double tolerance);

/// w_max^2 of M^-1 K [1/s^2], the same to 1e-3.
template <class B>
double largest_eigenvalue(const typename B::Exec& exec, const StiffnessAt<B>& K);

/// The Rayleigh quotient of M^-1 K x [1/s^2]: never above w_max^2, and that where x has even a
/// little of the fastest motion. Waits.
template <class B>
double excited_eigenvalue(const typename B::Exec& exec, const StiffnessAt<B>& K,
                          const Vectors<B>& x);

}  // namespace plica
