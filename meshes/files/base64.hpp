// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace plica {

/// Returns the number of characters that encode a number of bytes (RFC 4648, with padding).
constexpr std::size_t base64_size(std::size_t bytes) { return (bytes + 2) / 3 * 4; }

/// Appends the bytes in base64 (RFC 4648, with padding).
void append_base64(std::string& text, std::string_view bytes);

/// Returns the bytes of the values in base64.
template <class T>
std::string base64(const std::vector<T>& values) {
  static_assert(std::is_trivially_copyable_v<T>);
  std::string text;
  append_base64(text, {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)});
  return text;
}

/// Returns the bytes that the characters encode. Returns nothing unless they are whole groups of
/// four from the alphabet, the last one filled up with '='.
std::optional<std::string> decode_base64(std::string_view text);

}  // namespace plica
