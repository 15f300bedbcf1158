// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/materials/volume_ratio.hpp>

// Energy of the volume, U of a dilatation. The dilatation is a measure of the volume that is 1 at
// rest. It is J in most laws. Where nodal elements smooth pressures, U acts on smoothed
// dilatations.
namespace plica {

/// Energy U of a dilatation J and its derivatives; the second derivative at rest is k.
template <class T>
struct Volumetric {
  enum Choice { simo_hughes, logarithmic, quadratic };
  T energy, first, second;
  KOKKOS_INLINE_FUNCTION Volumetric(const VolumeRatio<T>& v, const T& k, int choice) {
    const T half = T(0.5f) * k;
    // k/4 (J^2 - 1 - 2 ln J): Simo & Hughes, Computational Inelasticity, eq. 9.2.6
    if (choice == simo_hughes) {
      energy = half * (T(0.5f) * (v.J * v.J - T(1)) - v.log_ratio());
      first = half * (v.J - v.slope()), second = half * (T(1) + v.square());
    } else if (choice == logarithmic) {  // k/2 (ln J)^2
      const T L = v.log_ratio(), slope = v.slope();
      energy = half * L * L, first = k * L * slope, second = k * (slope * slope - L * v.square());
    } else {  // k/2 (J - 1)^2
      energy = half * (v.J - T(1)) * (v.J - T(1)), first = k * (v.J - T(1)), second = k;
    }
  }
};

/// The dilatation J = det F.
template <class T>
struct VolumeDilatation {
  Mat3<T> F, slope;  ///< slope: dJ/dF = cof F
  T value;
  explicit KOKKOS_INLINE_FUNCTION VolumeDilatation(const Mat3<T>& at)
      : F(at), slope(cofactor(at)), value(dot(at[0], slope[0])) {}
  /// Returns the change of the slope for a change of F.
  KOKKOS_INLINE_FUNCTION Mat3<T> slope_change(const Mat3<T>& dF) const {
    return cofactor_change(F, dF);
  }
};

}  // namespace plica
