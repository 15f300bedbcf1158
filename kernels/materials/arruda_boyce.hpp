// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/materials/isochoric.hpp>

namespace plica {

/// Law of Arruda & Boyce (J. Mech. Phys. Solids 41, 1993): chains that lock at the stretch
/// lambda_m, in a series of five terms. W = mu sum over k = 1 ... 5 of C_k / N^(k - 1) (I1^k -
/// 3^k), N = lambda_m^2, C = 1/2, 1/20, 11/1050, 19/7000, 519/673750.
struct ArrudaBoyce : InvariantLaw<ArrudaBoyce> {
  static constexpr const char* name = "arruda_boyce";
  static constexpr const char* summary =
      "chains that lock at the stretch lambda_m, in five terms of I1";
  static constexpr std::array parameters{
      parameter::mu,
      MaterialParameter{"lambda_m",
                        {keys::plain, {.min = 1, .min_excluded = true}},
                        "of arruda_boyce: stretch where chains lock",
                        2},
      parameter::bulk_modulus};
  static Constants<double> kernel_constants(const double* p) {
    constexpr double C[5] = {1.0 / 2, 1.0 / 20, 11.0 / 1050, 19.0 / 7000, 519.0 / 673750};
    // mu at rest = 2 sum of k c_k 3^(k - 1)
    double coefficient[5], mu = 0, scale = p[0], power = 1;
    for (int k = 0; k < 5; ++k) {
      coefficient[k] = scale * C[k], mu += 2 * (k + 1) * coefficient[k] * power;
      scale /= p[1] * p[1], power *= 3;
    }
    return constants(
        p + parameters.size(), p[2], mu,
        {coefficient[0], coefficient[1], coefficient[2], coefficient[3], coefficient[4]});
  }

  /// Computes I1^k - 3^k with x = I1 - 3, and its derivatives, from one k to the next.
  template <class T>
  static KOKKOS_INLINE_FUNCTION OfInvariants<T> of_invariants(const T& x, const T&,
                                                              const IsochoricConstants<T>& c) {
    const T I = x + T(3), zero = T(0);
    T W = zero, first = zero, second = zero, d0 = zero, d1 = zero, d2 = zero, rest = T(1);
    for (int k = 0; k < 5; ++k) {
      d2 = I * d2 + T(2) * d1, d1 = I * d1 + d0 + rest, d0 = I * d0 + rest * x, rest = T(3) * rest;
      W += c.own[k] * d0, first += c.own[k] * d1, second += c.own[k] * d2;
    }
    return {W, first, zero, second, zero, zero};
  }
};

}  // namespace plica
