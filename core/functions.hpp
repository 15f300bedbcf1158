// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/pack.hpp>

// Elementary functions that pointwise physics needs, on plain numbers and on packs.
namespace plica {

namespace functions {

/// x^(-1/3) for x > 0 by Halley's method from a guess of the exponent's third; NaN where x <= 0 or is not finite.
template <class T>
KOKKOS_INLINE_FUNCTION T inverse_cube_root_guess(T x);
template <>
KOKKOS_INLINE_FUNCTION double inverse_cube_root_guess(double x) {
  return Kokkos::bit_cast<double>(0x553ef0ff289dd796ULL - Kokkos::bit_cast<unsigned long long>(x) / 3);
}
template <>
KOKKOS_INLINE_FUNCTION float inverse_cube_root_guess(float x) {
  return Kokkos::bit_cast<float>(0x54a21d2aU - Kokkos::bit_cast<unsigned>(x) / 3);
}

}  // namespace functions

template <class T, int N>
KOKKOS_INLINE_FUNCTION Pack<T, N> sqrt(const Pack<T, N>& a) {
  return Pack<T, N>::map(a, [](T x) { return Kokkos::sqrt(x); });
}
KOKKOS_INLINE_FUNCTION double sqrt(double x) { return Kokkos::sqrt(x); }
KOKKOS_INLINE_FUNCTION float sqrt(float x) { return Kokkos::sqrt(x); }

template <class T, int N>
KOKKOS_INLINE_FUNCTION Pack<T, N> log(const Pack<T, N>& a) {
  return Pack<T, N>::map(a, [](T x) { return Kokkos::log(x); });
}
KOKKOS_INLINE_FUNCTION double log(double x) { return Kokkos::log(x); }
KOKKOS_INLINE_FUNCTION float log(float x) { return Kokkos::log(x); }

template <class T, int N>
KOKKOS_INLINE_FUNCTION Pack<T, N> exp(const Pack<T, N>& a) {
  return Pack<T, N>::map(a, [](T x) { return Kokkos::exp(x); });
}
KOKKOS_INLINE_FUNCTION double exp(double x) { return Kokkos::exp(x); }
KOKKOS_INLINE_FUNCTION float exp(float x) { return Kokkos::exp(x); }

/// b where a > 0, else 0
template <class T, int N>
KOKKOS_INLINE_FUNCTION Pack<T, N> where_positive(const Pack<T, N>& a, const Pack<T, N>& b) {
  Pack<T, N> r;
#if defined(__GNUC__) && !defined(__CUDACC__)
  r.v = a.v > 0 ? b.v : r.v;
#else
  for (int i = 0; i < N; ++i) r.set(i, a[i] > 0 ? b[i] : T(0));
#endif
  return r;
}
KOKKOS_INLINE_FUNCTION double where_positive(double a, double b) { return a > 0 ? b : 0; }
KOKKOS_INLINE_FUNCTION float where_positive(float a, float b) { return a > 0 ? b : 0; }

/// lane by lane the larger; a NaN in `a` stays
template <class T, int N>
KOKKOS_INLINE_FUNCTION Pack<T, N> max(const Pack<T, N>& a, const Pack<T, N>& b) {
  Pack<T, N> r;
#if defined(__GNUC__) && !defined(__CUDACC__)
  r.v = a.v < b.v ? b.v : a.v;
#else
  for (int i = 0; i < N; ++i) r.set(i, a[i] < b[i] ? b[i] : a[i]);
#endif
  return r;
}
KOKKOS_INLINE_FUNCTION double max(double a, double b) { return a < b ? b : a; }
KOKKOS_INLINE_FUNCTION float max(float a, float b) { return a < b ? b : a; }

/// x^(-1/3), x > 0, to round-off; not a number for x <= 0.
template <class T>
KOKKOS_INLINE_FUNCTION T inverse_cube_root(const T& x) {
  using Real = typename LaneOf<T>::type;
  T y;
  for (int i = 0; i < LaneOf<T>::count; ++i) {
    const Real a = lane(x, i);
    set_lane(y, i, a > Real(0) ? functions::inverse_cube_root_guess<Real>(a) : Kokkos::Experimental::quiet_NaN_v<Real>);
  }
  for (int n = 0; n < 3; ++n) {  // third order: 3 steps take the guess's 3 % to 1e-16 and below
    const T e = T(1) - x * y * y * y;
    y = y + y * e * (T(Real(1) / 3) + T(Real(2) / 9) * e);
  }
  return y;
}

}  // namespace plica
