// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <plica/kernels/materials/isochoric.hpp>

namespace plica {

namespace parameter {
constexpr MaterialParameter strain_weight(const char* name, const char* help, double standard) {
  return {name, {keys::plain, keys::positive}, help, standard};
}
}  // namespace parameter

/// Costa's law for heart muscle: W = a/2 (e^Q - 1), Q = sum over i and j of b_ij E_ij^2, E = (C -
/// 1)/2 in the axes of fibre f, sheet s and normal n = f x s. Costa, Holmes & McCulloch, Phil.
/// Trans. R. Soc. A 359, 2001. With b_ss = b_nn = b_sn and b_fs = b_fn it is the law of Guccione,
/// McCulloch & Waldman, J. Biomech. Eng. 113, 1991.
struct Costa : Isochoric<Costa> {
  static constexpr const char* name = "costa";
  static constexpr const char* summary =
      "heart muscle (Costa, Guccione): exponential in the strains along fibre, sheet, normal";
  static constexpr bool isotropic = false;
  static constexpr bool has_fibres = true;
  static constexpr std::array parameters{
      MaterialParameter{
          "a", {keys::pressure, keys::stiffness}, "of costa: times half the exponential", 2e3},
      parameter::strain_weight("b_ff", "of costa: times the square of the strain along the fibres",
                               8),
      parameter::strain_weight("b_ss", "of costa: along the sheet", 3),
      parameter::strain_weight("b_nn", "of costa: along the normal of both", 2),
      parameter::strain_weight("b_fs", "of costa: of shear between fibre and sheet, counted twice",
                               4),
      parameter::strain_weight("b_fn", "of costa: between fibre and normal, counted twice", 3.5),
      parameter::strain_weight("b_sn", "of costa: between sheet and normal, counted twice", 2.5),
      parameter::bulk_modulus};
  static bool needs_sheet(const double* p) { return p[2] != p[3] || p[2] != p[6] || p[4] != p[5]; }
  static Constants<double> kernel_constants(const double* p) {
    return constants(p + parameters.size(), p[7], p[0] * *std::max_element(p + 1, p + 7) / 2,
                     {p[0], p[1], p[2], p[3], p[4], p[5], p[6]});
  }

  /// Strains E_ij in the fibres' axes, and the matrices M_ij = sym(a_i a_j^T) that give them.
  /// Order: ff ss nn fs fn sn.
  template <class T>
  struct Strains {
    Mat3<T> M[6];
    T E[6];
    KOKKOS_INLINE_FUNCTION Strains(const Mat3<T>& G, const IsochoricConstants<T>& c) {
      const Vec3<T> axis[3] = {c.axis[0], c.axis[1], cross(c.axis[0], c.axis[1])};
      constexpr int first[6] = {0, 1, 2, 0, 0, 1}, second[6] = {0, 1, 2, 1, 2, 2};
      for (int k = 0; k < 6; ++k) {
        const Mat3<T> A = outer(axis[first[k]], axis[second[k]]);
        M[k] = T(0.5f) * (A + transpose(A));
        E[k] = inner(M[k], G);
      }
    }
    static KOKKOS_INLINE_FUNCTION T times(int k) { return T(k < 3 ? 1 : 2); }
    KOKKOS_INLINE_FUNCTION T exponent(const IsochoricConstants<T>& c) const {
      T Q = T(0);
      for (int k = 0; k < 6; ++k) Q += times(k) * c.own[1 + k] * E[k] * E[k];
      return Q;
    }
    /// Returns dQ/dE / 2.
    KOKKOS_INLINE_FUNCTION Mat3<T> slope(const IsochoricConstants<T>& c) const {
      Mat3<T> G;
      for (int k = 0; k < 6; ++k) G = G + (times(k) * c.own[1 + k] * E[k]) * M[k];
      return G;
    }
  };
  template <class T>
  static KOKKOS_INLINE_FUNCTION Mat3<T> strain(const Mat3<T>& C) {
    return T(0.5f) * (C - Mat3<T>::identity());
  }

  template <class T>
  static KOKKOS_INLINE_FUNCTION T isochoric(const Mat3<T>& C, const IsochoricConstants<T>& c) {
    return T(0.5f) * c.own[0] * Exponential<T>(Strains<T>(strain(C), c).exponent(c)).less_one;
  }
  template <class T, class To>
  static KOKKOS_INLINE_FUNCTION void respond(const Mat3<T>& C, const IsochoricConstants<T>& c,
                                             To& to) {
    const Strains<T> strains(strain(C), c);
    const Exponential<T> e(strains.exponent(c));
    const Mat3<T> G = strains.slope(c);
    for (int k = 0; k < 6; ++k)
      to.square(T(0.5f) * c.own[0] * e.first * (strains.times(k) * c.own[1 + k]), strains.M[k]);
    to.stress(c.own[0] * e.first, G), to.square(c.own[0] * e.second, G);
  }
  template <class T>
  static KOKKOS_INLINE_FUNCTION Mat3<T> shape_at_rest(const Mat3<T>& e,
                                                      const IsochoricConstants<T>& c) {
    return c.own[0] * Strains<T>(e, c).slope(c);
  }
};

}  // namespace plica
