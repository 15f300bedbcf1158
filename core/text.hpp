// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <concepts>
#include <map>
#include <string>
#include <string_view>
#include <vector>

/// Text of messages, in strings of the length that it needs. Names in messages come from files and
/// may be long.
namespace plica {

/// Returns `value` in `digits` significant digits, as printf's %.4g writes it: "0.002", "1e-09",
/// "inf".
std::string number(double value, int digits = 6);

namespace detail {
inline void append(std::string& all, std::string_view part) { all += part; }
inline void append(std::string& all, std::integral auto part) { all += std::to_string(part); }
}  // namespace detail

/// Returns the parts one after the other: strings and integers. A real number says its digits:
/// text("it takes ", number(t, 3), " s").
template <class... Parts>
std::string text(const Parts&... parts) {
  std::string all;
  (detail::append(all, parts), ...);
  return all;
}

/// Returns the text with U+FFFD in place of every byte sequence that is not UTF-8 (RFC 3629). The
/// Unicode standard recommends this way (chapter 3.9, "U+FFFD substitution of maximal subparts").
/// Valid text stays as it is.
std::string valid_utf8(std::string_view text);

/// Returns each name with its valid form, for names that must stay distinct. Where several would
/// become the same, all but the first get a number: "L?ber", "L?ber (2)", with U+FFFD for the
/// question mark.
std::map<std::string, std::string> valid_names(const std::vector<std::string>& names);

}  // namespace plica
