// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/materials/isochoric.hpp>

namespace plica {

/// Law of Veronda & Westmann: W = c1 (e^(c2 (I1 - 3)) - 1) - c1 c2/2 (I2 - 3). J. Biomechanics 3,
/// 1970. With c2 >= 1/3 W is not negative.
struct VerondaWestmann : InvariantLaw<VerondaWestmann> {
  static constexpr const char* name = "veronda_westmann";
  static constexpr const char* summary = "skin and liver: stiffens exponentially with I1";
  static constexpr std::array parameters{
      MaterialParameter{"c1",
                        {keys::pressure, keys::stiffness},
                        "of veronda_westmann: times the exponential",
                        3.5e3},
      MaterialParameter{"c2",
                        {keys::plain, {.min = 1.0 / 3}},
                        "of veronda_westmann: in the exponent; c1 c2 is mu at rest",
                        2},
      parameter::bulk_modulus};
  static Constants<double> kernel_constants(const double* p) {
    return constants(p + parameters.size(), p[2], p[0] * p[1], {p[0], p[1]});
  }

  template <class T>
  static KOKKOS_INLINE_FUNCTION OfInvariants<T> of_invariants(const T& x, const T& y,
                                                              const IsochoricConstants<T>& c) {
    const Exponential<T> e(c.own[1] * x);
    const T mu = c.own[0] * c.own[1], half = T(-0.5f) * mu, zero = T(0);
    return {c.own[0] * e.less_one + half * y, mu * e.first, half,
            mu * c.own[1] * e.second,         zero,         zero};
  }
};

}  // namespace plica
