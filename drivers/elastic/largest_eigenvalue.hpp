// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <functional>
#include <plica/core/level_data.hpp>
#include <plica/drivers/elastic/elasticity.hpp>

namespace plica {

/// Stiffness K of a level at the state u, plus `damping_scale` times its damping D.
/// D: see kernels/elastic/damping_stress.hpp.
template <class B>
struct StiffnessAt {
  const LevelData<B>& level;
  const Elasticity<B>& elasticity;
  Vectors<B> u;
  double damping_scale = 0;  ///< factor of D [1/s]
};

/// Function that sets y = A x.
template <class B>
using VectorMap = std::function<void(const Vectors<B>& x, const Vectors<B>& y)>;

/// Returns the largest eigenvalue of A K for a symmetric positive definite A. Waits.
/// It is found by the Lanczos iteration in the inner product of K (Parlett, The Symmetric
/// Eigenvalue Problem, 15.4), or in that of A where K is indefinite. The iteration ends at a
/// relative residual of `tolerance`, which is added: the result is on the safe side. It converges
/// much faster than the power iteration. 0 where no eigenvalue is above 0.
template <class B>
double largest_eigenvalue(const typename B::Exec& exec, const VectorMap<B>& A,
                          const StiffnessAt<B>& K, double tolerance);

/// Returns w_max^2, the largest eigenvalue of M^-1 K, to a relative residual of 1e-3 [1/s^2].
/// Waits.
template <class B>
double largest_eigenvalue(const typename B::Exec& exec, const StiffnessAt<B>& K);

/// Returns the Rayleigh quotient of the vector M^-1 K x [1/s^2]. Waits.
/// It is never above w_max^2, and near w_max^2 where x has even a little of the fastest motion.
template <class B>
double excited_eigenvalue(const typename B::Exec& exec, const StiffnessAt<B>& K,
                          const Vectors<B>& x);

}  // namespace plica
