// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cmath>
#include <plica/kernels/materials/isochoric.hpp>

namespace plica {

/// Law of Holzapfel, Gasser & Ogden for arteries, with two families of fibres: W = c/2 (I1 - 3) +
/// k1/(2 k2) sum over a of (e^(k2 <E_a>^2) - 1), E_a = kappa (I1 - 3) + (1 - 3 kappa) (I4a - 1).
/// The families are at plus and minus `angle` from the axis, in the plane of axis and sheet; they
/// bear tension only. Holzapfel, Gasser & Ogden, J. Elasticity 61, 2000; with dispersion kappa:
/// Gasser, Ogden & Holzapfel, J. R. Soc. Interface 3, 2006.
struct HolzapfelGasserOgden : Isochoric<HolzapfelGasserOgden> {
  static constexpr const char* name = "holzapfel_gasser_ogden";
  static constexpr const char* summary =
      "arteries: two families of fibres that stiffen exponentially, in tension only";
  static constexpr bool isotropic = false;
  static constexpr bool has_fibres = true;
  static constexpr std::array parameters{
      MaterialParameter{"c",
                        {keys::pressure, keys::stiffness},
                        "of holzapfel_gasser_ogden: mu of the matrix",
                        5e3},
      MaterialParameter{"k1",
                        {keys::pressure, keys::not_negative},
                        "of holzapfel_gasser_ogden: of the fibres",
                        1e3},
      MaterialParameter{"k2",
                        {keys::plain, keys::positive},
                        "of holzapfel_gasser_ogden: in the fibres' exponent",
                        0.8},
      MaterialParameter{"kappa",
                        {keys::plain, {.min = 0, .max = 1.0 / 3}},
                        "of holzapfel_gasser_ogden: fibres' dispersion",
                        0},
      MaterialParameter{
          "angle", {keys::angle}, "of holzapfel_gasser_ogden: of both families from the axis", 0.6},
      parameter::bulk_modulus};
  static bool needs_sheet(const double* p) { return std::sin(2 * p[4]) != 0; }
  static Constants<double> kernel_constants(const double* p) {
    // mu bounds small strains, by the inequality in transversely_isotropic.hpp for each family
    const double aligned = 1 - 3 * p[3];
    Constants<double> c =
        constants(p + parameters.size(), p[5], p[0] + 8.0 / 3 * p[1] * aligned * aligned,
                  {p[0], p[1], p[2], p[3], aligned});
    const Vec3<double> along = std::cos(p[4]) * c.axis[0], across = std::sin(p[4]) * c.axis[1];
    c.axis[0] = along + across, c.axis[1] = along - across;
    return c;
  }

  /// Returns M_a, which gives E_a = M_a:C - 1.
  template <class T>
  static KOKKOS_INLINE_FUNCTION Mat3<T> structure(const IsochoricConstants<T>& c, int a) {
    return Mat3<T>::diagonal(c.own[3]) + c.own[4] * outer(c.axis[a], c.axis[a]);
  }
  template <class T>
  static KOKKOS_INLINE_FUNCTION T isochoric(const Mat3<T>& C, const IsochoricConstants<T>& c) {
    T fibres = T(0);
    for (int a = 0; a < 2; ++a) {
      const T E = max(inner(structure(c, a), C) - T(1), T(0));
      fibres += Exponential<T>(c.own[2] * E * E).less_one;
    }
    return T(0.5f) * (c.own[0] * (trace(C) - T(3)) + c.own[1] / c.own[2] * fibres);
  }
  template <class T, class To>
  static KOKKOS_INLINE_FUNCTION void respond(const Mat3<T>& C, const IsochoricConstants<T>& c,
                                             To& to) {
    to.stress(c.own[0], Mat3<T>::identity());
    for (int a = 0; a < 2; ++a) {
      const Mat3<T> M = structure(c, a);
      const T E = max(inner(M, C) - T(1), T(0)), q = c.own[2] * E * E, twice = T(2) * c.own[1];
      const Exponential<T> e(q);
      to.stress(twice * E * e.first, M);
      to.square(twice * where_positive(E, e.first + T(2) * q * e.second), M);
    }
  }
  template <class T>
  static KOKKOS_INLINE_FUNCTION Mat3<T> shape_at_rest(const Mat3<T>& e,
                                                      const IsochoricConstants<T>& c) {
    Mat3<T> S = (T(2) * c.own[0]) * e;
    const T fibre = T(4) * c.own[1] * c.own[4] * c.own[4];
    for (int a = 0; a < 2; ++a)
      S = S + (fibre * dot(c.axis[a], e * c.axis[a])) * outer(c.axis[a], c.axis[a]);
    return S;
  }
};

}  // namespace plica
