// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <plica/meshes/numbers_out.hpp>

namespace plica {

NumbersOut& NumbersOut::text(std::string_view text) { return bytes_ += text, *this; }

template <typename Number>
NumbersOut& NumbersOut::add(Number number) {
  if (binary_) {
    std::array<char, sizeof(Number)> bytes;
    std::memcpy(bytes.data(), &number, sizeof(Number));
    if (order_ != std::endian::native) std::reverse(bytes.begin(), bytes.end());
    bytes_.append(bytes.data(), bytes.size());
    return *this;
  }
  char digits[32];
  if (line_begun_) bytes_ += ' ';
  bytes_.append(digits, std::to_chars(digits, digits + sizeof(digits), number).ptr);
  line_begun_ = true;
  return *this;
}

NumbersOut& NumbersOut::int32(std::int64_t number) { return add(static_cast<std::int32_t>(number)); }
NumbersOut& NumbersOut::int64(std::int64_t number) { return add(number); }
NumbersOut& NumbersOut::real32(double number) { return binary_ ? add(static_cast<float>(number)) : add(number); }
NumbersOut& NumbersOut::real64(double number) { return add(number); }

NumbersOut& NumbersOut::end() {
  if (!binary_) bytes_ += '\n';
  line_begun_ = false;
  return *this;
}

}  // namespace plica
