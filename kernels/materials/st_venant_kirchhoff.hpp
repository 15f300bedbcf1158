// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/materials/material.hpp>
#include <plica/kernels/materials/volumetric.hpp>

namespace plica {

/// St. Venant-Kirchhoff law: Psi = mu E:E + lambda/2 tr(E)^2 with Green's strain E = (F^T F - I)/2.
/// P = F S, S = 2 mu E + lambda tr(E) I. Bonet & Wood, Nonlinear Continuum Mechanics for FEA, 2nd
/// ed., eq. 6.28. It softens in compression and has no barrier against inversion.
struct StVenantKirchhoff : TwoConstants {
  static constexpr const char* name = "st_venant_kirchhoff";
  static constexpr const char* summary =
      "linear in Green's strain; large rotations, moderate strains; inverted elements may stay so";
  static constexpr bool rotation_invariant = true;
  static constexpr bool survives_inversion = true;
  static constexpr bool recovers = false;
  static constexpr bool allows_inversion = true;

  template <class T>
  static KOKKOS_INLINE_FUNCTION Mat3<T> strain(const Mat3<T>& F) {
    return T(0.5f) * (transpose(F) * F - Mat3<T>::identity());
  }

  template <class T>
  static KOKKOS_INLINE_FUNCTION Mat3<T> second_stress(const Mat3<T>& E, const Lame<T>& c) {
    return (c.mu + c.mu) * E + Mat3<T>::diagonal(c.lambda * trace(E));
  }

  /// The dilatation 1 + tr(E).
  template <class T>
  struct Dilatation {
    Mat3<T> slope;
    T value;
    explicit KOKKOS_INLINE_FUNCTION Dilatation(const Mat3<T>& F)
        : slope(F), value(T(0.5f) * (inner(F, F) - T(1))) {}
    KOKKOS_INLINE_FUNCTION Mat3<T> slope_change(const Mat3<T>& dF) const { return dF; }
  };
  template <class T>
  static KOKKOS_INLINE_FUNCTION Volumetric<T> volumetric(const T& x, const Lame<T>&) {
    return {VolumeRatio<T>(x), T(1), Volumetric<T>::quadratic};
  }

  template <class T>
  static KOKKOS_INLINE_FUNCTION T energy(const Mat3<T>& F, const Lame<T>& c) {
    const Mat3<T> E = strain(F);
    return c.mu * inner(E, E) + T(0.5f) * c.lambda * trace(E) * trace(E);
  }

  template <class T>
  static KOKKOS_INLINE_FUNCTION Mat3<T> stress(const Mat3<T>& F, const Lame<T>& c) {
    return F * second_stress(strain(F), c);
  }

  template <class T>
  struct Tangent {
    Mat3<T> F, S, FFt;
    Lame<T> c;
    KOKKOS_INLINE_FUNCTION Tangent(const Mat3<T>& at, const Lame<T>& constants)
        : F(at), S(second_stress(strain(at), constants)), FFt(at * transpose(at)), c(constants) {}
    KOKKOS_INLINE_FUNCTION Mat3<T> operator()(const Mat3<T>& dF) const {
      const Mat3<T> G = transpose(F) * dF;
      return dF * S + F * second_stress(T(0.5f) * (G + transpose(G)), c);
    }
    struct Corner {
      Vec3<T> g, f, s;  // f = F g, s = S g
    };
    KOKKOS_INLINE_FUNCTION Corner corner(const Vec3<T>& g) const { return {g, F * g, S * g}; }
    /// Returns (p.S q) I + lambda (F p)(F q)^T + mu (F q)(F p)^T + mu (p.q) F F^T.
    KOKKOS_INLINE_FUNCTION Mat3<T> block(const Corner& p, const Corner& q) const {
      Mat3<T> K = Mat3<T>::diagonal(dot(p.g, q.s));
      const T w = c.mu * dot(p.g, q.g);
      for (int i = 0; i < 3; ++i)
        K[i] += (c.lambda * p.f[i]) * q.f + (c.mu * q.f[i]) * p.f +
                Vec3<T>{w * FFt[i][0], w * FFt[i][1], w * FFt[i][2]};
      return K;
    }
  };

  template <class T>
  static KOKKOS_INLINE_FUNCTION Mat3<T> stress_change(const Mat3<T>& F, const Mat3<T>& dF,
                                                      const Lame<T>& c) {
    return Tangent<T>(F, c)(dF);
  }
};

}  // namespace plica
