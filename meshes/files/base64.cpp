// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <plica/meshes/files/base64.hpp>

namespace plica {

namespace {

constexpr std::string_view base64_alphabet =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

// The two characters of each 12 bits
constexpr auto base64_pairs = [] {
  std::array<std::array<char, 2>, 4096> table = {};
  for (std::size_t i = 0; i < table.size(); ++i)
    table[i] = {base64_alphabet[i >> 6], base64_alphabet[i & 63]};
  return table;
}();

// The six bits of each character; -1: none
constexpr auto base64_digits = [] {
  std::array<std::int8_t, 256> table = {};
  table.fill(-1);
  for (std::size_t i = 0; i < base64_alphabet.size(); ++i)
    table[static_cast<unsigned char>(base64_alphabet[i])] = static_cast<std::int8_t>(i);
  return table;
}();

}  // namespace

void append_base64(std::string& text, std::string_view bytes) {
  const std::size_t begin = text.size();
  text.resize(begin + base64_size(bytes.size()), '=');
  char* to = text.data() + begin;
  const auto byte = [&](std::size_t at) {
    return std::uint32_t{static_cast<unsigned char>(bytes[at])};
  };
  std::size_t at = 0;
  for (; at + 3 <= bytes.size(); at += 3, to += 4) {
    const std::uint32_t group = byte(at) << 16 | byte(at + 1) << 8 | byte(at + 2);
    std::memcpy(to, base64_pairs[group >> 12].data(), 2);
    std::memcpy(to + 2, base64_pairs[group & 4095].data(), 2);
  }
  if (at == bytes.size()) return;
  const bool two = at + 2 == bytes.size();
  const std::uint32_t group = byte(at) << 16 | (two ? byte(at + 1) << 8 : 0);
  std::memcpy(to, base64_pairs[group >> 12].data(), 2);
  if (two) to[2] = base64_alphabet[group >> 6 & 63];
}

std::optional<std::string> decode_base64(std::string_view text) {
  if (text.size() % 4 != 0) return {};
  std::string last(text.substr(text.size() - std::min<std::size_t>(text.size(), 4)));
  std::size_t padding = 0;
  for (; padding < 2 && padding < last.size() && last[3 - padding] == '='; ++padding)
    last[3 - padding] = base64_alphabet[0];
  std::string bytes(text.size() / 4 * 3, '\0');
  char* to = bytes.data();
  std::int32_t wrong = 0;  // negative: a character is not in the alphabet
  const auto take = [&](const char* from) {
    std::int32_t group = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const std::int32_t digit = base64_digits[static_cast<unsigned char>(from[k])];
      wrong |= digit, group = group * 64 + digit;
    }
    for (const int shift : {16, 8, 0}) *to++ = static_cast<char>(group >> shift & 0xff);
  };
  for (std::size_t at = 0; at + 4 < text.size(); at += 4) take(text.data() + at);
  if (!last.empty()) take(last.data());
  if (wrong < 0) return {};
  bytes.resize(bytes.size() - padding);
  return bytes;
}

}  // namespace plica
