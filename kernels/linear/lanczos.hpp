// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/linear/krylov.hpp>

// The Lanczos iteration for the largest eigenvalue of D^-1 A, D^-1 the inverse vertex blocks
// (Parlett, The Symmetric Eigenvalue Problem, 13): of vectors r in the product r . D^-1 r, with q =
// r / beta of length 1,
//
//   r_next = A D^-1 q - alpha q - beta q_last,   alpha = q . D^-1 A D^-1 q,   beta_next = |r_next|
//
// The tridiagonal matrix of alphas and betas has nearly the largest eigenvalue after a few steps,
// also where that is of a single sliver: power iterations, which have to grow out of all the rest,
// take a hundred there.
namespace plica {

/// Forces without order; nothing answers those where the motion is given.
template <class B>
struct BlockLanczosStart {
  Vectors<B> r;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    unsigned seed = static_cast<unsigned>(a) * 2654435761U + 12345U;
    for (int k = 0; k < 3; ++k) {
      seed = seed * 1664525U + 1013904223U;
      r(a, k) = static_cast<typename B::Real>(seed >> 8) / (1 << 23) - 1;
    }
  }
};

/// w /= beta, where w has been made as A z, and alpha = w . z / beta
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

/// The same with the product by a matrix.
template <class B>
struct BlockLanczosProduct {
  BlockMatrix<B> A;
  LanczosProduct<B> next;
  KOKKOS_INLINE_FUNCTION Sums<1> operator()(int a) const {
    return next.of(a, block_row_product<B>(A, a, next.z));
  }
};

/// r becomes the next, q_last its q; z = D^-1 r and r.z, which is beta^2.
template <class B>
struct BlockLanczosNext {
  using Real = typename B::Real;
  CgSquare<B> size;
  Doubles<B> square, alpha;
  Vectors<B> w, last;
  bool first;  ///< there is no q_last
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
