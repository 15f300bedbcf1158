// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <optional>
#include <string>
#include <string_view>

namespace plica {

/// How many characters encode so many bytes (RFC 4648, with padding).
constexpr std::size_t base64_size(std::size_t bytes) { return (bytes + 2) / 3 * 4; }

/// The bytes that the characters encode; nothing when they are not whole groups of four from the alphabet, the last one
/// filled up with '='.
std::optional<std::string> decode_base64(std::string_view text);

}  // namespace plica
