// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/fields.hpp>
#include <plica/kernels/materials/material.hpp>

// Damping by stiffness over a time tau. Each element has a second Piola-Kirchhoff stress against
// the rate of Green's strain (Kelvin and Voigt's law),
//
//   S_d = tau C0 : Edot,   Edot = sym(F^T Fdot),   P_d = F S_d,   C0 = dP/dF at rest.
//
// A body that turns has Fdot = W F with W antisymmetric, so Edot = 0 whatever its strain. The power
// P_d : Fdot = tau Edot : C0 : Edot is never negative. S_d is symmetric, so that angular momentum
// stays. The operator D(u) that takes v to -f_d is symmetric and positive semi-definite in every
// state. At rest it is that of Rayleigh, tau K.
namespace plica {

/// Tangent P_d / tau for a change dF in the place of Fdot, with the functions of a material's
/// tangent.
template <class Material, class T>
struct DampingTangent {
  Mat3<T> F;
  typename Material::template Constants<T> c;
  KOKKOS_INLINE_FUNCTION Mat3<T> operator()(const Mat3<T>& dF) const {
    return F * Material::stress_at_rest(transpose(F) * dF, c);
  }
  struct Corner {
    Vec3<T> g;
    Mat3<T> S[3];  // for e_k g^T
  };
  KOKKOS_INLINE_FUNCTION Corner corner(const Vec3<T>& g) const {
    Corner made{g, {}};
    for (int k = 0; k < 3; ++k) made.S[k] = Material::stress_at_rest(outer(F[k], g), c);
    return made;
  }
  KOKKOS_INLINE_FUNCTION Mat3<T> block(const Corner& p, const Corner& q) const {
    return F * transpose(Mat3<T>{q.S[0] * p.g, q.S[1] * p.g, q.S[2] * p.g});
  }
};

/// Rate of damping in the product of a patch.
template <class B>
struct DampingRate {
  using Real = typename B::Real;
  /// [patches] tau [s], or empty
  Scalars<B> damping;
  Real damping_scale = 0;  ///< factor of tau
  /// Returns true where there is damping.
  bool counts() const { return damping_scale > 0 && damping.extent(0) > 0; }
  KOKKOS_INLINE_FUNCTION Real operator()(int patch) const { return damping_scale * damping(patch); }
};

}  // namespace plica
