// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/materials/isochoric.hpp>

namespace plica {

/// Mooney-Rivlin law: W = c10 (I1 - 3) + c01 (I2 - 3). Mooney 1940, Rivlin 1948; Holzapfel,
/// Nonlinear Solid Mechanics, eq. 6.128.
struct MooneyRivlin : InvariantLaw<MooneyRivlin> {
  static constexpr const char* name = "mooney_rivlin";
  static constexpr const char* summary = "rubber-like, large strains: c10 (I1 - 3) + c01 (I2 - 3)";
  static constexpr std::array parameters{parameter::c10, parameter::c01, parameter::bulk_modulus};
  static Constants<double> kernel_constants(const double* p) {
    return constants(p + parameters.size(), p[2], 2 * (p[0] + p[1]), {p[0], p[1]});
  }

  template <class T>
  static KOKKOS_INLINE_FUNCTION OfInvariants<T> of_invariants(const T& x, const T& y,
                                                              const IsochoricConstants<T>& c) {
    const T zero = T(0);
    return {c.own[0] * x + c.own[1] * y, c.own[0], c.own[1], zero, zero, zero};
  }
};

}  // namespace plica
