// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/transfer.hpp>
#include <plica/kernels/vectors.hpp>

// Vertex kernels of the Lanczos iteration on M^-1/2 K M^-1/2, whose largest eigenvalue is w_max^2 [1/s^2]. A zero
// inverse mass takes the vertex out.
namespace plica {

/// p = scale M^-1/2 x
template <class B>
struct ScaleByMass {
  using Real = typename B::Real;
  Scalars<B> inverse_mass;
  Vectors<B> x, p;
  Real scale;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    const Real s = scale * Kokkos::sqrt(inverse_mass(a));
    for (int k = 0; k < 3; ++k) p(a, k) = s * x(a, k);
  }
};

/// w = M^-1/2 K p - beta v_before, and v.w; partial: the shares of -K p.
template <class B>
struct LanczosProduct {
  using Real = typename B::Real;
  VertexModel<B> model;
  Vectors<B> partial, v, before, w;
  Real beta;
  KOKKOS_INLINE_FUNCTION Sums<1> operator()(int a) const {
    const Real s = Kokkos::sqrt(model.inverse_mass(a));
    const Vec3<Real> sum = sum_of_shares<B>(model.shares, partial, a);
    double dot = 0;
    for (int k = 0; k < 3; ++k) {
      w(a, k) = -s * sum[k] - beta * before(a, k);
      dot += static_cast<double>(w(a, k)) * static_cast<double>(v(a, k));
    }
    return {{dot}};
  }
};

/// w -= alpha v, and w.w
template <class B>
struct LanczosOrthogonalise {
  using Real = typename B::Real;
  Vectors<B> v, w;
  Real alpha;
  KOKKOS_INLINE_FUNCTION Sums<1> operator()(int a) const {
    double sum = 0;
    for (int k = 0; k < 3; ++k) {
      w(a, k) -= alpha * v(a, k);
      sum += static_cast<double>(w(a, k)) * static_cast<double>(w(a, k));
    }
    return {{sum}};
  }
};

/// before = v, v = scale w
template <class B>
struct LanczosShift {
  using Real = typename B::Real;
  Vectors<B> v, w, before;
  Real scale;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    for (int k = 0; k < 3; ++k) before(a, k) = v(a, k), v(a, k) = scale * w(a, k);
  }
};

}  // namespace plica
