// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Kokkos_Core.hpp>

// A few values that one instruction handles together. Pointwise physics is written once, on a type
// T. T is a plain number (GPUs, tests) or a Pack of numbers (CPUs). The compiler's own vector
// extension is used where there is one: it keeps packs in registers, which a struct with an array
// and loops does not.
namespace plica {

template <class T, int N>
struct Pack {
#if defined(__GNUC__) && !defined(__CUDACC__)
  typedef T Lanes __attribute__((vector_size(sizeof(T) * N)));
  Lanes v;
#else
  struct Lanes {
    T a[N];
    KOKKOS_FUNCTION T& operator[](int i) { return a[i]; }
    KOKKOS_FUNCTION T operator[](int i) const { return a[i]; }
  };
  Lanes v;
#endif
  KOKKOS_INLINE_FUNCTION Pack() : v{} {}
#if defined(__GNUC__) && !defined(__CUDACC__)
  Pack(T s) : v(s - Lanes{}) {}  // one instruction; set lane by lane, long packs take one for each
#else
  KOKKOS_INLINE_FUNCTION Pack(T s) {
    for (int i = 0; i < N; ++i) v[i] = s;
  }
#endif
  KOKKOS_INLINE_FUNCTION T operator[](int i) const { return v[i]; }
  KOKKOS_INLINE_FUNCTION void set(int i, T s) { v[i] = s; }

#if defined(__GNUC__) && !defined(__CUDACC__)
#define PLICA_PACK_OPERATOR(op)                                                  \
  friend KOKKOS_INLINE_FUNCTION Pack operator op(const Pack& a, const Pack& b) { \
    Pack r;                                                                      \
    r.v = a.v op b.v;                                                            \
    return r;                                                                    \
  }
#else
#define PLICA_PACK_OPERATOR(op)                                                  \
  friend KOKKOS_INLINE_FUNCTION Pack operator op(const Pack& a, const Pack& b) { \
    Pack r;                                                                      \
    for (int i = 0; i < N; ++i) r.v[i] = a.v[i] op b.v[i];                       \
    return r;                                                                    \
  }
#endif
  PLICA_PACK_OPERATOR(+)
  PLICA_PACK_OPERATOR(-)
  PLICA_PACK_OPERATOR(*)
  PLICA_PACK_OPERATOR(/)
#undef PLICA_PACK_OPERATOR
  friend KOKKOS_INLINE_FUNCTION Pack operator-(const Pack& a) { return Pack(T(0)) - a; }
  KOKKOS_INLINE_FUNCTION Pack& operator+=(const Pack& b) { return *this = *this + b; }
  KOKKOS_INLINE_FUNCTION Pack& operator-=(const Pack& b) { return *this = *this - b; }
  KOKKOS_INLINE_FUNCTION Pack& operator*=(const Pack& b) { return *this = *this * b; }

  /// Returns f of each lane.
  template <class F>
  static KOKKOS_INLINE_FUNCTION Pack map(const Pack& a, const F& f) {
    Pack r;
    for (int i = 0; i < N; ++i) r.v[i] = f(a.v[i]);
    return r;
  }
};

/// Number type of a plain number or a pack, and the number of its lanes.
template <class T>
struct LaneOf {
  using type = T;
  static constexpr int count = 1;
};
template <class T, int N>
struct LaneOf<Pack<T, N>> {
  using type = T;
  static constexpr int count = N;
};

/// One value per element for W elements: a plain number where W is 1.
template <class T, int W>
struct PackOf {
  using type = Pack<T, W>;
};
template <class T>
struct PackOf<T, 1> {
  using type = T;
};

/// Returns lane i of a pack, or a plain number itself.
template <class T>
KOKKOS_INLINE_FUNCTION T lane(const T& a, int) {
  return a;
}
template <class T, int N>
KOKKOS_INLINE_FUNCTION T lane(const Pack<T, N>& a, int i) {
  return a[i];
}
template <class T>
KOKKOS_INLINE_FUNCTION void set_lane(T& a, int, T value) {
  a = value;
}
template <class T, int N>
KOKKOS_INLINE_FUNCTION void set_lane(Pack<T, N>& a, int i, T value) {
  a.set(i, value);
}

/// Loads as many numbers as T has lanes. They lie together and may be of another precision.
template <class T, class Number>
KOKKOS_INLINE_FUNCTION T load_lanes(const Number* from) {
  constexpr int lanes = LaneOf<T>::count;
  T to;
#if defined(__GNUC__) && !defined(__CUDACC__)
  if constexpr (lanes > 1) {
    typedef Number Together
        __attribute__((vector_size(lanes * sizeof(Number)), may_alias, aligned(alignof(Number))));
    to.v = __builtin_convertvector(*reinterpret_cast<const Together*>(from), typename T::Lanes);
    return to;
  }
#endif
  for (int l = 0; l < lanes; ++l) set_lane(to, l, static_cast<typename LaneOf<T>::type>(from[l]));
  return to;
}

/// Stores the lanes of T together, as numbers that may be of another precision.
template <class T, class Number>
KOKKOS_INLINE_FUNCTION void store_lanes(const T& from, Number* to) {
  for (int l = 0; l < LaneOf<T>::count; ++l) to[l] = static_cast<Number>(lane(from, l));
}

/// Returns the index of number k of `count` at a slot. Numbers k of a pack's elements stand side by
/// side.
template <class B>
KOKKOS_INLINE_FUNCTION int packed(int slot, int k, int count) {
  return (slot / B::lanes * count + k) * B::lanes + slot % B::lanes;
}

}  // namespace plica
