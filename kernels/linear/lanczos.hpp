// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/linear/krylov.hpp>

// Lanczos iteration for the largest eigenvalue of D^-1 A, D^-1 the inverse vertex blocks (Parlett,
// The Symmetric Eigenvalue Problem, 13). Its vectors r have the product r . D^-1 r; q = r / beta
// has length 1:
//
//   r_next = A D^-1 q - alpha q - beta q_last,   alpha = q . D^-1 A D^-1 q,   beta_next = |r_next|
//
// The tridiagonal matrix of alphas and betas has nearly the largest eigenvalue after a few steps.
// This holds also where one single sliver causes that eigenvalue. Power iterations take a hundred
// steps there, since the vector must grow out of all the rest.
namespace plica {

/// Sets r to pseudo-random forces. Where the motion is given, they have no effect.
template <class B>
struct BlockLanczosStart {
  Vectors<B> r;
  Indices<B> number = {};  ///< number that is hashed for each vertex; empty: its own
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    const int of = number.extent(0) > 0 ? number(a) : a;
    for (int k = 0; k < 3; ++k) r(a, k) = static_cast<typename B::Real>(hashed(of, k));
  }
};

/// Computes w /= beta, where w has been made as A z, and returns alpha = w . z / beta.
template <class B>
struct LanczosProduct {
  Doubles<B> square;  ///< beta^2
  Vectors<B> z, w;
  KOKKOS_INLINE_FUNCTION Sums<1> operator()(int a) const { return of(a, vector_at<B>(w, a)); }
  KOKKOS_INLINE_FUNCTION Sums<1> of(int a, const Vec3<typename B::Real>& product) const {
    const double scale = square(0) > 0 ? 1 / Kokkos::sqrt(square(0)) : 0.0;
    const auto row = static_cast<typename B::Real>(scale) * product;
    set_vector<B>(w, a, row);
    return {{scale * static_cast<double>(dot(vector_at<B>(z, a), row))}};
  }
};

/// Computes w = A z / beta with the product by a matrix, and returns alpha = w . z / beta.
template <class B>
struct BlockLanczosProduct {
  BlockMatrix<B> A;
  LanczosProduct<B> next;
  KOKKOS_INLINE_FUNCTION Sums<1> operator()(int a) const {
    return next.of(a, block_row_product<B>(A, a, next.z));
  }
};

/// Sets r to the next vector and q_last to the present q. Computes z = D^-1 r and r.z, which is
/// beta^2.
template <class B>
struct BlockLanczosNext {
  using Real = typename B::Real;
  CgSquare<B> size;
  Doubles<B> square, alpha;
  Vectors<B> w, last;
  bool first;  ///< true in the first step, which has no q_last
  KOKKOS_INLINE_FUNCTION Sums<1> operator()(int a) const {
    const double beta = square(0) > 0 ? Kokkos::sqrt(square(0)) : 0.0;
    const auto q = static_cast<Real>(beta > 0 ? 1 / beta : 0.0) * vector_at<B>(size.r, a);
    auto next = vector_at<B>(w, a) - static_cast<Real>(alpha(0)) * q;
    if (!first) next -= static_cast<Real>(beta) * vector_at<B>(last, a);
    set_vector<B>(last, a, q), set_vector<B>(size.r, a, next);
    return size.of(a, next);
  }
};

}  // namespace plica
