// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/materials/diagonalise.hpp>
#include <plica/kernels/materials/material.hpp>

namespace plica {

/// Symmetric 9x9 matrix of a pack of elements: dP/dF in the order of F's entries, row by row.
template <class T>
struct Mat9 {
  T a[9][9];
};

/// Returns 1 where A + shift I is positive definite, else 0: there Cholesky's method meets a pivot
/// that is not positive.
template <class T>
KOKKOS_INLINE_FUNCTION T positive_definite(const Mat9<T>& A, const T& shift) {
  T L[9][9], positive = T(1);
  for (int j = 0; j < 9; ++j) {
    T pivot = A.a[j][j] + shift;
    for (int k = 0; k < j; ++k) pivot -= L[j][k] * L[j][k];
    positive = where_positive(pivot, positive);
    const T root = sqrt(pivot), inverse = T(1) / root;
    for (int i = j + 1; i < 9; ++i) {
      T sum = A.a[i][j];
      for (int k = 0; k < j; ++k) sum -= L[i][k] * L[j][k];
      L[i][j] = sum * inverse;
    }
  }
  return positive;
}

/// Drops the parts of A that belong to negative eigenvalues: with A = V diag V^T, A becomes the sum
/// of max(diag, 0) v v^T. Lanes where `keep` is positive stay as they are.
template <class T>
KOKKOS_INLINE_FUNCTION void clamp_eigenvalues(Mat9<T>& A, const T& keep) {
  Mat9<T> V;
  const Mat9<T> before = A;
  diagonalise(A.a, V.a);
  T value[9];
  for (int k = 0; k < 9; ++k) value[k] = max(A.a[k][k], T(0));
  for (int i = 0; i < 9; ++i)
    for (int j = 0; j <= i; ++j) {
      T sum = T(0);
      for (int k = 0; k < 9; ++k) sum += value[k] * V.a[i][k] * V.a[j][k];
      A.a[i][j] = A.a[j][i] = where_positive(keep, before.a[i][j], sum);
    }
}

/// Projection of a material's dP/dF to positive semi-definite, per element (Teran, Sifakis, Irving
/// & Fedkiw 2005). It is computed numerically and so fits any material. Elements that are positive
/// semi-definite to rounding keep their dP/dF as it is.
template <class Material>
struct PositiveTangent {
  template <class T>
  struct Of {
    Mat9<T> C;
    KOKKOS_INLINE_FUNCTION Of(const Mat3<T>& F, const typename Material::template Constants<T>& c) {
      const typename Material::template Tangent<T> tangent(F, c);
      T size = T(0);
      for (int j = 0; j < 9; ++j) {
        Mat3<T> dF;
        dF[j / 3][j % 3] = T(1);
        const Mat3<T> dP = tangent(dF);
        for (int i = 0; i < 9; ++i) C.a[i][j] = dP[i / 3][i % 3];
        size += max(C.a[j][j], -C.a[j][j]);
      }
      for (int i = 0; i < 9; ++i)
        for (int j = 0; j < i; ++j) C.a[i][j] = C.a[j][i] = T(0.5f) * (C.a[i][j] + C.a[j][i]);
      using Real = typename LaneOf<T>::type;
      const T positive = positive_definite(C, T(16 * Kokkos::Experimental::epsilon_v<Real>) * size);
      if (!all_positive(positive)) clamp_eigenvalues(C, positive);
    }
    KOKKOS_INLINE_FUNCTION Mat3<T> operator()(const Mat3<T>& dF) const {
      Mat3<T> dP;
      for (int i = 0; i < 9; ++i) {
        T sum = T(0);
        for (int j = 0; j < 9; ++j) sum += C.a[i][j] * dF[j / 3][j % 3];
        dP[i / 3][i % 3] = sum;
      }
      return dP;
    }
    using Corner = ColumnsOfCorner<T>;
    KOKKOS_INLINE_FUNCTION Corner corner(const Vec3<T>& g) const {
      Corner made{g, {}};
      for (int k = 0; k < 3; ++k)
        for (int i = 0; i < 9; ++i)
          made.dP[k][i / 3][i % 3] =
              C.a[i][3 * k] * g[0] + C.a[i][3 * k + 1] * g[1] + C.a[i][3 * k + 2] * g[2];
      return made;
    }
    KOKKOS_INLINE_FUNCTION Mat3<T> block(const Corner& p, const Corner& q) const {
      return q.block(p);
    }
  };
};

}  // namespace plica
