// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <plica/drivers/elastic/materials.hpp>
#include <plica/kernels/materials/material.hpp>

namespace plica::test {

/// A material that is not in the list, with three constants of its own: Psi = c1 (I1 - 3) + c2 (I2
/// - 3) + k/2 (J - 1)^2 - (2 c1 + 4 c2) ln J with I1 = |F|^2, I2 = |cof F|^2 (Mooney & Rivlin's
/// law, compressible: Bonet & Wood, Nonlinear Continuum Mechanics for FEA, 2nd ed., 6.4).
struct ThreeConstants {
  static constexpr const char* name = "three_constants";
  static constexpr bool survives_inversion = false;
  static constexpr std::array parameters{
      MaterialParameter{"c1", {keys::pressure, keys::positive}, "of the first invariant", 2e3},
      MaterialParameter{"c2", {keys::pressure, {.min = 0, .max = 1e6}}, "of the second", 700},
      MaterialParameter{"bulk", {keys::pressure, keys::positive}, "of the volume", 30e3}};

  template <class T>
  struct Constants {
    T c1, c2, bulk, rest;  // rest = 2 c1 + 4 c2
  };
  static Constants<double> kernel_constants(const double* p) {
    return {p[0], p[1], p[2], 2 * p[0] + 4 * p[1]};
  }
  static Lame<double> small_strains(const Constants<double>& c) {
    return {c.bulk + 4 * c.c2, 2 * (c.c1 + c.c2)};
  }

  template <class T>
  static KOKKOS_INLINE_FUNCTION T energy(const Mat3<T>& F, const Constants<T>& c) {
    const Mat3<T> H = cofactor(F);
    const T J = dot(F[0], H[0]);
    return c.c1 * (inner(F, F) - T(3)) + c.c2 * (inner(H, H) - T(3)) +
           T(0.5f) * c.bulk * (J - T(1)) * (J - T(1)) - c.rest * log(J);
  }
  template <class T>
  static KOKKOS_INLINE_FUNCTION Mat3<T> stress(const Mat3<T>& F, const Constants<T>& c) {
    const Mat3<T> H = cofactor(F);
    const T J = dot(F[0], H[0]);
    return T(2) * (c.c1 * F + c.c2 * cofactor_change(F, H)) +
           (c.bulk * (J - T(1)) - c.rest / J) * H;
  }
  template <class T>
  static KOKKOS_INLINE_FUNCTION Mat3<T> stress_change(const Mat3<T>& F, const Mat3<T>& dF,
                                                      const Constants<T>& c) {
    const Mat3<T> H = cofactor(F), dH = cofactor_change(F, dF);
    const T J = dot(F[0], H[0]);
    return T(2) * (c.c1 * dF + c.c2 * (cofactor_change(dF, H) + cofactor_change(F, dH))) +
           ((c.bulk + c.rest / (J * J)) * inner(H, dF)) * H +
           (c.bulk * (J - T(1)) - c.rest / J) * dH;
  }
};

/// What it says of itself, as those in the list do.
inline MaterialInfo three_constants() {
  using M = ThreeConstants;
  return {
      M::name, "",      true,   false, false, false, {M::parameters.begin(), M::parameters.end()},
      nullptr, nullptr, nullptr};
}

}  // namespace plica::test
