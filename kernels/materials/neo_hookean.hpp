// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/materials/material.hpp>

namespace plica {

/// Psi = kappa/4 (J^2 - 1 - 2 ln J) + mu/2 (J^(-2/3) I - 3), I = tr(F^T F), kappa = lambda + 2 mu/3.
/// Simo & Hughes, Computational Inelasticity, eq. 9.2.6. That is infinite at J = 0. Below J0 = 0.1 it goes on, twice continuously
/// differentiable and finite, with s = (J0 - J)/J0 and h = s^2/(1 + s):
///   ln J      ->  ln J0 - s - h/2                          (to second order their Taylor polynomials about J0, to first order far
///   J^(-2/3)  ->  J0^(-2/3) (1 + 2/3 s + 5/9 h)             away: a pull that stays bounded, as Irving, Teran & Fedkiw 2004 have)
///   Psi       ->  Psi + 6 mu (1 - I/I0)^3 where I < I0 = 3 J0^(2/3), which J < J0 follows from (I >= 3 |J|^(2/3)).
/// dPsi/dJ stays below 0 down to any inversion: elements are pushed back. Without the last term F = 0 would be a dip that
/// collapsed elements stay in (Smith, de Goes & Kim 2018 on degenerate states); with it no state but rotations is a minimum:
/// along F = r 1, r^3 < J0, the energy falls with r, which takes a factor of 10.7/2 at least; inverted r 1 may be saddles.
///
/// Kernels: with J_c = max(J, J0), r2 = J_c^(-2/3), s = (J_c - J)/J0, w = 1/(1 + s), so that above J0 s = 0 and w = 1, and
/// H = cof F: P = A F + g H,
///   A = 2 dPsi/dI = mu (r2 (1 + 2/3 s + 5/9 s^2 w) - 12 J0^(-2/3) (1 - I/I0)_+^2)
///   g = dPsi/dJ   = kappa/2 (J - (3 - w^2)/(2 J_c)) + dA/dJ I/2,   dA/dJ = -mu r2/J_c (11/9 - 5/9 w^2).
struct NeoHookean : TwoConstants {
  static constexpr const char* name = "neo_hookean";
  static constexpr const char* summary =
      "compressible, large strains; stiffens without bound, inverted elements are pushed back where they are allowed";
  static constexpr bool rotation_invariant = true;
  static constexpr bool survives_inversion = true;
  static constexpr bool recovers = true;
  static constexpr bool allows_inversion = false;

  static constexpr double smallest_ratio = 0.1;                  ///< J0
  static constexpr double smallest_square = 0.6463304070095654;  ///< I0 = 3 J0^(2/3)
  static constexpr double bump = 55.69906600335334;              ///< 12 J0^(-2/3)

  template <class T>
  static KOKKOS_INLINE_FUNCTION T bulk(const Lame<T>& c) {
    return c.lambda + T(2.0f) / T(3.0f) * c.mu;
  }

  /// What the three functions share.
  template <class T>
  struct Terms {
    using Real = typename LaneOf<T>::type;
    Mat3<T> H;
    T J, I, s, r2;
    T inverse;  ///< 1 / J_c
    T w;
    T close;  ///< (1 - I/I0)_+

    explicit KOKKOS_INLINE_FUNCTION Terms(const Mat3<T>& F)
        : H(cofactor(F)), J(dot(F[0], H[0])), I(inner(F, F)), s(T(0)) {
      const T kept = max(J, T(Real(smallest_ratio))), r = inverse_cube_root(kept);
      s = T(Real(1 / smallest_ratio)) * (kept - J);
      const T part = T(1) / (kept * (T(1) + s));
      r2 = r * r, inverse = (T(1) + s) * part, w = kept * part;
      close = max(T(1) - T(Real(1 / smallest_square)) * I, T(0));
    }
    KOKKOS_INLINE_FUNCTION T factor() const { return r2 * (T(1) + s * (T(Real(2.0 / 3)) + T(Real(5.0 / 9)) * s * w)); }
    KOKKOS_INLINE_FUNCTION T A(const T& mu) const { return mu * (factor() - T(Real(bump)) * close * close); }
    /// dlnJ/dJ
    KOKKOS_INLINE_FUNCTION T slope() const { return inverse * (T(1.5f) - T(0.5f) * w * w); }
    /// dA/dJ
    KOKKOS_INLINE_FUNCTION T A_J(const T& mu) const {
      return mu * r2 * inverse * (T(Real(5.0 / 9)) * w * w - T(Real(11.0 / 9)));
    }
  };

  template <class T>
  static KOKKOS_INLINE_FUNCTION T energy(const Mat3<T>& F, const Lame<T>& c) {
    const Terms<T> t(F);
    const T volume = t.J * t.J - T(1) + t.s * (T(2) + t.s * t.w) + T(2) * log(t.inverse);
    return T(0.25f) * bulk(c) * volume +
           c.mu * (T(0.5f) * (t.factor() * t.I - T(3)) + T(6) * t.close * t.close * t.close);
  }

  template <class T>
  static KOKKOS_INLINE_FUNCTION Mat3<T> stress(const Mat3<T>& F, const Lame<T>& c) {
    const Terms<T> t(F);
    const T g = T(0.5f) * (bulk(c) * (t.J - t.slope()) + t.A_J(c.mu) * t.I);
    return t.A(c.mu) * F + g * t.H;
  }

  template <class T>
  struct Tangent {
    Mat3<T> F, H;
    T A, A_J, A_I, g, g_J;  // A_I of dF:F, not of dI
    KOKKOS_INLINE_FUNCTION Tangent(const Mat3<T>& at, const Lame<T>& c) : F(at) {
      using Real = typename LaneOf<T>::type;
      const Terms<T> t(F);
      const T k = bulk(c), square = t.inverse * t.inverse * t.w * t.w * t.w;
      H = t.H, A = t.A(c.mu), A_J = t.A_J(c.mu);
      A_I = T(Real(4 * bump / smallest_square)) * c.mu * t.close;
      g = T(0.5f) * (k * (t.J - t.slope()) + A_J * t.I);
      g_J = T(0.5f) * k * (T(1) + square) + T(Real(5.0 / 9)) * c.mu * t.r2 * square * t.I;
    }
    KOKKOS_INLINE_FUNCTION Mat3<T> operator()(const Mat3<T>& dF) const {
      const T dJ = inner(H, dF), along = inner(F, dF);
      return A * dF + (A_J * dJ + A_I * along) * F + g * cofactor_change(F, dF) + (g_J * dJ + A_J * along) * H;
    }
    struct Corner {
      Vec3<T> g, f, h;  // with F and H
    };
    KOKKOS_INLINE_FUNCTION Corner corner(const Vec3<T>& x) const { return {x, F * x, H * x}; }
    /// A (p.q) I + (F p) dA^T + (H p) dg^T + g [F (q x p)]x with the derivatives dA and dg for q.
    KOKKOS_INLINE_FUNCTION Mat3<T> block(const Corner& p, const Corner& q) const {
      const Vec3<T> dA = A_J * q.h + A_I * q.f, dg = g_J * q.h + A_J * q.f;
      return Mat3<T>::diagonal(A * dot(p.g, q.g)) + outer(p.f, dA) + outer(p.h, dg) +
             g * cross_matrix(F * cross(q.g, p.g));
    }
  };

  template <class T>
  static KOKKOS_INLINE_FUNCTION Mat3<T> stress_change(const Mat3<T>& F, const Mat3<T>& dF, const Lame<T>& c) {
    return Tangent<T>(F, c)(dF);
  }
};

}  // namespace plica
