// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Kokkos_Core.hpp>
#include <cstdint>

namespace plica {

/// A double as an integer in units of 2^-1074, cut into digits of 32 bits. Each of its three digits
/// has the number's sign.
struct NumberDigits {
  static constexpr int count = 3;
  int first = 0;  ///< place of the lowest digit, 0 to 63
  std::int64_t digit[count] = {};

  /// @param x  a finite number
  explicit KOKKOS_INLINE_FUNCTION NumberDigits(double x) {
    const auto bits = Kokkos::bit_cast<std::uint64_t>(x);
    const int exponent = static_cast<int>(bits >> 52 & 0x7ff);
    const std::uint64_t fraction = bits & ((std::uint64_t{1} << 52) - 1);
    const std::uint64_t mantissa = exponent > 0 ? fraction | std::uint64_t{1} << 52 : fraction;
    const int shift = exponent > 0 ? exponent - 1 : 0, within = shift & 31;
    const std::uint64_t low = mantissa << within, high = mantissa >> 1 >> (63 - within);
    first = shift >> 5;
    const std::int64_t sign = bits >> 63 ? -1 : 1;
    digit[0] = sign * static_cast<std::int64_t>(low & 0xffffffff);
    digit[1] = sign * static_cast<std::int64_t>(low >> 32);
    digit[2] = sign * static_cast<std::int64_t>(high);
  }
};

/// Returns whether a double is neither infinite nor NaN.
KOKKOS_INLINE_FUNCTION bool is_finite(double x) {
  return (Kokkos::bit_cast<std::uint64_t>(x) >> 52 & 0x7ff) != 0x7ff;
}

/// Rounds an integer in units of 2^-1074 to the nearest double, ties to even.
/// @param digit  digits of 32 bits with any carries, lowest first; the sum of digit[i] 2^(32 i) is
///               the integer's magnitude and sign. They are overwritten
/// @param count  number of digits; the last two are 0, so that carries and the sign have room
/// @param first  place of digit[0]: it counts 2^(32 first)
KOKKOS_INLINE_FUNCTION double rounded_digits(std::int64_t* digit, int count, int first) {
  constexpr std::int64_t mask = 0xffffffff;
  std::int64_t carry = 0;
  for (int i = 0; i < count; ++i) {
    carry += digit[i];
    digit[i] = carry & mask, carry >>= 32;
  }
  const bool negative = carry < 0;
  if (negative) {
    carry = 1;
    for (int i = 0; i < count; ++i) {
      carry += digit[i] ^ mask;
      digit[i] = carry & mask, carry >>= 32;
    }
  }
  int top = count - 1;
  while (top >= 0 && digit[top] == 0) --top;
  if (top < 0) return 0;
  const auto at = [&](int i) { return i >= 0 ? static_cast<std::uint64_t>(digit[i]) : 0; };
  int zeros = 0;  // above the highest bit of digit[top]
  while (at(top) >> (31 - zeros) == 0) ++zeros;
  // the 64 highest bits, of which a double has 53
  const std::uint64_t high = (at(top) << 32 | at(top - 1)) << zeros | at(top - 2) << zeros >> 32;
  const int length = 32 * (first + top + 1) - zeros;
  std::uint64_t bits = high >> (64 - (length < 53 ? length : 53));
  if (length > 53) {
    const std::uint64_t rest = high & 0x7ff, half = 0x400;
    bool more = (at(top - 2) << zeros & static_cast<std::uint64_t>(mask)) != 0;
    for (int i = 0; i < top - 2 && !more; ++i) more = digit[i] != 0;
    bits += static_cast<std::uint64_t>(length - 53) << 52;
    if (rest > half || (rest == half && (more || (bits & 1) != 0))) ++bits;
    constexpr std::uint64_t infinite = std::uint64_t{0x7ff} << 52;
    if (length > 53 + 2045 || bits > infinite) bits = infinite;
  }
  return Kokkos::bit_cast<double>(bits | static_cast<std::uint64_t>(negative) << 63);
}

/// Accumulator of doubles that loses no bit, so that a sum does not depend on the order of its
/// terms. It is an integer in units of 2^-1074, the least double above 0, in 68 digits of 32 bits:
/// from there beyond the largest double. Digits are held in 64 bits, so that carries wait until the
/// sum is asked for, up to 2^31 terms (U. Kulisch: Computer Arithmetic and Validity, 2013).
class ExactSum {
 public:
  static constexpr int digits = 68;
  static constexpr int words = digits + 1;  ///< integers of store()

  KOKKOS_INLINE_FUNCTION void add(double x) {
    if (!is_finite(x)) {
      special_ |= x != x ? not_a_number : x > 0 ? plus : minus;
      return;
    }
    const NumberDigits number(x);
    const int end = number.first + NumberDigits::count;
    for (int i = 0; i < NumberDigits::count; ++i) digit_[number.first + i] += number.digit[i];
    if (number.first < first_) first_ = number.first;
    if (end > end_) end_ = end;
  }

  /// Returns the sum, rounded once to the nearest double, ties to even; 0 is positive. It is
  /// infinite beyond the largest double or where a term was, NaN where infinities of both signs
  /// were or a NaN. The accumulator is spent.
  KOKKOS_INLINE_FUNCTION double take() {
    constexpr std::uint64_t infinite = std::uint64_t{0x7ff} << 52;
    if (special_ == plus) return Kokkos::bit_cast<double>(infinite);
    if (special_ == minus) return Kokkos::bit_cast<double>(infinite | std::uint64_t{1} << 63);
    if (special_ != 0) return Kokkos::bit_cast<double>(infinite | std::uint64_t{1} << 51);
    if (end_ == 0) return 0;
    return rounded_digits(digit_ + first_, end_ + 2 - first_, first_);
  }

  /// Writes the sum as integers. Those of several sums may be added number by number.
  KOKKOS_INLINE_FUNCTION void store(std::int64_t* to) const {
    for (int i = 0; i < digits; ++i) to[i] = digit_[i];
    to[digits] = 0;
    for (int k = 0; k < 3; ++k)
      if (special_ >> k & 1) to[digits] += std::int64_t{1} << room * k;
  }
  /// Makes the total of sums whose integers were added.
  static KOKKOS_INLINE_FUNCTION ExactSum load(const std::int64_t* from) {
    ExactSum total;
    for (int i = 0; i < digits; ++i) total.digit_[i] = from[i];
    total.first_ = 0, total.end_ = digits - 2;
    for (int k = 0; k < 3; ++k)
      if (from[digits] >> room * k & ((std::int64_t{1} << room) - 1)) total.special_ |= 1u << k;
    return total;
  }

 private:
  static constexpr int room = 20;  // bits of each of the three counts of terms that are not finite
  static constexpr unsigned plus = 1, minus = 2, not_a_number = 4;
  std::int64_t digit_[digits] = {};
  int first_ = digits, end_ = 0;  // digits that may differ from 0
  unsigned special_ = 0;          // terms that were infinite or NaN
};

}  // namespace plica
