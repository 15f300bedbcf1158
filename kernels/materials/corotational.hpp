// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/inlining.hpp>
#include <plica/kernels/materials/material.hpp>
#include <plica/kernels/materials/volumetric.hpp>

namespace plica {

/// Part of s |F|^2 below which (s2 + s1)(s3 + s1)(s3 + s2) counts as 0. Here s1 >= s2 >= |s3| are
/// the singular values, s3 with the sign of det F. R is unique where the product is positive; it is
/// not where the product is 0, as in F = 0, in a line or in a reflection.
inline constexpr double least_turning = 1e-3;

/// Returns a rotation R that maximises R:F, also for an F where several do. It follows from the
/// unit quaternion q that maximises q.K q = R(q):F (Horn 1987). q is found by squaring K, shifted,
/// until its largest eigenvalue alone is left.
template <class Real>
PLICA_SELDOM KOKKOS_FUNCTION Mat3<Real> any_nearest_rotation(const Mat3<Real>& F) {
  const Real shift = sqrt(Real(3) * inner(F, F)) + Real(Kokkos::Experimental::norm_min_v<Real>);
  const Real xx = F[0][0], yy = F[1][1], zz = F[2][2];
  Real M[4][4] = {{xx + yy + zz, F[2][1] - F[1][2], F[0][2] - F[2][0], F[1][0] - F[0][1]},
                  {Real(0), xx - yy - zz, F[0][1] + F[1][0], F[0][2] + F[2][0]},
                  {Real(0), Real(0), yy - xx - zz, F[1][2] + F[2][1]},
                  {Real(0), Real(0), Real(0), zz - xx - yy}};
  for (int i = 0; i < 4; ++i) {
    M[i][i] = M[i][i] + shift;
    for (int j = 0; j < i; ++j) M[i][j] = M[j][i];
  }
  for (int n = 0; n < 16; ++n) {
    const Real size = Real(1) / (M[0][0] + M[1][1] + M[2][2] + M[3][3]);
    Real N[4][4];
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) N[i][j] = size * M[i][j];
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j)
        M[i][j] = N[i][0] * N[0][j] + N[i][1] * N[1][j] + N[i][2] * N[2][j] + N[i][3] * N[3][j];
  }
  int k = 0;
  for (int i = 1; i < 4; ++i)
    if (M[i][i] > M[k][k]) k = i;
  const Real square = M[0][k] * M[0][k] + M[1][k] * M[1][k] + M[2][k] * M[2][k] + M[3][k] * M[3][k];
  const Real two = Real(2) / square, w = M[0][k], x = M[1][k], y = M[2][k], z = M[3][k];
  return {
      Vec3<Real>{Real(1) - two * (y * y + z * z), two * (x * y - w * z), two * (x * z + w * y)},
      Vec3<Real>{two * (x * y + w * z), Real(1) - two * (x * x + z * z), two * (y * z - w * x)},
      Vec3<Real>{two * (x * z - w * y), two * (y * z + w * x), Real(1) - two * (x * x + y * y)}};
}

/// Returns the rotation R, det R = 1, that maximises R:F. R^T F = S is symmetric with the signed
/// singular values, the smallest with the sign of det F; for det F > 0, R is the polar factor. No
/// eigen-solver is needed: R:F is the largest root s of p = s^4 - 2|F|^2 s^2 - 8 J s + |F|^4 -
/// 4|cof F|^2. The roots of p are the signed sums of the singular values; Newton's method descends
/// to the largest from sqrt(3)|F| >= s. Then R = ds/dF = -(dp/dF)/(dp/ds). Where that root is not
/// simple, any_nearest_rotation() gives R.
template <class T>
KOKKOS_INLINE_FUNCTION Mat3<T> polar_rotation(const Mat3<T>& F) {
  using Real = typename LaneOf<T>::type;
  const Mat3<T> H = cofactor(F);
  const T n = inner(F, F), J = dot(F[0], H[0]), q = n * n - T(4) * inner(H, H);
  const T tiny = T(Kokkos::Experimental::norm_min_v<Real>);
  T s = sqrt(T(3) * n), left = T(1);  // left: positive where s is not exact yet
  for (int i = 0; i < 24; ++i) {
    const T slope = max(T(4) * (s * s * s - n * s - T(2) * J), tiny);
    // a lane that is exact steps no further, so that it does not depend on the other lanes
    const T step = where_positive(left, (((s * s - T(2) * n) * s - T(8) * J) * s + q) / slope);
    // p'' step^2 / 2; divided by the slope, it is what the next step would be
    const T next = (T(6) * s * s - T(2) * n) * step * step;
    s = s - step;
    left = next - (T(Kokkos::Experimental::epsilon_v<Real>) * s * slope + tiny);
    if (all_positive(-left)) break;
  }
  const T turning = s * s * s - n * s - T(2) * J;
  const T scale = T(1) / max(turning, tiny);
  const T a = scale * (s * s + n), b = scale * (s + s), c = scale + scale;
  Mat3<T> R = a * F + b * H - c * (F * (transpose(F) * F));
  const T clear = turning - T(Real(2 * least_turning)) * s * n;
  if (all_positive(clear)) return R;
  for (int l = 0; l < LaneOf<T>::count; ++l)
    if (!(lane(clear, l) > Real(0))) {
      Mat3<Real> one;
      for (int r = 0; r < 3; ++r)
        for (int k = 0; k < 3; ++k) one[r][k] = lane(F[r][k], l);
      one = any_nearest_rotation(one);
      for (int r = 0; r < 3; ++r)
        for (int k = 0; k < 3; ++k) set_lane(R[r][k], l, one[r][k]);
    }
  return R;
}

/// Corotational law: Psi = mu |F - R|^2 + lambda/2 (R:F - 3)^2 with R the rotation nearest to F. It
/// is Hooke's law in the rotated frame, with the exact derivative of R (Chao, Pinkall, Sanan &
/// Schroeder 2010; McAdams et al. 2011). It is finite everywhere. Its energy in the signed singular
/// values has no minimum but at rest: inverted elements are pushed back along the axis that takes
/// least.
struct Corotational : TwoConstants {
  static constexpr const char* name = "corotational";
  static constexpr const char* summary =
      "Hooke's law in the frame turned with the element; large rotations, small strains; recovers "
      "from inversion";
  static constexpr bool rotation_invariant = true;
  static constexpr bool survives_inversion = true;
  static constexpr bool recovers = true;
  static constexpr bool allows_inversion = true;

  template <class T>
  static KOKKOS_INLINE_FUNCTION T energy(const Mat3<T>& F, const Lame<T>& c) {
    const Mat3<T> R = polar_rotation(F), D = F - R;
    const T t = inner(R, F) - T(3);
    return c.mu * inner(D, D) + T(0.5f) * c.lambda * t * t;
  }

  template <class T>
  static KOKKOS_INLINE_FUNCTION Mat3<T> stress(const Mat3<T>& F, const Lame<T>& c) {
    const Mat3<T> R = polar_rotation(F);
    return (c.mu + c.mu) * (F - R) + (c.lambda * (inner(R, F) - T(3))) * R;
  }

  /// Tangent dP/dF: dR = R [w]x with (tr(S) I - S) w = axial vector of R^T dF - dF^T R, S = R^T F.
  /// dR is 0 where R is not unique.
  template <class T>
  struct Tangent {
    Mat3<T> R, turning;  // (tr(S) I - S)^-1
    Mat3<T> turned;      // R turning R^T
    T stretch;           // lambda (tr S - 3)
    Lame<T> c;
    KOKKOS_INLINE_FUNCTION Tangent(const Mat3<T>& F, const Lame<T>& constants)
        : R(polar_rotation(F)), c(constants) {
      using Real = typename LaneOf<T>::type;
      const Mat3<T> S = transpose(R) * F, G = Mat3<T>::diagonal(trace(S)) - S, H = cofactor(G);
      const T det = dot(G[0], H[0]), least = T(Real(least_turning)) * trace(S) * inner(F, F);
      const T d =
          where_positive(det - least, T(1) / max(det, T(Kokkos::Experimental::norm_min_v<Real>)));
      turning = d * transpose(H);
      turned = R * turning * transpose(R);
      stretch = c.lambda * (trace(S) - T(3));
    }
    KOKKOS_INLINE_FUNCTION Mat3<T> operator()(const Mat3<T>& dF) const {
      const Mat3<T> Z = transpose(R) * dF;
      const Vec3<T> w = spin(Z);
      const T mu2 = c.mu + c.mu;
      return mu2 * dF +
             R * ((stretch - mu2) * cross_matrix(w) + Mat3<T>::diagonal(c.lambda * trace(Z)));
    }
    /// Returns w for Z = R^T dF.
    KOKKOS_INLINE_FUNCTION Vec3<T> spin(const Mat3<T>& Z) const {
      return turning * Vec3<T>{Z[2][1] - Z[1][2], Z[0][2] - Z[2][0], Z[1][0] - Z[0][1]};
    }
    struct Corner {
      Vec3<T> g, r;  // r = R g
      Mat3<T> left;  // (2 mu - stretch) [r]x R turning R^T
    };
    KOKKOS_INLINE_FUNCTION Corner corner(const Vec3<T>& g) const {
      const Vec3<T> r = R * g;
      Corner made{g, r, {}};
      const Vec3<T> s = (c.mu + c.mu - stretch) * r;
      for (int k = 0; k < 3; ++k)
        for (int i = 0; i < 3; ++i)
          made.left[i][k] =
              s[(i + 1) % 3] * turned[(i + 2) % 3][k] - s[(i + 2) % 3] * turned[(i + 1) % 3][k];
      return made;
    }
    /// Returns 2 mu (p.q) I + lambda (R p)(R q)^T + (2 mu - stretch) [R p]x R turning R^T [R q]x.
    KOKKOS_INLINE_FUNCTION Mat3<T> block(const Corner& p, const Corner& q) const {
      Mat3<T> K = Mat3<T>::diagonal((c.mu + c.mu) * dot(p.g, q.g));
      for (int i = 0; i < 3; ++i) K[i] += (c.lambda * p.r[i]) * q.r + cross(p.left[i], q.r);
      return K;
    }
  };

  /// The dilatation R:F - 2, whose derivative is R.
  template <class T>
  struct Dilatation {
    Tangent<T> at;
    Mat3<T> slope;
    T value;
    explicit KOKKOS_INLINE_FUNCTION Dilatation(const Mat3<T>& F)
        : at(F, {T(0), T(0)}), slope(at.R), value(inner(at.R, F) - T(2)) {}
    KOKKOS_INLINE_FUNCTION Mat3<T> slope_change(const Mat3<T>& dF) const {
      return at.R * cross_matrix(at.spin(transpose(at.R) * dF));
    }
  };
  template <class T>
  static KOKKOS_INLINE_FUNCTION Volumetric<T> volumetric(const T& x, const Lame<T>&) {
    return {VolumeRatio<T>(x), T(1), Volumetric<T>::quadratic};
  }

  template <class T>
  static KOKKOS_INLINE_FUNCTION Mat3<T> stress_change(const Mat3<T>& F, const Mat3<T>& dF,
                                                      const Lame<T>& c) {
    return Tangent<T>(F, c)(dF);
  }
};

}  // namespace plica
