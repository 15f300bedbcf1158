// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/small.hpp>
#include <utility>

namespace plica {

#if defined(__GNUC__) && !defined(__clang__) && !defined(__CUDACC__)
/// Transposes N rows of four numbers in memory into four packs of N numbers, and back. Rows are
/// loaded whole and transposed in registers, by a third of the instructions that number by number
/// would take. Packs may be wider than the registers of the machine. Bare vectors of that width are
/// never passed by value, as the calling convention would then depend on the processor.
///
/// Each step mixes two packs. That is one cheap instruction where numbers stay within their 16
/// bytes, or where 16 bytes move as a whole. 16 bytes are four floats or two doubles:
///
///   floats, in every four                           doubles
///   a0 a1 a2 a3 -.  a0 a2 b0 b2 -.                  a0 a1 a2 a3 -.  a0 b0 a2 b2 -.
///   b0 b1 b2 b3 -'  c0 c2 d0 d2 -'  a0 b0 c0 d0     b0 b1 b2 b3 -'  c0 d0 c2 d2 -'  a0 b0 c0 d0
template <class T, int N>
class Transposed {
 public:
  static constexpr bool possible = N == 4 || N == 8 || N == 16;
  using Packed = Pack<T, N>;

  /// Loads the four numbers at row(l) into lane l of v.
  template <class Row>
  static void load(const Row& row, Packed (&v)[4]) {
    const Packed a = gather(0, row), b = gather(1, row), c = gather(third, row),
                 d = gather(third + 1, row);
    if constexpr (by_pairs) {
      const Packed even = mix<evens>(a, b), odd = mix<odds>(a, b), even2 = mix<evens>(c, d),
                   odd2 = mix<odds>(c, d);
      v[0] = mix<even_pairs>(even, even2), v[2] = mix<odd_pairs>(even, even2);
      v[1] = mix<even_pairs>(odd, odd2), v[3] = mix<odd_pairs>(odd, odd2);
    } else {
      const Packed even = mix<fours<0, 2, 0, 2>>(a, b), odd = mix<fours<1, 3, 1, 3>>(a, b);
      const Packed even2 = mix<fours<0, 2, 0, 2>>(c, d), odd2 = mix<fours<1, 3, 1, 3>>(c, d);
      v[0] = mix<fours<0, 2, 0, 2>>(even, even2), v[2] = mix<fours<1, 3, 1, 3>>(even, even2);
      v[1] = mix<fours<0, 2, 0, 2>>(odd, odd2), v[3] = mix<fours<1, 3, 1, 3>>(odd, odd2);
    }
  }
  /// Stores lane l of v as the four numbers at row(l).
  template <class Row>
  static void store(const Packed (&v)[4], const Row& row) {
    if constexpr (by_pairs) {
      const Packed even = mix<evens>(v[0], v[1]), even2 = mix<evens>(v[2], v[3]);
      const Packed odd = mix<odds>(v[0], v[1]), odd2 = mix<odds>(v[2], v[3]);
      scatter(0, mix<first_pairs>(even, even2), row),
          scatter(third, mix<last_pairs>(even, even2), row);
      scatter(1, mix<first_pairs>(odd, odd2), row),
          scatter(third + 1, mix<last_pairs>(odd, odd2), row);
    } else {
      const Packed a = mix<fours<0, 1, 0, 1>>(v[0], v[1]), b = mix<fours<0, 1, 0, 1>>(v[2], v[3]);
      const Packed c = mix<fours<2, 3, 2, 3>>(v[0], v[1]), d = mix<fours<2, 3, 2, 3>>(v[2], v[3]);
      scatter(0, mix<fours<0, 2, 0, 2>>(a, b), row), scatter(1, mix<fours<1, 3, 1, 3>>(a, b), row);
      scatter(2, mix<fours<0, 2, 0, 2>>(c, d), row), scatter(3, mix<fours<1, 3, 1, 3>>(c, d), row);
    }
  }

 private:
  static constexpr bool by_pairs = sizeof(T) == 8;
  /// Distance of the rows that lie side by side in a pack
  static constexpr int step = by_pairs ? 2 : 4;
  static constexpr int third = by_pairs ? N / 2 : 2;  ///< the first row of the third of four packs
  typedef T Quarter __attribute__((vector_size(4 * sizeof(T))));
  struct __attribute__((packed, may_alias)) Four {  ///< four numbers in memory, wherever they begin
    Quarter v;
  };

  /// Returns rows first, first + step, first + 2 step ... side by side.
  template <class Row>
  static Packed gather(int first, const Row& row) {
    const auto four = [&](int j) { return reinterpret_cast<const Four*>(row(first + step * j)); };
    Packed p;
    if constexpr (N == 4) p.v = four(0)->v;
    if constexpr (N == 8)
      p.v = __builtin_shufflevector(four(0)->v, four(1)->v, 0, 1, 2, 3, 4, 5, 6, 7);
    if constexpr (N == 16)
      p.v = __builtin_shufflevector(
          __builtin_shufflevector(four(0)->v, four(1)->v, 0, 1, 2, 3, 4, 5, 6, 7),
          __builtin_shufflevector(four(2)->v, four(3)->v, 0, 1, 2, 3, 4, 5, 6, 7), 0, 1, 2, 3, 4, 5,
          6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    return p;
  }
  template <class Row>
  static void scatter(int first, const Packed& rows, const Row& row) {
    [&]<std::size_t... j>(std::index_sequence<j...>) {
      ((reinterpret_cast<Four*>(row(first + step * static_cast<int>(j)))->v =
            __builtin_shufflevector(rows.v, rows.v, 4 * j, 4 * j + 1, 4 * j + 2, 4 * j + 3)),
       ...);
    }
    (std::make_index_sequence<N / 4>{});
  }

  /// Mixes two packs: number i is number from(i) of x, or for from(i) >= N, from(i) - N of y.
  template <int (*from)(int)>
  static Packed mix(const Packed& x, const Packed& y) {
    return [&]<std::size_t... i>(std::index_sequence<i...>) {
      Packed p;
      p.v = __builtin_shufflevector(x.v, y.v, from(static_cast<int>(i))...);
      return p;
    }
    (std::make_index_sequence<N>{});
  }
  /// Returns where number i of a mix comes from. In every four these are a and b of x, then c and d
  /// of y.
  template <int a, int b, int c, int d>
  static constexpr int fours(int i) {
    constexpr int from[4] = {a, b, N + c, N + d};
    return from[i % 4] + i / 4 * 4;
  }
  static constexpr int evens(int i) { return i % 2 * N + i - i % 2; }  ///< x0 y0 x2 y2 ...
  static constexpr int odds(int i) { return evens(i) + 1; }
  /// x0 x1 x4 x5 ... y0 y1 y4 y5 ...
  static constexpr int even_pairs(int i) { return 2 * i - i % 2; }
  static constexpr int odd_pairs(int i) { return even_pairs(i) + 2; }
  /// x0 x1 y0 y1 x2 x3 ...
  static constexpr int first_pairs(int i) { return i / 2 % 2 * N + i / 4 * 2 + i % 2; }
  static constexpr int last_pairs(int i) { return first_pairs(i) + N / 2; }
};
#endif

/// Loads the four numbers at row(l) into lane l of v.
template <class T, class Row>
KOKKOS_INLINE_FUNCTION void load_fours(const Row& row, T (&v)[4]) {
#if defined(__GNUC__) && !defined(__clang__) && !defined(__CUDACC__)
  using Rows = Transposed<typename LaneOf<T>::type, LaneOf<T>::count>;
  if constexpr (Rows::possible) return Rows::load(row, v);
#endif
  for (int l = 0; l < LaneOf<T>::count; ++l)
    for (int k = 0; k < 4; ++k) set_lane(v[k], l, row(l)[k]);
}

/// Loads the vector at row(l) into lane l of v. A pack is read four numbers at a time, the last of
/// which is not used.
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

/// Stores lane l of the four values v as the four numbers at row(l).
template <class T, class Row>
KOKKOS_INLINE_FUNCTION void store_fours(const T (&v)[4], const Row& row) {
#if defined(__GNUC__) && !defined(__clang__) && !defined(__CUDACC__)
  using Rows = Transposed<typename LaneOf<T>::type, LaneOf<T>::count>;
  if constexpr (Rows::possible) return Rows::store(v, row);
#endif
  for (int l = 0; l < LaneOf<T>::count; ++l)
    for (int k = 0; k < 4; ++k) row(l)[k] = lane(v[k], l);
}

}  // namespace plica
