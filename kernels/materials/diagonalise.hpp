// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/functions.hpp>

namespace plica {

/// Returns by how much the numbers off the diagonal are more than rounding, in squares; not
/// positive where A is diagonal.
template <class T, int n>
KOKKOS_INLINE_FUNCTION T off_diagonal(const T (&A)[n][n]) {
  using Real = typename LaneOf<T>::type;
  T off = T(0), on = T(0);
  for (int i = 0; i < n; ++i) {
    on += A[i][i] * A[i][i];
    for (int j = 0; j < i; ++j) off += A[i][j] * A[i][j];
  }
  constexpr Real tiny = Kokkos::Experimental::epsilon_v<Real>;
  return off - (T(tiny * tiny) * on + T(Kokkos::Experimental::norm_min_v<Real>));
}

/// Diagonalises a symmetric A = V diag V^T by cyclic Jacobi rotations; A becomes diag. Golub & Van
/// Loan, Matrix Computations, 4th ed., alg. 8.5.3. A lane that is diagonal is turned no further, so
/// that it does not depend on the other lanes.
template <class T, int n>
KOKKOS_INLINE_FUNCTION void diagonalise(T (&A)[n][n], T (&V)[n][n]) {
  using Real = typename LaneOf<T>::type;
  const T tiny = T(Kokkos::Experimental::norm_min_v<Real>);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) V[i][j] = T(i == j ? 1 : 0);
  for (int sweep = 0; sweep < 10; ++sweep) {
    const T left = off_diagonal(A);
    if (all_positive(-left)) return;
    for (int p = 0; p < n - 1; ++p)
      for (int q = p + 1; q < n; ++q) {
        // tan t = sign(d) 2 a / (|d| + sqrt(d^2 + 4 a^2)), d = A_qq - A_pp, a = A_pq: the smaller
        // rotation
        const T d = A[q][q] - A[p][p], a2 = T(2) * A[p][q], size = sqrt(d * d + a2 * a2);
        const T magnitude = max(d, -d) + size + tiny;
        const T size_of_t = a2 / magnitude,
                t = where_positive(left, size_of_t - T(2) * where_positive(-d, size_of_t));
        const T c = T(1) / sqrt(T(1) + t * t), s = t * c;
        for (int k = 0; k < n; ++k) {
          const T x = A[k][p], y = A[k][q], v = V[k][p], w = V[k][q];
          A[k][p] = c * x - s * y, A[k][q] = s * x + c * y;
          V[k][p] = c * v - s * w, V[k][q] = s * v + c * w;
        }
        for (int k = 0; k < n; ++k) {
          const T x = A[p][k], y = A[q][k];
          A[p][k] = c * x - s * y, A[q][k] = s * x + c * y;
        }
      }
  }
}

}  // namespace plica
