// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <functional>
#include <plica/core/level.hpp>

namespace plica {

/// y = an operator's product with x.
template <class B>
using VectorMap = std::function<void(const Vectors<B>& x, const Vectors<B>& y)>;

/// The largest eigenvalue of A K for a symmetric positive definite A and a positive semi-definite K, by the Lanczos iteration in
/// the inner product of K (Parlett, The Symmetric Eigenvalue Problem, 15.4) to a relative residual of `tolerance`, which is
/// added. Waits.
template <class B>
double largest_of_product(const typename B::Exec& exec, const Level<B>& level, const VectorMap<B>& A,
                          const VectorMap<B>& K, double tolerance);

}  // namespace plica
