// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/materials/isochoric.hpp>

namespace plica {

/// Neo-Hookean law with fibres of direction a: W = mu/2 (I1 - 3) + eta/2 (I4 - 1)^2, I4 = a.C a.
/// Taylor et al., Medical Image Analysis 13, 2009.
struct TransverselyIsotropic : Isochoric<TransverselyIsotropic> {
  static constexpr const char* name = "transversely_isotropic";
  static constexpr const char* summary =
      "neo-Hookean with fibres in one direction, which resist push and pull";
  static constexpr bool isotropic = false;
  static constexpr bool has_fibres = true;
  static constexpr std::array parameters{
      parameter::mu,
      MaterialParameter{"eta",
                        {keys::pressure, keys::not_negative},
                        "of transversely_isotropic: of the fibres",
                        2e3},
      parameter::bulk_modulus};
  // The bound of mu follows from (a.e a)^2 <= 2/3 |e|^2 of a deviator e.
  static Constants<double> kernel_constants(const double* p) {
    return constants(p + parameters.size(), p[2], p[0] + 4 * p[1] / 3, {p[0], p[1]});
  }

  template <class T>
  static KOKKOS_INLINE_FUNCTION T isochoric(const Mat3<T>& C, const IsochoricConstants<T>& c) {
    const T y = dot(c.axis[0], C * c.axis[0]) - T(1);
    return T(0.5f) * (c.own[0] * (trace(C) - T(3)) + c.own[1] * y * y);
  }
  template <class T, class To>
  static KOKKOS_INLINE_FUNCTION void respond(const Mat3<T>& C, const IsochoricConstants<T>& c,
                                             To& to) {
    const Mat3<T> M = outer(c.axis[0], c.axis[0]);
    const T twice = T(2) * c.own[1];
    to.stress(c.own[0], Mat3<T>::identity()), to.stress(twice * (inner(M, C) - T(1)), M);
    to.square(twice, M);
  }
  template <class T>
  static KOKKOS_INLINE_FUNCTION Mat3<T> shape_at_rest(const Mat3<T>& e,
                                                      const IsochoricConstants<T>& c) {
    return (T(2) * c.own[0]) * e +
           (T(4) * c.own[1] * dot(c.axis[0], e * c.axis[0])) * outer(c.axis[0], c.axis[0]);
  }
};

}  // namespace plica
