// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/materials/material.hpp>

namespace plica {

/// Hooke's law: Psi = mu e:e + lambda/2 tr(e)^2 with the small strain e = (F + F^T)/2 - I. It is
/// not for rotations: turned by theta about z, the unstrained body has sigma_xx = 2 (mu + lambda)
/// (cos theta - 1).
struct Linear : TwoConstants {
  static constexpr const char* name = "linear";
  static constexpr const char* summary = "Hooke's law; small displacements and rotations only";
  static constexpr bool rotation_invariant = false;
  static constexpr bool survives_inversion = true;
  static constexpr bool recovers = true;  // the energy is convex
  static constexpr bool allows_inversion = true;

  template <class T>
  static KOKKOS_INLINE_FUNCTION T energy(const Mat3<T>& F, const Lame<T>& c) {
    const Mat3<T> G = F - Mat3<T>::identity();
    return T(0.5f) * inner(G, stress_at_rest(G, c));
  }

  template <class T>
  static KOKKOS_INLINE_FUNCTION Mat3<T> stress(const Mat3<T>& F, const Lame<T>& c) {
    return stress_at_rest(F - Mat3<T>::identity(), c);
  }

  template <class T>
  struct Tangent {
    Lame<T> c;
    KOKKOS_INLINE_FUNCTION Tangent(const Mat3<T>&, const Lame<T>& constants) : c(constants) {}
    KOKKOS_INLINE_FUNCTION Mat3<T> operator()(const Mat3<T>& dF) const {
      return stress_at_rest(dF, c);
    }
    using Corner = Vec3<T>;
    KOKKOS_INLINE_FUNCTION Corner corner(const Vec3<T>& g) const { return g; }
    KOKKOS_INLINE_FUNCTION Mat3<T> block(const Corner& p, const Corner& q) const {
      return Mat3<T>::diagonal(c.mu * dot(p, q)) + outer(c.lambda * p, q) + outer(c.mu * q, p);
    }
  };

  template <class T>
  static KOKKOS_INLINE_FUNCTION Mat3<T> stress_change(const Mat3<T>& F, const Mat3<T>& dF,
                                                      const Lame<T>& c) {
    return Tangent<T>(F, c)(dF);
  }
};

}  // namespace plica
