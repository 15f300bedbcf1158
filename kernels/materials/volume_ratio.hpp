// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/functions.hpp>
#include <plica/core/small.hpp>

namespace plica {

/// Ratio J = det F for laws with a barrier at J = 0: ln J and J^(-2/3) with their derivatives.
/// Below J0 = 0.1 both are continued, twice continuously differentiable and finite, with s = (J0 -
/// J)/J0 and h = s^2/(1 + s):
///   ln J      ->  ln J0 - s - h/2
///   J^(-2/3)  ->  J0^(-2/3) (1 + 2/3 s + 5/9 h)
/// To second order these are their Taylor polynomials about J0. Far away they are of first order: a
/// pull that stays bounded, as Irving, Teran & Fedkiw 2004 have. The kernels use J_c = max(J, J0),
/// s = (J_c - J)/J0, w = 1/(1 + s), so that above J0 s = 0 and w = 1.
template <class T>
struct VolumeRatio {
  using Real = typename LaneOf<T>::type;
  static constexpr double smallest = 0.1;  ///< J0
  T J;
  T s;
  T r2;       ///< J_c^(-2/3)
  T inverse;  ///< 1 / J_c
  T w;

  explicit KOKKOS_INLINE_FUNCTION VolumeRatio(const T& det) : J(det), s(T(0)) {
    const T kept = max(J, T(Real(smallest))), r = inverse_cube_root(kept);
    s = T(Real(1 / smallest)) * (kept - J);
    const T part = T(1) / (kept * (T(1) + s));
    r2 = r * r, inverse = (T(1) + s) * part, w = kept * part;
  }
  /// Returns R, which stands for J^(-2/3); factor_slope() dR/dJ; factor_bend() d2R/dJ2.
  KOKKOS_INLINE_FUNCTION T factor() const {
    return r2 * (T(1) + s * (T(Real(2.0 / 3)) + T(Real(5.0 / 9)) * s * w));
  }
  KOKKOS_INLINE_FUNCTION T factor_slope() const {
    return r2 * inverse * (T(Real(5.0 / 9)) * w * w - T(Real(11.0 / 9)));
  }
  KOKKOS_INLINE_FUNCTION T factor_bend() const { return T(Real(10.0 / 9)) * r2 * square(); }
  /// Returns L, which stands for ln J; slope() dL/dJ; square() -d2L/dJ2.
  KOKKOS_INLINE_FUNCTION T log_ratio() const {
    return -log(inverse) - s * (T(1) + T(0.5f) * s * w);
  }
  KOKKOS_INLINE_FUNCTION T slope() const { return inverse * (T(1.5f) - T(0.5f) * w * w); }
  KOKKOS_INLINE_FUNCTION T square() const { return inverse * inverse * w * w * w; }
};

/// Term 6 mu (1 - I/I0)^3 that is added to Psi where I = |F|^2 < I0 = 3 J0^(2/3). There J < J0 too,
/// since I >= 3 |J|^(2/3). Without the term F = 0 would be a local minimum in which collapsed
/// elements stay (Smith, de Goes & Kim 2018 on degenerate states). The stress of the term is -mu
/// stress() F.
template <class T>
struct CrushedTerm {
  using Real = typename LaneOf<T>::type;
  static constexpr double smallest = 0.6463304070095654;  ///< I0
  static constexpr double bump = 55.69906600335334;       ///< 36 / I0
  T close;                                                ///< (1 - I/I0)_+
  explicit KOKKOS_INLINE_FUNCTION CrushedTerm(const T& I)
      : close(max(T(1) - T(Real(1 / smallest)) * I, T(0))) {}
  KOKKOS_INLINE_FUNCTION T energy() const { return T(6) * close * close * close; }
  KOKKOS_INLINE_FUNCTION T stress() const { return T(Real(bump)) * close * close; }
  /// Returns minus the derivative of stress() by F:dF.
  KOKKOS_INLINE_FUNCTION T stiffness() const { return T(Real(4 * bump / smallest)) * close; }
};

}  // namespace plica
