// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/pack.hpp>

// Vectors and 3x3 matrices for device code, on plain numbers or packs.
namespace plica {

template <class T>
struct Vec3 {
  T a[3] = {T(0), T(0), T(0)};

  KOKKOS_INLINE_FUNCTION T& operator[](int i) { return a[i]; }
  KOKKOS_INLINE_FUNCTION const T& operator[](int i) const { return a[i]; }
  friend KOKKOS_INLINE_FUNCTION Vec3 operator+(const Vec3& x, const Vec3& y) {
    return {x[0] + y[0], x[1] + y[1], x[2] + y[2]};
  }
  friend KOKKOS_INLINE_FUNCTION Vec3 operator-(const Vec3& x, const Vec3& y) {
    return {x[0] - y[0], x[1] - y[1], x[2] - y[2]};
  }
  friend KOKKOS_INLINE_FUNCTION Vec3 operator*(const T& s, const Vec3& x) {
    return {s * x[0], s * x[1], s * x[2]};
  }
  KOKKOS_INLINE_FUNCTION Vec3& operator+=(const Vec3& y) { return *this = *this + y; }
  KOKKOS_INLINE_FUNCTION Vec3& operator-=(const Vec3& y) { return *this = *this - y; }
};

template <class T>
KOKKOS_INLINE_FUNCTION T dot(const Vec3<T>& x, const Vec3<T>& y) {
  return x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
}

template <class T>
KOKKOS_INLINE_FUNCTION Vec3<T> cross(const Vec3<T>& x, const Vec3<T>& y) {
  return {x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]};
}

template <class T>
struct Mat3 {
  Vec3<T> row[3];

  KOKKOS_INLINE_FUNCTION Vec3<T>& operator[](int i) { return row[i]; }
  KOKKOS_INLINE_FUNCTION const Vec3<T>& operator[](int i) const { return row[i]; }
  friend KOKKOS_INLINE_FUNCTION Mat3 operator+(const Mat3& A, const Mat3& B) {
    return {A[0] + B[0], A[1] + B[1], A[2] + B[2]};
  }
  friend KOKKOS_INLINE_FUNCTION Mat3 operator-(const Mat3& A, const Mat3& B) {
    return {A[0] - B[0], A[1] - B[1], A[2] - B[2]};
  }
  friend KOKKOS_INLINE_FUNCTION Mat3 operator*(const T& s, const Mat3& A) {
    return {s * A[0], s * A[1], s * A[2]};
  }
  static KOKKOS_INLINE_FUNCTION Mat3 identity() { return diagonal(T(1)); }
  static KOKKOS_INLINE_FUNCTION Mat3 diagonal(const T& s) {
    return {Vec3<T>{s, T(0), T(0)}, Vec3<T>{T(0), s, T(0)}, Vec3<T>{T(0), T(0), s}};
  }
};

template <class T>
KOKKOS_INLINE_FUNCTION Vec3<T> operator*(const Mat3<T>& A, const Vec3<T>& x) {
  return {dot(A[0], x), dot(A[1], x), dot(A[2], x)};
}

template <class T>
KOKKOS_INLINE_FUNCTION Mat3<T> transpose(const Mat3<T>& A) {
  return {Vec3<T>{A[0][0], A[1][0], A[2][0]}, Vec3<T>{A[0][1], A[1][1], A[2][1]},
          Vec3<T>{A[0][2], A[1][2], A[2][2]}};
}

template <class T>
KOKKOS_INLINE_FUNCTION Mat3<T> operator*(const Mat3<T>& A, const Mat3<T>& B) {
  Mat3<T> C;
  for (int i = 0; i < 3; ++i) C[i] = A[i][0] * B[0] + A[i][1] * B[1] + A[i][2] * B[2];
  return C;
}

/// Returns x y^T.
template <class T>
KOKKOS_INLINE_FUNCTION Mat3<T> outer(const Vec3<T>& x, const Vec3<T>& y) {
  return {x[0] * y, x[1] * y, x[2] * y};
}

/// Returns the matrix of y -> x cross y.
template <class T>
KOKKOS_INLINE_FUNCTION Mat3<T> cross_matrix(const Vec3<T>& x) {
  return {Vec3<T>{T(0), -x[2], x[1]}, Vec3<T>{x[2], T(0), -x[0]}, Vec3<T>{-x[1], x[0], T(0)}};
}

template <class T>
KOKKOS_INLINE_FUNCTION T trace(const Mat3<T>& A) {
  return A[0][0] + A[1][1] + A[2][2];
}

/// Returns A : B, the sum of the products of their entries.
template <class T>
KOKKOS_INLINE_FUNCTION T inner(const Mat3<T>& A, const Mat3<T>& B) {
  return dot(A[0], B[0]) + dot(A[1], B[1]) + dot(A[2], B[2]);
}

/// Returns det(A) A^-T, smooth in A also where det A = 0.
template <class T>
KOKKOS_INLINE_FUNCTION Mat3<T> cofactor(const Mat3<T>& A) {
  return {cross(A[1], A[2]), cross(A[2], A[0]), cross(A[0], A[1])};
}

/// Returns the derivative of cofactor(A) in direction dA.
template <class T>
KOKKOS_INLINE_FUNCTION Mat3<T> cofactor_change(const Mat3<T>& A, const Mat3<T>& dA) {
  return {cross(dA[1], A[2]) + cross(A[1], dA[2]), cross(dA[2], A[0]) + cross(A[2], dA[0]),
          cross(dA[0], A[1]) + cross(A[0], dA[1])};
}

template <class T>
KOKKOS_INLINE_FUNCTION T determinant(const Mat3<T>& A) {
  return dot(A[0], cross(A[1], A[2]));
}

/// A symmetric 3x3 matrix by its six numbers xx yy zz xy xz yz.
template <class T>
struct SymMat3 {
  T a[6] = {T(0), T(0), T(0), T(0), T(0), T(0)};

  KOKKOS_INLINE_FUNCTION T& operator[](int i) { return a[i]; }
  KOKKOS_INLINE_FUNCTION const T& operator[](int i) const { return a[i]; }
  /// Returns which of the six numbers entry k of all nine is, row by row.
  static KOKKOS_INLINE_FUNCTION int place(int k) {
    constexpr int places[9] = {0, 3, 4, 3, 1, 5, 4, 5, 2};
    return places[k];
  }
  friend KOKKOS_INLINE_FUNCTION Vec3<T> operator*(const SymMat3& A, const Vec3<T>& x) {
    return {A[0] * x[0] + A[3] * x[1] + A[4] * x[2], A[3] * x[0] + A[1] * x[1] + A[5] * x[2],
            A[4] * x[0] + A[5] * x[1] + A[2] * x[2]};
  }
};

/// Returns a symmetric matrix as xx yy zz xy xz yz.
template <class T>
KOKKOS_INLINE_FUNCTION SymMat3<T> six_of(const Mat3<T>& M) {
  return {{M[0][0], M[1][1], M[2][2], M[0][1], M[0][2], M[1][2]}};
}
template <class T>
KOKKOS_INLINE_FUNCTION Mat3<T> matrix_of(const SymMat3<T>& m) {
  return {Vec3<T>{m.a[0], m.a[3], m.a[4]}, Vec3<T>{m.a[3], m.a[1], m.a[5]},
          Vec3<T>{m.a[4], m.a[5], m.a[2]}};
}

/// Computes the inverse of A where A is positive definite; returns false where it is not.
template <class T>
KOKKOS_INLINE_FUNCTION bool invert_positive(const SymMat3<T>& A, SymMat3<T>& inverse) {
  const T xx = A[0], yy = A[1], zz = A[2], xy = A[3], xz = A[4], yz = A[5];
  const T cx = yy * zz - yz * yz, cxy = xz * yz - xy * zz, cxz = xy * yz - yy * xz;
  const T det = xx * cx + xy * cxy + xz * cxz;
  if (!(xx > 0 && xx * yy - xy * xy > 0 && det > 0)) return false;
  const T s = 1 / det;
  inverse = {{s * cx, s * (xx * zz - xz * xz), s * (xx * yy - xy * xy), s * cxy, s * cxz,
              s * (xy * xz - xx * yz)}};
  return true;
}

}  // namespace plica
