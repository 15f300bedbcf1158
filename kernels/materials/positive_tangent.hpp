// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/materials/material.hpp>

namespace plica {

/// A symmetric 9x9 matrix of a pack of elements: dP/dF in the order of F's entries, row by row.
template <class T>
struct Mat9 {
  T a[9][9];
};

/// Whether A + shift I is positive definite in every lane: Cholesky's method meets positive pivots only.
template <class T>
KOKKOS_INLINE_FUNCTION bool positive_definite(const Mat9<T>& A, const T& shift) {
  T L[9][9];
  for (int j = 0; j < 9; ++j) {
    T pivot = A.a[j][j] + shift;
    for (int k = 0; k < j; ++k) pivot -= L[j][k] * L[j][k];
    for (int l = 0; l < LaneOf<T>::count; ++l)
      if (!(lane(pivot, l) > 0)) return false;
    const T root = sqrt(pivot), inverse = T(1) / root;
    for (int i = j + 1; i < 9; ++i) {
      T sum = A.a[i][j];
      for (int k = 0; k < j; ++k) sum -= L[i][k] * L[j][k];
      L[i][j] = sum * inverse;
    }
  }
  return true;
}

/// Whether what is off the diagonal is at most rounding in every lane.
template <class T>
KOKKOS_INLINE_FUNCTION bool negligible(const Mat9<T>& A) {
  using Real = typename LaneOf<T>::type;
  T off = T(0), on = T(0);
  for (int i = 0; i < 9; ++i) {
    on += A.a[i][i] * A.a[i][i];
    for (int j = 0; j < i; ++j) off += A.a[i][j] * A.a[i][j];
  }
  constexpr Real tiny = Kokkos::Experimental::epsilon_v<Real>;
  for (int l = 0; l < LaneOf<T>::count; ++l)
    if (lane(off, l) > tiny * tiny * lane(on, l)) return false;
  return true;
}

/// Drops what belongs to negative eigenvalues: cyclic Jacobi rotations (Golub & Van Loan, Matrix Computations, 4th ed.,
/// alg. 8.5.3), A = V diag V^T, then A = the sum of max(diag, 0) v v^T.
template <class T>
KOKKOS_INLINE_FUNCTION void clamp_eigenvalues(Mat9<T>& A) {
  using Real = typename LaneOf<T>::type;
  const T tiny = T(Kokkos::Experimental::norm_min_v<Real>);
  Mat9<T> V;
  for (int i = 0; i < 9; ++i)
    for (int j = 0; j < 9; ++j) V.a[i][j] = T(i == j ? 1 : 0);
  for (int sweep = 0; sweep < 10 && !negligible(A); ++sweep)
    for (int p = 0; p < 8; ++p)
      for (int q = p + 1; q < 9; ++q) {
        // tan t = sign(d) 2 a / (|d| + sqrt(d^2 + 4 a^2)), d = A_qq - A_pp, a = A_pq: the smaller rotation
        const T d = A.a[q][q] - A.a[p][p], a2 = T(2) * A.a[p][q], size = sqrt(d * d + a2 * a2);
        const T magnitude = max(d, -d) + size + tiny;
        T t = a2 / magnitude;
        for (int l = 0; l < LaneOf<T>::count; ++l)
          if (lane(d, l) < 0) set_lane(t, l, -lane(t, l));
        const T c = T(1) / sqrt(T(1) + t * t), s = t * c;
        for (int k = 0; k < 9; ++k) {
          const T x = A.a[k][p], y = A.a[k][q], v = V.a[k][p], w = V.a[k][q];
          A.a[k][p] = c * x - s * y, A.a[k][q] = s * x + c * y;
          V.a[k][p] = c * v - s * w, V.a[k][q] = s * v + c * w;
        }
        for (int k = 0; k < 9; ++k) {
          const T x = A.a[p][k], y = A.a[q][k];
          A.a[p][k] = c * x - s * y, A.a[q][k] = s * x + c * y;
        }
      }
  T value[9];
  for (int k = 0; k < 9; ++k) value[k] = max(A.a[k][k], T(0));
  for (int i = 0; i < 9; ++i)
    for (int j = 0; j <= i; ++j) {
      T sum = T(0);
      for (int k = 0; k < 9; ++k) sum += value[k] * V.a[i][k] * V.a[j][k];
      A.a[i][j] = A.a[j][i] = sum;
    }
}

/// A material's dP/dF projected to positive semi-definite, per element (Teran, Sifakis, Irving & Fedkiw 2005), by numbers: it fits any
/// material. Packs of elements that are positive semi-definite to rounding keep it as it is.
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
      if (!positive_definite(C, T(16 * Kokkos::Experimental::epsilon_v<Real>) * size)) clamp_eigenvalues(C);
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
    struct Corner {
      Vec3<T> g;
      Mat3<T> dP[3];  // for e_k g^T
    };
    KOKKOS_INLINE_FUNCTION Corner corner(const Vec3<T>& g) const {
      Corner made{g, {}};
      for (int k = 0; k < 3; ++k)
        for (int i = 0; i < 9; ++i)
          made.dP[k][i / 3][i % 3] = C.a[i][3 * k] * g[0] + C.a[i][3 * k + 1] * g[1] + C.a[i][3 * k + 2] * g[2];
      return made;
    }
    KOKKOS_INLINE_FUNCTION Mat3<T> block(const Corner& p, const Corner& q) const {
      return transpose(Mat3<T>{q.dP[0] * p.g, q.dP[1] * p.g, q.dP[2] * p.g});
    }
  };
};

}  // namespace plica
