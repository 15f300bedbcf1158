// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/vectors.hpp>

// Conjugate gradients on A p = v over the vertices that forces move, preconditioned by the mass m.
// Residuals r are measured by r.m r.
namespace plica {

/// Computes r = v - answer and r.m r.
template <class B>
struct StartResidual {
  VertexModel<B> model;
  Vectors<B> v, answer, r;
  KOKKOS_INLINE_FUNCTION Sums<1> operator()(int a) const {
    double square = 0;
    for (int k = 0; k < 3; ++k) {
      r(a, k) = model.inverse_mass(a) > 0 ? v(a, k) - answer(a, k) : 0;
      square += static_cast<double>(model.mass(a)) * static_cast<double>(r(a, k)) *
                static_cast<double>(r(a, k));
    }
    return {{square}};
  }
};

/// Computes p += alpha s, r -= alpha A s and r.m r.
template <class B>
struct MoveAlong {
  using Real = typename B::Real;
  VertexModel<B> model;
  Vectors<B> s, answer, p, r;
  Real alpha;
  KOKKOS_INLINE_FUNCTION Sums<1> operator()(int a) const {
    double square = 0;
    for (int k = 0; k < 3 && model.inverse_mass(a) > 0; ++k) {
      p(a, k) += alpha * s(a, k), r(a, k) -= alpha * answer(a, k);
      square += static_cast<double>(model.mass(a)) * static_cast<double>(r(a, k)) *
                static_cast<double>(r(a, k));
    }
    return {{square}};
  }
};

}  // namespace plica
