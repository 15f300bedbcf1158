// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <string_view>

namespace plica {

/// A family of types known at compile time.
template <class... Types>
struct TypeList {
  /// f(T{}) for every member, in order.
  template <class F>
  static void for_each(const F& f) {
    (f(Types{}), ...);
  }

  /// f(T{}) for the member whose T::name is `name`; false where there is none.
  template <class F>
  static bool visit(std::string_view name, const F& f) {
    return ((name == Types::name ? (f(Types{}), true) : false) || ...);
  }
};

}  // namespace plica
