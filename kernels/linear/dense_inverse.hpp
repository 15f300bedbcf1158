// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/matrices.hpp>

// Inverse of a small symmetric matrix, made and applied on the device by the sweep operator
// (Goodnight 1979, The American Statistician 33(3)). The sweep operator is Gauss-Jordan elimination
// in place. Without pivoting it is stable for positive definite matrices. A pivot that is not
// positive (an empty row: a vertex whose motion is given) leaves its row and column out.
namespace plica {

template <class B>
struct DenseInverse {
  static constexpr int block = 16;  ///< rows that lie together when it is applied
  int size = 0;
  Kokkos::View<double**, Kokkos::LayoutRight, typename B::Memory> matrix;
  Doubles<B> row;      ///< row of the pivot
  Scalars<B> inverse;  ///< [blocks of rows][size][block]

  DenseInverse() = default;
  explicit DenseInverse(int vertices)
      : size(3 * vertices),
        matrix("plica::dense.matrix", size, size),
        row(zeros<Doubles<B>>("plica::dense.row", size)),
        inverse(zeros<Scalars<B>>(
            "plica::dense.inverse",
            static_cast<std::size_t>((size + block - 1) / block) * block * size)) {}
};

/// Expands one row of blocks of A into the dense matrix.
template <class B>
struct ToDense {
  BlockMatrix<B> A;
  DenseInverse<B> dense;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < dense.size; ++j) dense.matrix(3 * a + i, j) = 0;
    for (int s = A.first(a); s < A.first(a + 1); ++s)
      for (int k = 0; k < 9; ++k)
        dense.matrix(3 * a + k % 3, 3 * A.column(s) + k / 3) =
            static_cast<double>(A.number(a, s, k));
  }
};

template <class B>
struct TakePivotRow {
  DenseInverse<B> dense;
  int pivot;
  KOKKOS_INLINE_FUNCTION void operator()(int j) const { dense.row(j) = dense.matrix(pivot, j); }
};

/// Sweeps one row for pivot k: M_ij -= M_ik M_kj / M_kk, M_ik /= M_kk, M_kk = -1 / M_kk. After all
/// pivots, M is minus the inverse.
template <class B>
struct SweepRow {
  DenseInverse<B> dense;
  int pivot;
  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    const double p = dense.row(pivot), inverse = p > 0 ? 1 / p : 0.0;
    double* const M = &dense.matrix(i, 0);
    const double* const row = dense.row.data();
    if (i == pivot) {
      for (int j = 0; j < dense.size; ++j) M[j] = inverse * row[j];
      M[pivot] = -inverse;
    } else {
      const double f = inverse * row[i];
      for (int j = 0; j < dense.size; ++j) M[j] -= f * row[j];
      M[pivot] = f;
    }
  }
};

/// Packs the inverse from `matrix`, which contains `sign` times the inverse.
template <class B>
struct PackInverse {
  DenseInverse<B> dense;
  int sign;
  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    constexpr int block = DenseInverse<B>::block;
    for (int j = 0; j < dense.size; ++j)
      dense.inverse((static_cast<std::size_t>(i / block) * dense.size + j) * block + i % block) =
          static_cast<typename B::Real>(sign * dense.matrix(i, j));
  }
};

/// Computes x = A^-1 r. On a CPU a work item takes a whole block of rows, whose numbers fill
/// registers; on a GPU one row.
template <class B>
struct ApplyDense {
  using Real = typename B::Real;
  static constexpr int block = DenseInverse<B>::block, rows = B::for_cpu ? block : 1;
  DenseInverse<B> dense;
  Vectors<B> r;
  Fours<B> x;
  static int items(int size) { return (size + block - 1) / block * block / rows; }
  KOKKOS_INLINE_FUNCTION void operator()(int item) const {
    const int n = dense.size, first = item * rows;
    const Real* matrix =
        dense.inverse.data() + static_cast<std::size_t>(first / block) * n * block + first % block;
    const Real* const from = r.data();
    Real sum[rows] = {};
    for (int j = 0; j < n; ++j, matrix += block)
      for (int i = 0; i < rows; ++i) sum[i] += matrix[i] * from[j];
    for (int i = 0; i < rows && first + i < n; ++i) x((first + i) / 3, (first + i) % 3) = sum[i];
  }
};

}  // namespace plica
