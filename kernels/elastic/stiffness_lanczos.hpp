// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/model.hpp>
#include <plica/kernels/vectors.hpp>

// Vertex kernels of the Lanczos iteration on A K in the inner product of K or A.
namespace plica {

/// Computes y = K x and x.y; partial: the shares of -K x. A vertex whose inverse mass is 0 does not
/// move.
template <class B>
struct StiffnessProduct {
  using Real = typename B::Real;
  VertexModel<B> model;
  Vectors<B> partial, x, y;
  KOKKOS_INLINE_FUNCTION Sums<1> operator()(int a) const {
    const bool moves = model.inverse_mass(a) > 0;
    const Vec3<Real> product =
        moves ? Real(-1) * sum_of_shares<B>(model.shares, partial, a) : Vec3<Real>{};
    set_vector<B>(y, a, product);
    double dot = 0;
    for (int k = 0; k < 3; ++k)
      dot += static_cast<double>(x(a, k)) * static_cast<double>(product[k]);
    return {{dot}};
  }
};

/// Computes w = M^-1 x.
template <class B>
struct MultiplyByInverseMass {
  Scalars<B> inverse_mass;
  Vectors<B> x, w;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    set_vector<B>(w, a, inverse_mass(a) * vector_at<B>(x, a));
  }
};

/// Computes w = scale w - alpha v - beta before.
template <class B>
struct NextLanczosVector {
  using Real = typename B::Real;
  Vectors<B> w, v, before;
  Real scale, alpha, beta;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    for (int k = 0; k < 3; ++k) w(a, k) = scale * w(a, k) - alpha * v(a, k) - beta * before(a, k);
  }
};

}  // namespace plica
