// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/block_matrix.hpp>
#include <plica/core/small.hpp>
#include <plica/kernels/implicit/system_kernels.hpp>

namespace plica {

template <class B>
KOKKOS_INLINE_FUNCTION Vec3<typename B::Real> vector_at(const Vectors<B>& x, int a) {
  return {x(a, 0), x(a, 1), x(a, 2)};
}

/// The symmetric block of a vertex (xx yy zz xy xz yz) times a vector.
template <class B>
KOKKOS_INLINE_FUNCTION Vec3<typename B::Real> vertex_block_product(const Blocks<B>& d, int a,
                                                                   const Vec3<typename B::Real>& r) {
  return {d(a, 0) * r[0] + d(a, 3) * r[1] + d(a, 4) * r[2], d(a, 3) * r[0] + d(a, 1) * r[1] + d(a, 5) * r[2],
          d(a, 4) * r[0] + d(a, 5) * r[1] + d(a, 2) * r[2]};
}

/// A matrix's own blocks of the vertices.
template <class B>
struct TakeDiagonal {
  BlockMatrix<B> A;
  Blocks<B> diagonal;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    constexpr int place[6] = {0, 4, 8, 1, 2, 5};
    for (int k = 0; k < 6; ++k) diagonal(a, k) = A.value(A.diagonal(a), place[k]);
  }
};

/// The inverse of a matrix's own block of every row. One that is not positive definite gives way to what is positive on its diagonal;
/// an empty row's is 0.
template <class B>
struct InvertDiagonal {
  using Real = typename B::Real;
  BlockMatrix<B> A;
  Blocks<B> inverse;

  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    const Real* const b = &A.value(A.diagonal(a), 0);
    const Real xx = b[0], yy = b[4], zz = b[8], xy = b[1], xz = b[2], yz = b[5];
    const Real cx = yy * zz - yz * yz, cxy = xz * yz - xy * zz, cxz = xy * yz - yy * xz;
    const Real det = xx * cx + xy * cxy + xz * cxz;
    if (xx > 0 && xx * yy - xy * xy > 0 && det > 0) {
      const Real s = 1 / det;
      inverse(a, 0) = s * cx, inverse(a, 1) = s * (xx * zz - xz * xz), inverse(a, 2) = s * (xx * yy - xy * xy);
      inverse(a, 3) = s * cxy, inverse(a, 4) = s * cxz, inverse(a, 5) = s * (xy * xz - xx * yz);
    } else {
      for (int k = 0; k < 6; ++k) inverse(a, k) = k < 3 && b[4 * k] > 0 ? 1 / b[4 * k] : Real(0);
    }
  }
};

/// A += scale * symmetric vertex blocks
template <class B>
struct AddToDiagonal {
  using Real = typename B::Real;
  Blocks<B> block;
  BlockMatrix<B> A;
  Real scale;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    constexpr int from[9] = {0, 3, 4, 3, 1, 5, 4, 5, 2};
    for (int k = 0; k < 9; ++k) A.value(A.diagonal(a), k) += scale * block(a, from[k]);
  }
};

}  // namespace plica
