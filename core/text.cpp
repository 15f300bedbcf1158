// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <plica/core/text.hpp>
#include <set>

namespace plica {

std::string number(double value, int digits) {
  std::array<char, 48> buffer;  // at most 17 digits, sign, point, leading zeros and exponent
  char* const end = buffer.data() + buffer.size();
  const auto written = std::to_chars(buffer.data(), end, value, std::chars_format::general,
                                     std::clamp(digits, 1, 17));
  return {buffer.data(), written.ptr};
}

namespace {

constexpr const char* replacement = "\xEF\xBF\xBD";  // U+FFFD

// Meaning of a first byte: how many bytes follow it, and the range of the second. The range leaves
// out overlong forms, the surrogates, and what lies beyond U+10FFFF.
struct Lead {
  int following = -1;  // -1: not a first byte
  unsigned char lowest = 0x80, highest = 0xBF;
};

Lead lead_of(unsigned char byte) {
  if (byte < 0x80) return {0};
  if (byte < 0xC2) return {};
  if (byte < 0xE0) return {1};
  if (byte == 0xE0) return {2, 0xA0, 0xBF};
  if (byte == 0xED) return {2, 0x80, 0x9F};
  if (byte < 0xF0) return {2};
  if (byte == 0xF0) return {3, 0x90, 0xBF};
  if (byte < 0xF4) return {3};
  if (byte == 0xF4) return {3, 0x80, 0x8F};
  return {};
}

}  // namespace

std::string valid_utf8(std::string_view text) {
  std::string valid;
  valid.reserve(text.size());
  for (std::size_t at = 0; at < text.size();) {
    const Lead lead = lead_of(static_cast<unsigned char>(text[at]));
    std::size_t size = 1;
    for (int k = 0; k < lead.following && at + size < text.size(); ++k, ++size) {
      const auto next = static_cast<unsigned char>(text[at + size]);
      if (next < (k == 0 ? lead.lowest : 0x80) || next > (k == 0 ? lead.highest : 0xBF)) break;
    }
    const bool whole = lead.following >= 0 && size == static_cast<std::size_t>(lead.following) + 1;
    valid += whole ? text.substr(at, size) : std::string_view(replacement);
    at += size;
  }
  return valid;
}

std::map<std::string, std::string> valid_names(const std::vector<std::string>& names) {
  std::map<std::string, std::string> result;
  std::set<std::string> taken;
  for (const std::string& name : names)
    if (valid_utf8(name) == name) result[name] = name, taken.insert(name);
  for (const std::string& name : names) {
    if (result.contains(name)) continue;
    const std::string valid = valid_utf8(name);
    std::string distinct = valid;
    for (int n = 2; !taken.insert(distinct).second; ++n)
      distinct = valid + " (" + std::to_string(n) + ")";
    result[name] = distinct;
  }
  return result;
}

}  // namespace plica
