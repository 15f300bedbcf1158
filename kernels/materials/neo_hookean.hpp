// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/materials/material.hpp>
#include <plica/kernels/materials/volumetric.hpp>

namespace plica {

/// Neo-Hookean law: Psi = kappa/4 (J^2 - 1 - 2 ln J) + mu/2 (J^(-2/3) I - 3), I = tr(F^T F), kappa
/// = lambda + 2 mu/3. Simo & Hughes, Computational Inelasticity, eq. 9.2.6. This Psi is infinite at
/// J = 0; below J0 = 0.1 it is continued as volume_ratio.hpp says. dPsi/dJ stays below 0 down to
/// any inversion, so that inverted elements are pushed back. With the term at F = 0 (CrushedTerm)
/// no state but rotations is a minimum: along F = r 1, r^3 < J0, the energy falls with r. For this
/// the factor of that term must be at least 10.7/2; inverted r 1 may be saddles.
///
/// Formulas of the kernels, with s and w of volume_ratio.hpp and H = cof F: P = A F + g H,
///   A = 2 dPsi/dI = mu (R - 12 J0^(-2/3) (1 - I/I0)_+^2),   R for J^(-2/3)
///   g = dPsi/dJ   = kappa/2 (J - (3 - w^2)/(2 J_c)) + dA/dJ I/2.
struct NeoHookean : TwoConstants {
  static constexpr const char* name = "neo_hookean";
  static constexpr const char* summary =
      "compressible, large strains; stiffens without bound, inverted elements are pushed back "
      "where they are allowed";
  static constexpr bool rotation_invariant = true;
  static constexpr bool survives_inversion = true;
  static constexpr bool recovers = true;
  static constexpr bool allows_inversion = false;
  static constexpr bool splits_shape = true;
  /// Returns the constants with the energy of shape times `share`, and kappa = bulk.
  static Lame<double> with_shape(const Lame<double>& c, double share, double bulk) {
    return {bulk - 2 * share * c.mu / 3, share * c.mu};
  }

  template <class T>
  using Dilatation = VolumeDilatation<T>;
  template <class T>
  static KOKKOS_INLINE_FUNCTION Volumetric<T> volumetric(const T& J, const Lame<T>&) {
    return {VolumeRatio<T>(J), T(1), Volumetric<T>::simo_hughes};
  }

  template <class T>
  static KOKKOS_INLINE_FUNCTION T bulk(const Lame<T>& c) {
    return c.lambda + T(2.0f) / T(3.0f) * c.mu;
  }

  /// Terms that energy, stress and tangent share.
  template <class T>
  struct Terms : VolumeRatio<T> {
    Mat3<T> H;
    T I;
    CrushedTerm<T> crushed;

    explicit KOKKOS_INLINE_FUNCTION Terms(const Mat3<T>& F) : Terms(F, cofactor(F)) {}
    KOKKOS_INLINE_FUNCTION Terms(const Mat3<T>& F, const Mat3<T>& cof)
        : VolumeRatio<T>(dot(F[0], cof[0])), H(cof), I(inner(F, F)), crushed(I) {}
    KOKKOS_INLINE_FUNCTION T A(const T& mu) const {
      return mu * (this->factor() - crushed.stress());
    }
    /// Returns dA/dJ.
    KOKKOS_INLINE_FUNCTION T A_J(const T& mu) const { return mu * this->factor_slope(); }
  };

  template <class T>
  static KOKKOS_INLINE_FUNCTION T energy(const Mat3<T>& F, const Lame<T>& c) {
    const Terms<T> t(F);
    const T volume = t.J * t.J - T(1) - T(2) * t.log_ratio();
    return T(0.25f) * bulk(c) * volume +
           c.mu * (T(0.5f) * (t.factor() * t.I - T(3)) + t.crushed.energy());
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
    T A, A_J, A_I, g, g_J;  // A_I: factor of dF:F, not of dI
    KOKKOS_INLINE_FUNCTION Tangent(const Mat3<T>& at, const Lame<T>& c) : F(at) {
      const Terms<T> t(F);
      const T k = bulk(c);
      H = t.H, A = t.A(c.mu), A_J = t.A_J(c.mu);
      A_I = c.mu * t.crushed.stiffness();
      g = T(0.5f) * (k * (t.J - t.slope()) + A_J * t.I);
      g_J = T(0.5f) * (k * (T(1) + t.square()) + c.mu * t.factor_bend() * t.I);
    }
    KOKKOS_INLINE_FUNCTION Mat3<T> operator()(const Mat3<T>& dF) const {
      const T dJ = inner(H, dF), along = inner(F, dF);
      return A * dF + (A_J * dJ + A_I * along) * F + g * cofactor_change(F, dF) +
             (g_J * dJ + A_J * along) * H;
    }
    struct Corner {
      Vec3<T> g, f, h;  // f = F g, h = H g
    };
    KOKKOS_INLINE_FUNCTION Corner corner(const Vec3<T>& x) const { return {x, F * x, H * x}; }
    /// Returns A (p.q) I + (F p) dA^T + (H p) dg^T + g [F (q x p)]x with the derivatives dA and dg
    /// for q.
    KOKKOS_INLINE_FUNCTION Mat3<T> block(const Corner& p, const Corner& q) const {
      const Vec3<T> dA = A_J * q.h + A_I * q.f, dg = g_J * q.h + A_J * q.f;
      return Mat3<T>::diagonal(A * dot(p.g, q.g)) + outer(p.f, dA) + outer(p.h, dg) +
             g * cross_matrix(F * cross(q.g, p.g));
    }
  };

  template <class T>
  static KOKKOS_INLINE_FUNCTION Mat3<T> stress_change(const Mat3<T>& F, const Mat3<T>& dF,
                                                      const Lame<T>& c) {
    return Tangent<T>(F, c)(dF);
  }
};

}  // namespace plica
