// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/pack.hpp>
#include <type_traits>

// Elementary functions that pointwise physics needs, on plain numbers and on packs.
namespace plica {

namespace functions {

/// Turns the bits of x > 0 into those of x^(-1/3), to 3 %. It takes a third of the exponent, by
/// shifts, because packs have no division of integers. x is a number or a pack.
template <class Bits, class Start>
KOKKOS_INLINE_FUNCTION void guess_inverse_cube_root(Bits& x, Start start) {
  x = (x >> 2) + (x >> 4);
  x += x >> 4;
  x += x >> 8;
  x = start - x - (x >> 16);
}

KOKKOS_INLINE_FUNCTION double inverse_cube_root_guess(double x) {
  auto bits = Kokkos::bit_cast<unsigned long long>(x);
  guess_inverse_cube_root(bits, 0x553ef0ff289dd796ULL);
  return Kokkos::bit_cast<double>(bits);
}
KOKKOS_INLINE_FUNCTION float inverse_cube_root_guess(float x) {
  auto bits = Kokkos::bit_cast<unsigned>(x);
  guess_inverse_cube_root(bits, 0x54a21d2aU);
  return Kokkos::bit_cast<float>(bits);
}
template <class T, int N>
KOKKOS_INLINE_FUNCTION Pack<T, N> inverse_cube_root_guess(const Pack<T, N>& x) {
#if defined(__GNUC__) && !defined(__CUDACC__)
  using Number = std::conditional_t<sizeof(T) == 8, unsigned long long, unsigned>;
  typedef Number Bits __attribute__((vector_size(sizeof(T) * N)));
  Bits bits = reinterpret_cast<Bits>(x.v);
  guess_inverse_cube_root(
      bits, sizeof(T) == 8 ? static_cast<Number>(0x553ef0ff289dd796ULL) : Number{0x54a21d2aU});
  Pack<T, N> guess;
  guess.v = reinterpret_cast<typename Pack<T, N>::Lanes>(bits);
  return guess;
#else
  return Pack<T, N>::map(x, [](T a) { return inverse_cube_root_guess(a); });
#endif
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

/// Returns b where a > 0, else c.
template <class T, int N>
KOKKOS_INLINE_FUNCTION Pack<T, N> where_positive(const Pack<T, N>& a, const Pack<T, N>& b,
                                                 const Pack<T, N>& c = {}) {
  Pack<T, N> r;
#if defined(__GNUC__) && !defined(__CUDACC__)
  r.v = a.v > 0 ? b.v : c.v;
#else
  for (int i = 0; i < N; ++i) r.set(i, a[i] > 0 ? b[i] : c[i]);
#endif
  return r;
}
KOKKOS_INLINE_FUNCTION double where_positive(double a, double b, double c = 0) {
  return a > 0 ? b : c;
}
KOKKOS_INLINE_FUNCTION float where_positive(float a, float b, float c = 0) { return a > 0 ? b : c; }

/// Returns true where every lane is positive; a NaN is not.
template <class T, int N>
KOKKOS_INLINE_FUNCTION bool all_positive(const Pack<T, N>& a) {
#if defined(__GNUC__) && !defined(__CUDACC__)
  // each number has all bits set or all 0: a branch for each lane would be badly predicted
  const auto positive = a.v > 0;
  auto all = positive[0];
  for (int i = 1; i < N; ++i) all &= positive[i];
  return all != 0;
#else
  for (int i = 0; i < N; ++i)
    if (!(a[i] > 0)) return false;
  return true;
#endif
}
KOKKOS_INLINE_FUNCTION bool all_positive(double a) { return a > 0; }
KOKKOS_INLINE_FUNCTION bool all_positive(float a) { return a > 0; }

/// Returns the larger number, lane by lane; a NaN in `a` stays.
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

/// Computes x^(-1/3) for x > 0, to round-off, by Halley's method. It is not a number for x <= 0.
template <class T>
KOKKOS_INLINE_FUNCTION T inverse_cube_root(const T& x) {
  using Real = typename LaneOf<T>::type;
  T y = where_positive(x, functions::inverse_cube_root_guess(x),
                       T(Kokkos::Experimental::quiet_NaN_v<Real>));
  for (int n = 0; n < 3; ++n) {  // third order: 3 steps take the guess's 3 % to 1e-16 and below
    const T e = T(1) - x * y * y * y;
    y = y + y * e * (T(Real(1) / 3) + T(Real(2) / 9) * e);
  }
  return y;
}

}  // namespace plica
