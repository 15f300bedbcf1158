// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/linear/vertex_blocks.hpp>

// Preconditioned conjugate gradients (Saad, Iterative Methods for Sparse Linear Systems, alg. 9.1).
// The scalars are on the device, where they also decide when to stop. Iterations after that change
// nothing, so that the host need not look at every iteration. A struct without operator()(int)
// follows a sum, see reduce().
// see reduce().
namespace plica {

/// Index of each scalar among those of a solve.
namespace cg {
enum : int {
  curvature,
  product,
  last_product,
  square,
  right_side,
  start,
  alpha,
  stopped,
  iterations,
  tolerance,
  count
};
// Values of `stopped`
constexpr double running = 0, converged = 1, indefinite = 2, not_finite = 3, unsound = 4;
}  // namespace cg

/// Computes z = D r and r.z, with D the inverse vertex blocks. r.z is the square of the norm that
/// decides convergence, whatever the preconditioner.
template <class B>
struct CgSquare {
  Blocks<B> inverse_diagonal;
  Vectors<B> r, z;
  KOKKOS_INLINE_FUNCTION Sums<1> operator()(int a) const { return of(a, vector_at<B>(r, a)); }
  KOKKOS_INLINE_FUNCTION Sums<1> of(int a, const Vec3<typename B::Real>& residual) const {
    const auto answer = block_at<B>(inverse_diagonal, a) * residual;
    set_vector<B>(z, a, answer);
    return {{static_cast<double>(dot(residual, answer))}};
  }
};

/// Starts from x = 0: computes z = D r and r.z.
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
  Doubles<B> s;
  KOKKOS_INLINE_FUNCTION void operator()() const {
    s(cg::start) = s(cg::right_side) = s(cg::square);
    s(cg::iterations) = s(cg::last_product) = 0;
    s(cg::stopped) = s(cg::square) > 0    ? cg::running
                     : s(cg::square) >= 0 ? cg::converged
                                          : cg::not_finite;
    if (!Kokkos::isfinite(s(cg::square))) s(cg::stopped) = cg::not_finite;
  }
};

/// Sets the tolerance of |r| / |b|; below 0 the iteration goes on.
template <class B>
struct CgTolerance {
  Doubles<B> s;
  Changing<B, double> tolerance;
  KOKKOS_INLINE_FUNCTION void operator()(int) const { s(cg::tolerance) = *tolerance; }
};

/// Returns true where r is 0 or small enough for the tolerance.
template <class B>
KOKKOS_INLINE_FUNCTION bool is_solved(const Doubles<B>& s) {
  const double tolerance = s(cg::tolerance);
  return s(cg::square) == 0 ||
         (tolerance >= 0 && s(cg::square) <= tolerance * tolerance * s(cg::right_side));
}

/// Begins after a guess other than zero, which may be the solution already.
template <class B>
struct CgGuess {
  Doubles<B> s;
  KOKKOS_INLINE_FUNCTION void operator()() const {
    s(cg::start) = s(cg::square);
    if (s(cg::stopped) != cg::running) return;
    if (is_solved<B>(s)) s(cg::stopped) = cg::converged;
  }
};

/// Computes the direction p = z + beta p, beta = r.z / the last r.z.
template <class B>
struct CgDirection {
  Doubles<B> s;
  int product;  ///< index of r.z
  Vectors<B> z, p;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    const double before = s(cg::last_product);
    const auto beta = static_cast<typename B::Real>(before > 0 ? s(product) / before : 0.0);
    const auto last = beta != 0 ? beta * vector_at<B>(p, a) : Vec3<typename B::Real>{};
    set_vector<B>(p, a, vector_at<B>(z, a) + last);
  }
};

/// Computes alpha = r.z / p.q. A direction without positive curvature ends the solve and is not
/// followed. Where r.z is not positive, the preconditioner is not positive definite (unsound).
template <class B>
struct CgStep {
  Doubles<B> s;
  int product;  ///< index of r.z
  KOKKOS_INLINE_FUNCTION void operator()() const {
    if (s(cg::stopped) == cg::running && !(s(product) > 0)) s(cg::stopped) = cg::unsound;
    if (s(cg::stopped) == cg::running && !(s(cg::curvature) > 0)) s(cg::stopped) = cg::indefinite;
    s(cg::alpha) = s(cg::stopped) == cg::running ? s(product) / s(cg::curvature) : 0.0;
    s(cg::last_product) = s(product);
  }
};

/// Advances by x += alpha p, r -= alpha q, and computes z = D r and r.z.
template <class B>
struct CgAdvance {
  Doubles<B> s;
  CgSquare<B> square;
  Vectors<B> x, p, q;
  KOKKOS_INLINE_FUNCTION Sums<1> operator()(int a) const {
    const auto alpha = static_cast<typename B::Real>(s(cg::alpha));
    if (alpha == 0) return square(a);
    const auto answer = vector_at<B>(x, a) + alpha * vector_at<B>(p, a);
    const auto residual = vector_at<B>(square.r, a) - alpha * vector_at<B>(q, a);
    set_vector<B>(x, a, answer), set_vector<B>(square.r, a, residual);
    return square.of(a, residual);
  }
};

template <class B>
struct CgJudge {
  Doubles<B> s;
  KOKKOS_INLINE_FUNCTION void operator()() const {
    if (s(cg::stopped) != cg::running) return;
    s(cg::iterations) += 1;
    if (!Kokkos::isfinite(s(cg::square)))
      s(cg::stopped) = cg::not_finite;
    else if (is_solved<B>(s))
      s(cg::stopped) = cg::converged;
  }
};

// First guess of a linear solve: of all combinations of the last few solutions, the one nearest to
// this system's solution in the norm of A. Fischer, Projection techniques for iterative solution of
// Ax = b with successive right-hand sides, CMAME 163, 1998.

/// Last solutions w, and q = A w for the present matrix.
template <class B>
struct SolutionSpace {
  static constexpr int size = 4;
  static constexpr int sums = size * (size + 1) / 2 + size;
  Vectors<B> w[size], q[size];
  /// [sums] w_i.q_j for i <= j, then w_i.r; SpaceWeights writes the weights over the first of them
  Doubles<B> products;
};

/// Computes q = A w for all solutions, with A read once.
template <class B>
struct SpaceProducts {
  using Real = typename B::Real;
  BlockMatrix<B> A;
  SolutionSpace<B> space;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    constexpr int m = SolutionSpace<B>::size;
    BlockSum<Real> y[m];
    const int own = A.diagonal(a), last = A.first(a + 1);
    for (int s = A.first(a); s < own; ++s)
      for (int i = 0; i < m; ++i)
        y[i].add_turned(&A.value(A.place(s), 0), &space.w[i](A.column(s), 0));
    for (int s = own; s < last; ++s)
      for (int i = 0; i < m; ++i) y[i].add(&A.value(A.place(s), 0), &space.w[i](A.column(s), 0));
    for (int i = 0; i < m; ++i) set_vector<B>(space.q[i], a, y[i].sum());
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
        for (int j = i; j < m; ++j)
          sums[at++] += static_cast<double>(space.w[i](a, k) * space.q[j](a, k));
      for (int i = 0; i < m; ++i) sums[at++] += static_cast<double>(space.w[i](a, k) * r(a, k));
    }
    return sums;
  }
};

/// Computes the weights by Cholesky's method. Solutions that the others make up to rounding are
/// left out.
template <class B>
struct SpaceWeights {
  Doubles<B> products;
  double least;  ///< least part of a solution's square that the others must leave
  KOKKOS_INLINE_FUNCTION void operator()() const {
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

/// Computes x += sum of weight * w, r -= sum of weight * q.
template <class B>
struct SpaceGuess {
  using Real = typename B::Real;
  SolutionSpace<B> space;
  Vectors<B> r, x;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    for (int i = 0; i < SolutionSpace<B>::size; ++i) {
      const Real weight = static_cast<Real>(space.products(i));
      if (weight == 0) continue;
      for (int k = 0; k < 3; ++k)
        x(a, k) += weight * space.w[i](a, k), r(a, k) -= weight * space.q[i](a, k);
    }
  }
};

}  // namespace plica
