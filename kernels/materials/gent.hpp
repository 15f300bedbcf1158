// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/materials/isochoric.hpp>

namespace plica {

/// Gent's law: W = -mu J_m/2 ln(1 - (I1 - 3)/J_m). It locks where I1 - 3 comes to J_m (Gent, Rubber
/// Chem. Technol. 69, 1996). Beyond 15/16 of J_m it is continued by its Taylor polynomial of second
/// order, which is finite for any element.
struct Gent : InvariantLaw<Gent> {
  static constexpr const char* name = "gent";
  static constexpr const char* summary = "rubber and arteries: locks where I1 - 3 comes to j_m";
  static constexpr std::array parameters{
      parameter::mu,
      MaterialParameter{"j_m", {keys::plain, keys::positive}, "of gent: I1 - 3 where it locks", 2},
      parameter::bulk_modulus};
  static Constants<double> kernel_constants(const double* p) {
    return constants(p + parameters.size(), p[2], p[0], {p[0] / 2, p[1]});
  }

  template <class T>
  static KOKKOS_INLINE_FUNCTION OfInvariants<T> of_invariants(const T& x, const T&,
                                                              const IsochoricConstants<T>& c) {
    const T half_mu = c.own[0], lock = c.own[1], over = max(x - T(0.9375f) * lock, T(0)),
            zero = T(0);
    const T rest = T(1) - (x - over) / lock, first = half_mu / rest, second = first / (lock * rest);
    const T W = over * (first + T(0.5f) * over * second) - half_mu * lock * log(rest);
    return {W, first + over * second, zero, second, zero, zero};
  }
};

}  // namespace plica
