// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/backend.hpp>

namespace plica {

/// The blocks (I, J), I <= J, of P^T A P as constant sums over the blocks of A: block k = sum of weight * block `fine` of A over
/// [first(k), first(k+1)), to go to `upper` and, transposed, to `lower`.
template <class B>
struct GalerkinMap {
  Indices<B> first;
  Indices<B> fine;
  Scalars<B> weight;  ///< P_iI P_jJ
  Indices<B> upper, lower;

  int blocks() const { return static_cast<int>(upper.extent(0)); }
};

}  // namespace plica
