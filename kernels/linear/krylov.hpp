// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/linear/vertex_blocks.hpp>
#include <plica/kernels/reduce.hpp>

// Preconditioned conjugate gradients (Saad, Iterative Methods for Sparse Linear Systems, alg. 9.1) with its scalars on the device, where they
// also decide when to stop: iterations after that change nothing, so that the host may look only now and then.
namespace plica {

/// Where a scalar stands among CgScalars.
namespace cg {
enum : int { curvature, product, last_product, square, right_side, start, alpha, beta, stopped, iterations, count };
constexpr double running = 0, converged = 1, indefinite = 2, not_finite = 3;  // values of `stopped`
}  // namespace cg

template <class B>
using CgScalars = Kokkos::View<double*, typename B::Memory>;

/// z = D r and r.z, with D the inverse vertex blocks: the square of the norm that says when it has converged, whatever the
/// preconditioner.
template <class B>
struct CgSquare {
  Blocks<B> inverse_diagonal;
  Vectors<B> r, z;
  KOKKOS_INLINE_FUNCTION Sums<1> operator()(int a) const {
    const auto residual = vector_at<B>(r, a), answer = vertex_block_product<B>(inverse_diagonal, a, residual);
    for (int k = 0; k < 3; ++k) z(a, k) = answer[k];
    return {{static_cast<double>(dot(residual, answer))}};
  }
};

/// x = 0; z = D r, r.z
template <class B>
struct CgZero {
  CgSquare<B> square;
  Vectors<B> x;
  KOKKOS_INLINE_FUNCTION Sums<1> operator()(int a) const {
    for (int k = 0; k < 3; ++k) x(a, k) = 0;
    return square(a);
  }
};

template <class B>
struct CgBegin {
  CgScalars<B> s;
  KOKKOS_INLINE_FUNCTION void operator()(int) const {
    s(cg::right_side) = s(cg::start) = s(cg::square);
    s(cg::iterations) = s(cg::last_product) = 0;
    s(cg::stopped) = s(cg::square) > 0 ? cg::running : s(cg::square) == 0 ? cg::converged : cg::not_finite;
    if (!Kokkos::isfinite(s(cg::square))) s(cg::stopped) = cg::not_finite;
  }
};

/// After a guess other than zero; it may be the solution already.
template <class B>
struct CgGuess {
  CgScalars<B> s;
  double tolerance;
  KOKKOS_INLINE_FUNCTION void operator()(int) const {
    s(cg::start) = s(cg::square);
    if (s(cg::stopped) != cg::running) return;
    if (s(cg::square) == 0 || (tolerance >= 0 && s(cg::square) <= tolerance * tolerance * s(cg::right_side)))
      s(cg::stopped) = cg::converged;
  }
};

/// x . y
template <class B>
struct CgDot {
  Vectors<B> x, y;
  KOKKOS_INLINE_FUNCTION Sums<1> operator()(int a) const {
    double sum = 0;
    for (int k = 0; k < 3; ++k) sum += static_cast<double>(x(a, k) * y(a, k));
    return {{sum}};
  }
};

/// sum -= x
template <class B>
struct SubtractVectors {
  Vectors<B> x, sum;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    for (int k = 0; k < 3; ++k) sum(a, k) -= x(a, k);
  }
};

/// beta = r.z / the last r.z
template <class B>
struct CgTurn {
  CgScalars<B> s;
  int product;  ///< where r.z stands
  KOKKOS_INLINE_FUNCTION void operator()(int) const {
    s(cg::beta) = s(cg::last_product) > 0 ? s(product) / s(cg::last_product) : 0.0;
    s(cg::last_product) = s(product);
  }
};

/// p = z + beta p
template <class B>
struct CgDirection {
  CgScalars<B> s;
  Vectors<B> z, p;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    const auto beta = static_cast<typename B::Real>(s(cg::beta));
    for (int k = 0; k < 3; ++k) p(a, k) = z(a, k) + (beta != 0 ? beta * p(a, k) : typename B::Real(0));
  }
};

/// alpha = r.z / p.q; a direction without positive curvature ends it, and is not followed.
template <class B>
struct CgStep {
  CgScalars<B> s;
  KOKKOS_INLINE_FUNCTION void operator()(int) const {
    if (s(cg::stopped) == cg::running && !(s(cg::curvature) > 0)) s(cg::stopped) = cg::indefinite;
    s(cg::alpha) = s(cg::stopped) == cg::running ? s(cg::last_product) / s(cg::curvature) : 0.0;
  }
};

/// x += alpha p, r -= alpha q; z = D r, r.z
template <class B>
struct CgAdvance {
  CgScalars<B> s;
  CgSquare<B> square;
  Vectors<B> x, p, q;
  KOKKOS_INLINE_FUNCTION Sums<1> operator()(int a) const {
    const auto alpha = static_cast<typename B::Real>(s(cg::alpha));
    if (alpha != 0)
      for (int k = 0; k < 3; ++k) x(a, k) += alpha * p(a, k), square.r(a, k) -= alpha * q(a, k);
    return square(a);
  }
};

template <class B>
struct CgJudge {
  CgScalars<B> s;
  double tolerance;  ///< of |r| / |b|; below 0: it goes on
  KOKKOS_INLINE_FUNCTION void operator()(int) const {
    if (s(cg::stopped) != cg::running) return;
    s(cg::iterations) += 1;
    if (!Kokkos::isfinite(s(cg::square)))
      s(cg::stopped) = cg::not_finite;
    else if (s(cg::square) == 0 || (tolerance >= 0 && s(cg::square) <= tolerance * tolerance * s(cg::right_side)))
      s(cg::stopped) = cg::converged;
  }
};

}  // namespace plica
