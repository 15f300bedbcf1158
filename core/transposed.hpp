// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/small.hpp>
#include <utility>

namespace plica {

#if defined(__GNUC__) && !defined(__clang__) && !defined(__CUDACC__)
/// Packs of N numbers from where they lie in memory: N/4 groups of four are loaded whole and transposed in registers,
/// a third of the instructions that number by number would take. Packs may be wider than the registers of the machine;
/// bare vectors of that width are never passed by value, as the calling convention would then depend on the processor.
template <class T, int N>
struct Transposed {
  static constexpr bool possible = N == 4 || N == 8 || N == 16;
  using Packed = Pack<T, N>;
  typedef T Quarter __attribute__((vector_size(4 * sizeof(T))));
  struct __attribute__((packed, may_alias)) Four {  ///< in memory, wherever it begins
    Quarter v;
  };

  /// Rows i, i + 4, i + 8 ... side by side.
  template <class Row>
  static Packed gather(int i, const Row& row) {
    const auto four = [&](int j) { return reinterpret_cast<const Four*>(row(i + 4 * j)); };
    Packed p;
    if constexpr (N == 4) p.v = four(0)->v;
    if constexpr (N == 8) p.v = __builtin_shufflevector(four(0)->v, four(1)->v, 0, 1, 2, 3, 4, 5, 6, 7);
    if constexpr (N == 16)
      p.v = __builtin_shufflevector(__builtin_shufflevector(four(0)->v, four(1)->v, 0, 1, 2, 3, 4, 5, 6, 7),
                                    __builtin_shufflevector(four(2)->v, four(3)->v, 0, 1, 2, 3, 4, 5, 6, 7), 0, 1, 2, 3,
                                    4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    return p;
  }
  /// The other way round.
  template <class Row>
  static void scatter(int i, const Packed& rows, const Row& row) {
    [&]<std::size_t... j>(std::index_sequence<j...>) {
      ((reinterpret_cast<Four*>(row(i + 4 * static_cast<int>(j)))->v =
            __builtin_shufflevector(rows.v, rows.v, 4 * j, 4 * j + 1, 4 * j + 2, 4 * j + 3)),
       ...);
    }
    (std::make_index_sequence<N / 4>{});
  }
  /// In every group of four: entries a, b of x, then c, d of y.
  template <int a, int b, int c, int d>
  static Packed mix(const Packed& x, const Packed& y) {
    return [&]<std::size_t... i>(std::index_sequence<i...>) {
      constexpr int from[4] = {a, b, N + c, N + d};
      Packed p;
      p.v = __builtin_shufflevector(x.v, y.v, (from[i % 4] + static_cast<int>(i / 4 * 4))...);
      return p;
    }
    (std::make_index_sequence<N>{});
  }
};
#endif

/// Lane l of v is the four numbers at row(l).
template <class T, class Row>
KOKKOS_INLINE_FUNCTION void load_fours(const Row& row, T (&v)[4]) {
#if defined(__GNUC__) && !defined(__clang__) && !defined(__CUDACC__)
  using Rows = Transposed<typename LaneOf<T>::type, LaneOf<T>::count>;
  if constexpr (Rows::possible) {
    const T A = Rows::gather(0, row), B = Rows::gather(1, row), C = Rows::gather(2, row), D = Rows::gather(3, row);
    const T xz = Rows::template mix<0, 2, 0, 2>(A, B), yw = Rows::template mix<1, 3, 1, 3>(A, B);
    const T xz2 = Rows::template mix<0, 2, 0, 2>(C, D), yw2 = Rows::template mix<1, 3, 1, 3>(C, D);
    v[0] = Rows::template mix<0, 2, 0, 2>(xz, xz2);
    v[2] = Rows::template mix<1, 3, 1, 3>(xz, xz2);
    v[1] = Rows::template mix<0, 2, 0, 2>(yw, yw2);
    v[3] = Rows::template mix<1, 3, 1, 3>(yw, yw2);
    return;
  }
#endif
  for (int l = 0; l < LaneOf<T>::count; ++l)
    for (int k = 0; k < 4; ++k) set_lane(v[k], l, row(l)[k]);
}

/// Lane l of v is the vector at row(l), where a pack is read four numbers at a time, the last of them not used.
template <class T, class Row>
KOKKOS_INLINE_FUNCTION void load_vectors(const Row& row, Vec3<T>& v) {
#if defined(__GNUC__) && !defined(__clang__) && !defined(__CUDACC__)
  if constexpr (Transposed<typename LaneOf<T>::type, LaneOf<T>::count>::possible) {
    T four[4];
    load_fours(row, four);
    v = {four[0], four[1], four[2]};
    return;
  }
#endif
  for (int l = 0; l < LaneOf<T>::count; ++l)
    for (int k = 0; k < 3; ++k) set_lane(v[k], l, row(l)[k]);
}

/// The other way round: lane l of four values to the four numbers at row(l).
template <class T, class Row>
KOKKOS_INLINE_FUNCTION void store_fours(const T (&v)[4], const Row& row) {
#if defined(__GNUC__) && !defined(__clang__) && !defined(__CUDACC__)
  using Rows = Transposed<typename LaneOf<T>::type, LaneOf<T>::count>;
  if constexpr (Rows::possible) {
    const T A = Rows::template mix<0, 1, 0, 1>(v[0], v[1]), B = Rows::template mix<0, 1, 0, 1>(v[2], v[3]);
    const T C = Rows::template mix<2, 3, 2, 3>(v[0], v[1]), D = Rows::template mix<2, 3, 2, 3>(v[2], v[3]);
    Rows::scatter(0, Rows::template mix<0, 2, 0, 2>(A, B), row);
    Rows::scatter(1, Rows::template mix<1, 3, 1, 3>(A, B), row);
    Rows::scatter(2, Rows::template mix<0, 2, 0, 2>(C, D), row);
    Rows::scatter(3, Rows::template mix<1, 3, 1, 3>(C, D), row);
    return;
  }
#endif
  for (int l = 0; l < LaneOf<T>::count; ++l)
    for (int k = 0; k < 4; ++k) row(l)[k] = lane(v[k], l);
}

}  // namespace plica
