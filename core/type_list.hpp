// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/error.hpp>
#include <string_view>
#include <type_traits>

namespace plica {

/// A family of types known at compile time.
template <class... Types>
struct TypeList {
  /// Calls f(T{}) for every member, in order.
  template <class F>
  static void for_each(const F& f) {
    (f(Types{}), ...);
  }

  /// Calls f(T{}) for the member whose T::name is `name`; returns false where there is none.
  template <class F>
  static bool visit(std::string_view name, const F& f) {
    return ((name == Types::name ? (f(Types{}), true) : false) || ...);
  }

  /// Calls f(T{}) for the member whose T::name is `name`. Throws InputError with the nearest name
  /// where there is none. `kind`: what the members are.
  template <class F>
  static void require(std::string_view kind, std::string_view name, const F& f) {
    if (!visit(name, f)) throw InputError(unknown_name(kind, name, {Types::name...}));
  }

  /// Returns the place of T, or the number of members where it is none.
  template <class T>
  static constexpr int place_of() {
    int place = 0;
    (void)((std::is_same_v<T, Types> ? true : (++place, false)) || ...);
    return place;
  }
  template <class T>
  static constexpr bool has = (std::is_same_v<T, Types> || ...);
};

/// List of the members of two families.
template <class First, class Second>
struct JoinedLists;
template <class... First, class... Second>
struct JoinedLists<TypeList<First...>, TypeList<Second...>> {
  using type = TypeList<First..., Second...>;
};

}  // namespace plica
