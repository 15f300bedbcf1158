// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/materials/material.hpp>

namespace plica {

/// Psi = kappa/4 (J^2 - 1 - 2 ln J) + mu/2 (J^(-2/3) tr(F^T F) - 3), kappa = lambda + 2 mu/3.
/// Simo & Hughes, Computational Inelasticity, eq. 9.2.6. Infinite at J = 0: an inverted element is an error. Here
/// H = cof F = J F^-T, so that with a = mu J^(-2/3), I = tr(F^T F) and g = (kappa/2 (J^2 - 1) - a I/3)/J: P = a F + g
/// H.
struct NeoHookean {
  static constexpr const char* name = "neo_hookean";
  static constexpr const char* summary = "compressible, large strains; never inverted";
  static constexpr bool rotation_invariant = true;
  static constexpr bool survives_inversion = false;

  template <class T>
  static KOKKOS_INLINE_FUNCTION T bulk(const Lame<T>& c) {
    return c.lambda + T(2.0f) / T(3.0f) * c.mu;
  }

  template <class T>
  static KOKKOS_INLINE_FUNCTION T energy(const Mat3<T>& F, const Lame<T>& c) {
    const T J = determinant(F), r = inverse_cube_root(J);
    return T(0.25f) * bulk(c) * (J * J - T(1) - T(2) * log(J)) + T(0.5f) * c.mu * (r * r * inner(F, F) - T(3));
  }

  template <class T>
  static KOKKOS_INLINE_FUNCTION Mat3<T> stress(const Mat3<T>& F, const Lame<T>& c) {
    const Mat3<T> H = cofactor(F);
    const T J = dot(F[0], H[0]), r = inverse_cube_root(J), a = c.mu * r * r;
    const T g = (T(0.5f) * bulk(c) * (J * J - T(1)) - a * inner(F, F) / T(3)) / J;
    return a * F + g * H;
  }

  template <class T>
  struct Tangent {
    Mat3<T> F, H;
    T J, a, I, k, g;
    KOKKOS_INLINE_FUNCTION Tangent(const Mat3<T>& at, const Lame<T>& c)
        : F(at), H(cofactor(at)), J(dot(F[0], H[0])), I(inner(F, F)), k(bulk(c)) {
      const T r = inverse_cube_root(J);
      a = c.mu * r * r;
      g = (T(0.5f) * k * (J * J - T(1)) - a * I / T(3)) / J;
    }
    KOKKOS_INLINE_FUNCTION Mat3<T> operator()(const Mat3<T>& dF) const {
      const T dJ = inner(H, dF), dI = T(2) * inner(F, dF), da = T(-2) / T(3) * a * dJ / J;
      const T dg = (k * J * dJ - (da * I + a * dI) / T(3) - g * dJ) / J;
      return a * dF + da * F + g * cofactor_change(F, dF) + dg * H;
    }
    struct Corner {
      Vec3<T> g, f, h;  // with F and H
    };
    KOKKOS_INLINE_FUNCTION Corner corner(const Vec3<T>& x) const { return {x, F * x, H * x}; }
    /// a (p.q) I + (F p) da^T + (H p) dg^T + g [F (q x p)]x with the derivatives da and dg for q.
    KOKKOS_INLINE_FUNCTION Mat3<T> block(const Corner& p, const Corner& q) const {
      const T third = T(2) / T(3) * a / J;
      const Vec3<T> da = (-third) * q.h, dg = ((k * J - g + third * I / T(3)) / J) * q.h - third * q.f;
      return Mat3<T>::diagonal(a * dot(p.g, q.g)) + outer(p.f, da) + outer(p.h, dg) +
             g * cross_matrix(F * cross(q.g, p.g));
    }
  };

  template <class T>
  static KOKKOS_INLINE_FUNCTION Mat3<T> stress_change(const Mat3<T>& F, const Mat3<T>& dF, const Lame<T>& c) {
    return Tangent<T>(F, c)(dF);
  }
};

}  // namespace plica
