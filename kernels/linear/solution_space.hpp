// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/linear/block_product.hpp>
#include <plica/kernels/reduce.hpp>

// The first guess of a linear solve: of all combinations of the last few solutions, the one nearest to this system's in its own norm
// (Fischer, Projection techniques for iterative solution of Ax = b with successive right-hand sides, CMAME 163, 1998).
namespace plica {

/// The last solutions w, and q = A w for the matrix of now.
template <class B>
struct SolutionSpace {
  static constexpr int size = 4;
  static constexpr int sums = size * (size + 1) / 2 + size;
  Vectors<B> w[size], q[size];
  Kokkos::View<double*, typename B::Memory>
      products;  ///< [sums] w_i.q_j for i <= j, then w_i.r; afterwards the weights come first
};

/// q = A w for all of them, with A read once.
template <class B>
struct SpaceProducts {
  using Real = typename B::Real;
  BlockMatrix<B> A;
  SolutionSpace<B> space;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    constexpr int m = SolutionSpace<B>::size;
    Real y[m][3] = {};
    for (int s = A.first(a); s < A.first(a + 1); ++s) {
      const Real* const block = &A.value(s, 0);
      const int b = A.column(s);
      for (int i = 0; i < m; ++i)
        for (int k = 0; k < 3; ++k) {
          const Real x = space.w[i](b, k);
          for (int c = 0; c < 3; ++c) y[i][c] += block[3 * k + c] * x;
        }
    }
    for (int i = 0; i < m; ++i)
      for (int k = 0; k < 3; ++k) space.q[i](a, k) = y[i][k];
  }
};

template <class B>
struct SpaceSums {
  SolutionSpace<B> space;
  Vectors<B> r;
  KOKKOS_INLINE_FUNCTION Sums<SolutionSpace<B>::sums> operator()(int a) const {
    constexpr int m = SolutionSpace<B>::size;
    Sums<SolutionSpace<B>::sums> sums;
    for (int k = 0; k < 3; ++k) {
      int at = 0;
      for (int i = 0; i < m; ++i)
        for (int j = i; j < m; ++j) sums[at++] += static_cast<double>(space.w[i](a, k) * space.q[j](a, k));
      for (int i = 0; i < m; ++i) sums[at++] += static_cast<double>(space.w[i](a, k) * r(a, k));
    }
    return sums;
  }
};

/// The weights, by Cholesky's method; solutions that the others make up to rounding are left out.
template <class B>
struct SpaceWeights {
  Kokkos::View<double*, typename B::Memory> products;
  double least;  ///< what must be left of a solution, of its square
  KOKKOS_INLINE_FUNCTION void operator()(int) const {
    constexpr int m = SolutionSpace<B>::size;
    double G[m][m], y[m];
    int at = 0;
    for (int i = 0; i < m; ++i)
      for (int j = i; j < m; ++j) G[j][i] = products(at++);
    for (int i = 0; i < m; ++i) y[i] = products(at++);
    for (int j = 0; j < m; ++j) {
      const double whole = G[j][j];
      for (int k = 0; k < j; ++k) G[j][j] -= G[j][k] * G[j][k];
      const bool used = G[j][j] > least * whole;
      const double inverse = used ? 1 / Kokkos::sqrt(G[j][j]) : 0.0;
      for (int i = j + 1; i < m; ++i) {
        for (int k = 0; k < j; ++k) G[i][j] -= G[i][k] * G[j][k];
        G[i][j] *= inverse;
      }
      for (int k = 0; k < j; ++k) y[j] -= G[j][k] * y[k];
      y[j] *= inverse, G[j][j] = inverse;
    }
    for (int j = m - 1; j >= 0; --j) {
      for (int i = j + 1; i < m; ++i) y[j] -= G[i][j] * y[i];
      y[j] *= G[j][j];
      products(j) = Kokkos::isfinite(y[j]) ? y[j] : 0.0;
    }
  }
};

/// x = sum of weight * w, r -= sum of weight * q
template <class B>
struct SpaceGuess {
  using Real = typename B::Real;
  SolutionSpace<B> space;
  Vectors<B> r, x;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    for (int i = 0; i < SolutionSpace<B>::size; ++i) {
      const Real weight = static_cast<Real>(space.products(i));
      if (weight == 0) continue;
      for (int k = 0; k < 3; ++k) x(a, k) += weight * space.w[i](a, k), r(a, k) -= weight * space.q[i](a, k);
    }
  }
};

}  // namespace plica
