// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/linear/packed_rows.hpp>
#include <plica/kernels/transfer.hpp>

// Chebyshev polynomials of the fourth kind in D^-1 A, D the vertex blocks (Lottes, Optimal polynomial smoothers for multigrid V-cycles,
// 2022, arXiv:2202.08830, alg. 1): they need the largest eigenvalue only, which a few power iterations bound.
//   d_1 = 4/(3 lambda) D^-1 r;   x += d_k, r -= A d_k, d_(k+1) = (2k-1)/(2k+3) d_k + (8k+4)/((2k+3) lambda) D^-1 r
// As polynomials in D^-1 A they are self-adjoint, so that a symmetric cycle of them preconditions conjugate gradients. Directions d are stored
// times the scales of packed_rows.hpp.
namespace plica {

template <class B>
struct ChebyshevStart {
  using Real = typename B::Real;
  Scalars<B> scale;
  Blocks<B> inverse_diagonal;
  Doubles<B> largest;
  Vectors<B> r, d, x;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    const Real w = static_cast<Real>(4 / (3 * largest(0)));
    const Vec3<Real> z = block_at<B>(inverse_diagonal, a) * vector_at<B>(r, a);
    for (int k = 0; k < 3; ++k) d(a, k) = scale(a) * w * z[k], x(a, k) = 0;
  }
};

/// x += d, r -= A d, next = keep d + gain/lambda D^-1 r; `last`: x += next too.
template <class B>
struct ChebyshevStep {
  using Real = typename B::Real;
  PackedRows<B> A;
  Blocks<B> inverse_diagonal;
  Doubles<B> largest;
  Vectors<B> d, r, x, next;
  Real keep, gain;
  bool last;

  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    const Real t = A.scale(a);
    const Vec3<Real> direction = (1 / t) * vector_at<B>(d, a);
    const Vec3<Real> residual = vector_at<B>(r, a) - t * packed_row_product<B>(A, a, d);
    const Vec3<Real> z = block_at<B>(inverse_diagonal, a) * residual;
    const Real w = gain / static_cast<Real>(largest(0));
    for (int k = 0; k < 3; ++k) {
      const Real ahead = keep * direction[k] + w * z[k];
      r(a, k) = residual[k];
      x(a, k) += last ? direction[k] + ahead : direction[k];
      next(a, k) = t * ahead;
    }
  }
};

/// A first direction d = P y, from a coarser level.
template <class B>
struct ChebyshevCorrection {
  Scalars<B> scale;
  SparseRows<B> up;
  Vectors<B> y, d;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const { set_vector<B>(d, a, scale(a) * row_product<B>(up, a, y)); }
};

}  // namespace plica
