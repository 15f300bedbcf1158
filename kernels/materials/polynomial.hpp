// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/materials/isochoric.hpp>

namespace plica {

/// Polynomial law of second order (Rivlin & Saunders 1951): W = c10 x + c01 y + c20 x^2 + c11 x y +
/// c02 y^2 with x = I1 - 3, y = I2 - 3.
struct Polynomial : InvariantLaw<Polynomial> {
  static constexpr const char* name = "polynomial";
  static constexpr const char* summary =
      "to second order in I1 - 3 and I2 - 3: stiffens where stretched";
  static constexpr std::array parameters{
      parameter::c10,
      parameter::c01,
      MaterialParameter{"c20", {keys::pressure}, "of polynomial: times (I1 - 3)^2", 1e3},
      MaterialParameter{"c11", {keys::pressure}, "of polynomial: times (I1 - 3) (I2 - 3)", 500},
      MaterialParameter{"c02", {keys::pressure}, "of polynomial: times (I2 - 3)^2", 300},
      parameter::bulk_modulus};
  static Constants<double> kernel_constants(const double* p) {
    return constants(p + parameters.size(), p[5], 2 * (p[0] + p[1]),
                     {p[0], p[1], p[2], p[3], p[4]});
  }

  template <class T>
  static KOKKOS_INLINE_FUNCTION OfInvariants<T> of_invariants(const T& x, const T& y,
                                                              const IsochoricConstants<T>& c) {
    const T(&p)[12] = c.own;
    const T two = T(2), ofx = p[2] * x + p[3] * y, ofy = p[4] * y;
    return {(p[0] + ofx) * x + (p[1] + ofy) * y,
            p[0] + p[2] * x + ofx,
            p[1] + p[3] * x + two * ofy,
            two * p[2],
            p[3],
            two * p[4]};
  }
};

}  // namespace plica
