// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/level_data.hpp>
#include <plica/kernels/vectors.hpp>

// Sliding vertices in the system A x = r of an implicit stage. With P the projection across the
// directions n that hold the vertices, P A P + s n n^T takes the place of A. It is as positive
// definite as A is for motions that are free, and its solution for P r is free. So all linear
// solvers and preconditioners take it as they take A. s is of the size of the vertex's own block.
namespace plica {

/// Removes from a matrix what acts along the directions that hold sliding vertex i: `rows` from the
/// left, else from the right.
template <class B>
KOKKOS_INLINE_FUNCTION void hold_side(const SlidingVertices<B>& sliding, int i, bool rows,
                                      Mat3<double>& M) {
  for (int which = 0; which < 2; ++which) {
    const Vec3<double> n = sliding.normal(i, which);
    const Mat3<double> N = outer(n, n);
    M = M - (rows ? N * M : M * N);
  }
}

/// Returns P M P + s n n^T for the own block of sliding vertex i.
template <class B>
KOKKOS_INLINE_FUNCTION Mat3<double> held_own_block(const SlidingVertices<B>& sliding, int i,
                                                   Mat3<double> M) {
  const double s = Kokkos::abs(trace(M)) / 3;
  hold_side(sliding, i, true, M), hold_side(sliding, i, false, M);
  for (int which = 0; which < 2; ++which) {
    const Vec3<double> n = sliding.normal(i, which);
    M = M + s * outer(n, n);
  }
  return M;
}

/// Holds sliding vertices in their own blocks of A.
template <class B>
struct HoldBlocks {
  SlidingVertices<B> sliding;
  Blocks<B> blocks;

  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    using Real = typename B::Real;
    const int a = sliding.vertex(i);
    const SymMat3<Real> own = block_at<B>(blocks, a);
    SymMat3<double> exact;
    for (int k = 0; k < 6; ++k) exact[k] = static_cast<double>(own[k]);
    const SymMat3<double> held = six_of(held_own_block(sliding, i, matrix_of(exact)));
    for (int k = 0; k < 6; ++k) blocks(a, k) = static_cast<Real>(held[k]);
  }
};

/// Holds sliding vertices in a row of an assembled A.
template <class B>
struct HoldMatrix {
  SlidingVertices<B> sliding;
  BlockMatrix<B> A;

  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    using Real = typename B::Real;
    const int own = A.diagonal(a), row = sliding.place(a);
    for (int s = A.first(a); s < A.first(a + 1); ++s) {
      const int column = sliding.place(A.column(s));
      if ((row < 0 && column < 0) || !A.is_stored(a, s)) continue;
      const int at = A.place(s);
      Mat3<double> M;  // rows are of the lower vertex, as in the matrix's memory
      for (int k = 0; k < 9; ++k) M[k % 3][k / 3] = static_cast<double>(A.value(at, k));
      if (s == own) {
        M = held_own_block(sliding, row, M);
      } else {
        const int lower = s < own ? column : row, upper = s < own ? row : column;
        if (lower >= 0) hold_side(sliding, lower, true, M);
        if (upper >= 0) hold_side(sliding, upper, false, M);
      }
      for (int k = 0; k < 9; ++k) A.value(at, k) = static_cast<Real>(M[k % 3][k / 3]);
    }
  }
};

}  // namespace plica
