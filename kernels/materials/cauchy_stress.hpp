// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/materials/material.hpp>

namespace plica {

/// The true stress sigma = P F^T / J [Pa]. Bonet & Wood, Nonlinear Continuum Mechanics for FEA, 2nd ed., eq. 5.45a.
template <class Material, class T>
KOKKOS_INLINE_FUNCTION Mat3<T> cauchy_stress(const Mat3<T>& F, const typename Material::template Constants<T>& c) {
  return (T(1) / determinant(F)) * (Material::stress(F, c) * transpose(F));
}

/// von Mises' equivalent stress sqrt(3/2 s : s), s the deviator [Pa]; of the symmetric part, since a law for small strains
/// gives a symmetric Cauchy stress to first order only.
template <class T>
KOKKOS_INLINE_FUNCTION T von_mises(const Mat3<T>& sigma) {
  const T x = sigma[0][0] - sigma[1][1], y = sigma[1][1] - sigma[2][2], z = sigma[2][2] - sigma[0][0];
  const T xy = sigma[0][1] + sigma[1][0], yz = sigma[1][2] + sigma[2][1], zx = sigma[2][0] + sigma[0][2];
  return sqrt(T(0.5f) * (x * x + y * y + z * z) + T(0.75f) * (xy * xy + yz * yz + zx * zx));
}

}  // namespace plica
