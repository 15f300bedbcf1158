// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <concepts>
#include <string>
#include <string_view>

/// Messages are put together as strings of the length that they need: names in them come from files and may be long.
namespace plica {

/// `value` in `digits` significant digits, as printf's %.4g writes it: "0.002", "1e-09", "inf".
std::string number(double value, int digits = 6);

namespace detail {
inline void append(std::string& all, std::string_view part) { all += part; }
inline void append(std::string& all, std::integral auto part) { all += std::to_string(part); }
}  // namespace detail

/// The parts one after the other: strings and integers. A real number says its digits: text("it takes ", number(t, 3), " s").
template <class... Parts>
std::string text(const Parts&... parts) {
  std::string all;
  (detail::append(all, parts), ...);
  return all;
}

}  // namespace plica
