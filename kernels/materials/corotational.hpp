// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/materials/material.hpp>

namespace plica {

/// The rotation R that maximises R:F (for det F > 0 the polar factor), without an eigen-solver. Its R:F is the largest
/// root s of p = s^4 - 2|F|^2 s^2 - 8 J s + |F|^4 - 4|cof F|^2, whose roots are the signed sums of the singular values;
/// Newton's method descends to it from sqrt(3)|F| >= s. Then R = ds/dF = -(dp/dF)/(dp/ds).
template <class T>
KOKKOS_INLINE_FUNCTION Mat3<T> polar_rotation(const Mat3<T>& F) {
  using Real = typename LaneOf<T>::type;
  const Mat3<T> H = cofactor(F);
  const T n = inner(F, F), J = dot(F[0], H[0]), q = n * n - T(4) * inner(H, H);
  const T tiny = T(Kokkos::Experimental::norm_min_v<Real>);
  T s = sqrt(T(3) * n);
  for (int i = 0; i < 24; ++i) {
    const T slope = T(4) * (s * s * s - n * s - T(2) * J);
    const T step = (((s * s - T(2) * n) * s - T(8) * J) * s + q) / max(slope, tiny);
    s = s - step;
    bool converged = true;
    for (int l = 0; l < LaneOf<T>::count; ++l)
      converged = converged && lane(step, l) <= lane(s, l) * Kokkos::Experimental::epsilon_v<Real>;
    if (converged) break;
  }
  const T scale = T(1) / max(s * s * s - n * s - T(2) * J, tiny);
  const T a = scale * (s * s + n), b = scale * (s + s), c = scale + scale;
  return a * F + b * H - c * (F * (transpose(F) * F));
}

/// Psi = mu |F - R|^2 + lambda/2 (R:F - 3)^2 with R the rotation nearest to F: Hooke's law in the rotated frame, with
/// the exact derivative of R (Chao, Pinkall, Sanan & Schroeder 2010; McAdams et al. 2011).
struct Corotational {
  static constexpr const char* name = "corotational";
  static constexpr const char* summary =
      "Hooke's law in the frame turned with the element; large rotations, small strains";
  static constexpr bool rotation_invariant = true;
  static constexpr bool survives_inversion = true;

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

  /// dR = R [w]x with (tr(S) I - S) w = axial vector of R^T dF - dF^T R, S = R^T F.
  template <class T>
  struct Tangent {
    Mat3<T> R, turning;  // (tr(S) I - S)^-1
    Mat3<T> turned;      // R turning R^T
    T stretch;           // lambda (tr S - 3)
    Lame<T> c;
    KOKKOS_INLINE_FUNCTION Tangent(const Mat3<T>& F, const Lame<T>& constants) : R(polar_rotation(F)), c(constants) {
      using Real = typename LaneOf<T>::type;
      const Mat3<T> S = transpose(R) * F, G = Mat3<T>::diagonal(trace(S)) - S, H = cofactor(G);
      turning = (T(1) / max(dot(G[0], H[0]), T(Kokkos::Experimental::norm_min_v<Real>))) * transpose(H);
      turned = R * turning * transpose(R);
      stretch = c.lambda * (trace(S) - T(3));
    }
    KOKKOS_INLINE_FUNCTION Mat3<T> operator()(const Mat3<T>& dF) const {
      const Mat3<T> Z = transpose(R) * dF;
      const Vec3<T> w = turning * Vec3<T>{Z[2][1] - Z[1][2], Z[0][2] - Z[2][0], Z[1][0] - Z[0][1]};
      const T mu2 = c.mu + c.mu;
      return mu2 * dF + R * ((stretch - mu2) * cross_matrix(w) + Mat3<T>::diagonal(c.lambda * trace(Z)));
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
          made.left[i][k] = s[(i + 1) % 3] * turned[(i + 2) % 3][k] - s[(i + 2) % 3] * turned[(i + 1) % 3][k];
      return made;
    }
    /// 2 mu (p.q) I + lambda (R p)(R q)^T + (2 mu - stretch) [R p]x R turning R^T [R q]x
    KOKKOS_INLINE_FUNCTION Mat3<T> block(const Corner& p, const Corner& q) const {
      Mat3<T> K = Mat3<T>::diagonal((c.mu + c.mu) * dot(p.g, q.g));
      for (int i = 0; i < 3; ++i) K[i] += (c.lambda * p.r[i]) * q.r + cross(p.left[i], q.r);
      return K;
    }
  };

  template <class T>
  static KOKKOS_INLINE_FUNCTION Mat3<T> stress_change(const Mat3<T>& F, const Mat3<T>& dF, const Lame<T>& c) {
    return Tangent<T>(F, c)(dF);
  }
};

}  // namespace plica
