// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Kokkos_Core.hpp>
#include <type_traits>

namespace plica {

namespace members {

/// A value that any member can be initialised with.
struct Anything {
  template <class T>
  operator T() const;
};
/// Returns the number of members of an aggregate, which has neither base classes nor C arrays.
template <class T, class... Some>
constexpr int count() {
  if constexpr (requires { T{Some()..., Anything()}; })
    return count<T, Some..., Anything>();
  else
    return sizeof...(Some);
}

}  // namespace members

/// Calls use(array) for each array of an object, which is a view. Walks lists, aggregates and
/// classes with a static function each_array(self, use), as deep as they are nested. Numbers have
/// no arrays; other classes do not compile. So an array that is added to an aggregate is never
/// forgotten.
template <class T, class Use>
void each_array(T& x, const Use& use) {
  using Plain = std::remove_const_t<T>;
  const auto walk = [&](auto&... member) { (each_array(member, use), ...); };
  if constexpr (Kokkos::is_view_v<Plain>) {
    use(x);
  } else if constexpr (requires { Plain::each_array(x, use); }) {
    Plain::each_array(x, use);
  } else if constexpr (std::is_array_v<Plain> || requires { x.begin(); }) {
    for (auto& one : x) walk(one);
  } else if constexpr (requires { x.size(), x[0]; }) {
    for (std::size_t i = 0; i < x.size(); ++i) walk(x[i]);
  } else if constexpr (!std::is_trivially_copyable_v<Plain>) {
    static_assert(std::is_aggregate_v<Plain>, "name the arrays of this class one by one");
    constexpr int count = members::count<Plain>();
#define PLICA_MEMBERS(number, ...) \
  if constexpr (count == number) { \
    auto& [__VA_ARGS__] = x;       \
    walk(__VA_ARGS__);             \
  } else
    PLICA_MEMBERS(1, a)
    PLICA_MEMBERS(2, a, b)
    PLICA_MEMBERS(3, a, b, c)
    PLICA_MEMBERS(4, a, b, c, d)
    PLICA_MEMBERS(5, a, b, c, d, e)
    PLICA_MEMBERS(6, a, b, c, d, e, f)
    PLICA_MEMBERS(7, a, b, c, d, e, f, g)
    PLICA_MEMBERS(8, a, b, c, d, e, f, g, h)
    PLICA_MEMBERS(9, a, b, c, d, e, f, g, h, i)
    PLICA_MEMBERS(10, a, b, c, d, e, f, g, h, i, j)
    PLICA_MEMBERS(11, a, b, c, d, e, f, g, h, i, j, k)
    PLICA_MEMBERS(17, a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q)
    PLICA_MEMBERS(18, a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r)
    PLICA_MEMBERS(20, a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t)
    PLICA_MEMBERS(37, a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v, w, y, z, a1,
                  b1, c1, d1, e1, f1, g1, h1, i1, j1, k1, l1)
    static_assert(count == 0, "write a line above for this number of members");
#undef PLICA_MEMBERS
  }
}

}  // namespace plica
