// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/linear/vertex_blocks.hpp>

// Chebyshev polynomials of the fourth kind in D^-1 A, D the vertex blocks (Lottes, Optimal polynomial smoothers for multigrid V-cycles,
// 2022, arXiv:2202.08830, alg. 1): they need the largest eigenvalue only, which a few power iterations bound.
//   d_1 = 4/(3 lambda) D^-1 r;   x += d_k, r -= A d_k, d_(k+1) = (2k-1)/(2k+3) d_k + (8k+4)/((2k+3) lambda) D^-1 r
// As polynomials in D^-1 A they are self-adjoint, so that a symmetric cycle of them preconditions conjugate gradients.
namespace plica {

template <class B>
struct ChebyshevStart {
  using Real = typename B::Real;
  Blocks<B> inverse_diagonal;
  Doubles<B> largest;
  Vectors<B> r, d, x;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    const Real w = static_cast<Real>(4 / (3 * largest(0)));
    const Vec3<Real> z = block_at<B>(inverse_diagonal, a) * vector_at<B>(r, a);
    for (int k = 0; k < 3; ++k) d(a, k) = w * z[k], x(a, k) = 0;
  }
};

/// x += d, r -= A d, next = keep d + gain/lambda D^-1 r; `last`: x += next too.
template <class B>
struct ChebyshevStep {
  using Real = typename B::Real;
  BlockMatrix<B> A;
  Blocks<B> inverse_diagonal;
  Doubles<B> largest;
  Vectors<B> d, r, x, next;
  Real keep, gain;
  bool last;

  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    const Vec3<Real> direction = vector_at<B>(d, a), residual = vector_at<B>(r, a) - block_row_product<B>(A, a, d);
    const Vec3<Real> z = block_at<B>(inverse_diagonal, a) * residual;
    const Real w = gain / static_cast<Real>(largest(0));
    for (int k = 0; k < 3; ++k) {
      const Real ahead = keep * direction[k] + w * z[k];
      r(a, k) = residual[k];
      x(a, k) += last ? direction[k] + ahead : direction[k];
      next(a, k) = ahead;
    }
  }
};

/// Power iteration for the largest eigenvalue of D^-1 A: x = D^-1 r / |r|, r = A x, in the norm |r|^2 = r . D^-1 r, which tends to it.
template <class B>
struct PowerStart {
  Vectors<B> r;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    unsigned seed = static_cast<unsigned>(a) * 2654435761U + 12345U;
    for (int k = 0; k < 3; ++k) {
      seed = seed * 1664525U + 1013904223U;
      r(a, k) = static_cast<typename B::Real>(seed >> 8) / (1 << 23) - 1;
    }
  }
};

template <class B>
struct PowerSize {
  Blocks<B> inverse_diagonal;
  Vectors<B> r, x;
  KOKKOS_INLINE_FUNCTION Sums<1> operator()(int a) const {
    const auto z = block_at<B>(inverse_diagonal, a) * vector_at<B>(r, a);
    double sum = 0;
    for (int k = 0; k < 3; ++k) sum += static_cast<double>(r(a, k)) * static_cast<double>(z[k]), x(a, k) = z[k];
    return {{sum}};
  }
};

/// r = A x / |x|
template <class B>
struct PowerProduct {
  BlockMatrix<B> A;
  Doubles<B> square;
  Vectors<B> x, r;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    const auto y = block_row_product<B>(A, a, x);
    const auto w = static_cast<typename B::Real>(square(0) > 0 ? 1 / Kokkos::sqrt(square(0)) : 0.0);
    for (int k = 0; k < 3; ++k) r(a, k) = w * y[k];
  }
};

/// lambda = margin |r|
template <class B>
struct PowerBound {
  Doubles<B> square, largest;
  double margin;
  KOKKOS_INLINE_FUNCTION void operator()(int) const {
    largest(0) = square(0) > 0 ? margin * Kokkos::sqrt(square(0)) : 1.0;
  }
};

}  // namespace plica
