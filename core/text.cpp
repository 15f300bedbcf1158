// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <charconv>
#include <plica/core/text.hpp>

namespace plica {

std::string number(double value, int digits) {
  std::array<char, 48> buffer;  // at most 17 digits, sign, point, leading zeros and exponent
  char* const end = buffer.data() + buffer.size();
  const auto written = std::to_chars(buffer.data(), end, value, std::chars_format::general, std::clamp(digits, 1, 17));
  return {buffer.data(), written.ptr};
}

}  // namespace plica
