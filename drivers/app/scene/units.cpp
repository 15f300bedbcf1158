// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iomanip>
#include <numbers>
#include <plica/core/error.hpp>
#include <plica/drivers/app/scene/units.hpp>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace plica::app {
namespace {

struct Unit {
  const char* symbol;
  double factor;
  Dimension dimension;
  bool prefixed;  // true: takes prefixes k, m, ...
};
constexpr double degree = std::numbers::pi / 180;
constexpr std::array units = {Unit{"m", 1, length, true},
                              Unit{"g", 1e-3, {.mass = 1}, true},
                              Unit{"s", 1, duration, true},
                              Unit{"Pa", 1, pressure, true},
                              Unit{"N", 1, {.mass = 1, .length = 1, .time = -2}, true},
                              Unit{"J", 1, {.mass = 1, .length = 2, .time = -2}, true},
                              Unit{"Hz", 1, rate, true},
                              Unit{"rad", 1, {.angle = 1}, false},
                              Unit{"deg", degree, {.angle = 1}, false},
                              Unit{"min", 60, duration, false},
                              Unit{"bar", 1e5, pressure, true},
                              Unit{"mmHg", 133.322387415, pressure, false},
                              Unit{"%", 1e-2, plain, false},
                              Unit{"1", 1, plain, false}};

Dimension times(const Dimension& a, const Dimension& b, int n) {  // returns a b^n
  return {a.mass + n * b.mass, a.length + n * b.length, a.time + n * b.time, a.angle + n * b.angle};
}

struct Prefix {
  const char* symbol;
  double factor;
};
constexpr std::array prefixes = {Prefix{"n", 1e-9}, Prefix{"u", 1e-6}, Prefix{"µ", 1e-6},
                                 Prefix{"m", 1e-3}, Prefix{"c", 1e-2}, Prefix{"d", 1e-1},
                                 Prefix{"k", 1e3},  Prefix{"M", 1e6},  Prefix{"G", 1e9}};

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t"), last = text.find_last_not_of(" \t");
  return first == text.npos ? std::string_view{} : text.substr(first, last - first + 1);
}

[[noreturn]] void unknown_unit(std::string_view symbol) {
  static const std::vector<std::string> common = {"m",  "cm",  "mm",  "um",  "s",   "ms",  "g",
                                                  "kg", "N",   "Pa",  "kPa", "MPa", "GPa", "J",
                                                  "Hz", "rad", "deg", "min", "%"};
  const std::string near = nearest_name(symbol, common);
  throw std::invalid_argument("unknown unit '" + std::string(symbol) + "'" +
                              (near.empty() ? "" : "; did you mean '" + near + "'?"));
}

Measured unit_named(std::string_view symbol) {
  for (const Unit& unit : units)
    if (symbol == unit.symbol) return {unit.factor, unit.dimension};
  for (const Prefix& prefix : prefixes)
    for (const Unit& unit : units)
      if (unit.prefixed && symbol.starts_with(prefix.symbol) &&
          symbol.substr(std::string_view(prefix.symbol).size()) == unit.symbol)
        return {prefix.factor * unit.factor, unit.dimension};
  unknown_unit(symbol);
}

// Multiplies a product by one factor with its exponent: "m^3", "s2", "kPa"; sign -1 divides
void multiply(Measured& product, std::string_view factor, int sign) {
  const auto end = std::min(factor.find('^'), factor.find_first_of("0123456789", 1));
  const Measured unit = unit_named(trimmed(factor.substr(0, end)));
  int exponent = 1;
  if (end < factor.size()) {
    const std::string_view digits = factor.substr(end + (factor[end] == '^' ? 1 : 0));
    const auto [rest, error] = std::from_chars(digits.begin(), digits.end(), exponent);
    if (error != std::errc{} || rest != digits.end() || std::abs(exponent) > 9)
      throw std::invalid_argument("cannot read the exponent in '" + std::string(factor) + "'");
  }
  exponent *= sign;
  product.value *= std::pow(unit.value, exponent);
  product.dimension = times(*product.dimension, *unit.dimension, exponent);
}

Measured unit_product(std::string_view text) {
  Measured product{1, plain};
  int sign = 1;
  if (text.starts_with('/')) sign = -1, text.remove_prefix(1);
  while (true) {
    const auto end = text.find_first_of("*/");
    const std::string_view factor = trimmed(text.substr(0, end));
    if (factor.empty()) throw std::invalid_argument("a unit is missing beside '*' or '/'");
    multiply(product, factor, sign);
    if (end == text.npos) return product;
    sign = text[end] == '/' ? -1 : 1;
    text.remove_prefix(end + 1);
  }
}

// Reads the number at the start of the text. Returns its number of characters; 0: no number
std::size_t number_prefix(std::string_view text, double& value) {
  const std::size_t sign = text.starts_with('+') && !text.starts_with("+-") ? 1 : 0;
  const auto [rest, error] = std::from_chars(text.begin() + sign, text.end(), value);
  const bool finite = error == std::errc{} && std::isfinite(value);
  return finite ? static_cast<std::size_t>(rest - text.begin()) : 0;
}

}  // namespace

std::vector<UnitInfo> unit_infos() {
  std::string symbols;
  for (const Prefix& prefix : prefixes)
    symbols += (symbols.empty() ? "" : " ") + std::string(prefix.symbol);
  std::vector<UnitInfo> infos;
  for (const Unit& unit : units) {
    std::ostringstream factor;
    factor << std::setprecision(9) << unit.factor;
    const std::string si = unit_of(unit.dimension);
    infos.push_back({unit.symbol, name_of(unit.dimension) + ", " + factor.str() +
                                      (si.empty() ? "" : " " + si) +
                                      (unit.prefixed ? ", with prefixes" : "")});
  }
  infos.push_back({"prefixes", symbols});
  infos.push_back({"products", "of these with * / and exponents: kg/m^3, N/mm2, 1/s"});
  return infos;
}

std::string unit_pattern(const Dimension& dimension) {
  std::string prefix, pattern;
  for (const Prefix& p : prefixes) prefix += (prefix.empty() ? "(" : "|") + std::string(p.symbol);
  const auto add = [&pattern](const std::string& text) {
    pattern += (pattern.empty() ? "" : "|") + text;
  };
  const auto power = [&prefix](const Unit& unit, int n) {
    const std::string exponent = n > 1 ? "\\^?" + std::to_string(n) : "";
    return (unit.prefixed ? prefix + ")?" : "") + unit.symbol + exponent;
  };
  for (const Unit& a : units) {
    for (int n = 1; n <= 3; ++n)
      if (a.symbol != std::string_view("1") && times(plain, a.dimension, n) == dimension)
        add(power(a, n));
    if (a.symbol == std::string_view("%")) continue;
    for (const Unit& b : units)
      for (int n = 1; n <= 4 && dimension != plain && b.dimension != plain; ++n) {
        if (times(a.dimension, b.dimension, -n) == dimension)
          add(power(a, 1) + " */ *" + power(b, n));
        if (a.dimension != plain && times(a.dimension, b.dimension, n) == dimension)
          add(power(a, 1) + " *\\* *" + power(b, n));
      }
  }
  const std::string own = unit_of(dimension);  // unit in messages, which may have three factors
  if (std::ranges::count(own, '*') + std::ranges::count(own, '/') > 1) {
    std::string escaped;
    for (const char c : own) escaped += (c == '*' || c == '^' ? "\\" : "") + std::string(1, c);
    add(escaped);
  }
  return pattern;
}

std::optional<double> parse_number(std::string_view text) {
  double value = 0;
  const std::size_t length_read = number_prefix(text, value);
  return length_read > 0 && length_read == text.size() ? std::optional(value) : std::nullopt;
}

Measured measure(std::string_view text) {
  text = trimmed(text);
  double value = 0;
  const std::size_t length_read = number_prefix(text, value);
  if (length_read == 0) throw std::invalid_argument("not a number");
  const std::string_view unit = trimmed(text.substr(length_read));
  if (unit.empty()) return {value, std::nullopt};
  if (unit.starts_with(','))
    throw std::invalid_argument("a comma; expected a point before decimals");
  const Measured product = unit_product(unit);
  return {value * product.value, product.dimension};
}

Interval parse_interval(std::string_view text) {
  Interval interval;
  const auto [rest, error] =
      std::from_chars(text.data(), text.data() + text.size(), interval.steps);
  const std::size_t digits = static_cast<std::size_t>(rest - text.data());
  const std::string_view word =
      text.substr(std::min(text.find_first_not_of(' ', digits), text.size()));
  if (error == std::errc{} && (word == "steps" || word == "step")) {
    if (interval.steps < 1) throw std::invalid_argument("less than a step");
    return interval;
  }
  const Measured measured = measure(text);
  if (measured.dimension.value_or(duration) != duration)
    throw std::invalid_argument(name_of(*measured.dimension));
  if (!(measured.value > 0)) throw std::invalid_argument("no time at all");
  return {measured.value, 0};
}

std::string text_of(const Interval& interval) {
  if (interval.steps > 0)
    return fmt::format("{} {}", interval.steps, interval.steps == 1 ? "step" : "steps");
  return fmt::format("{:g} s", interval.time);
}

// Returns the number of multiples passed at this step, with the zeroth one. Rounding is allowed
// for, so that 3 s are 100 steps of 30 ms
long Schedule::count(long macro_step) const {
  constexpr double rounding = 1e-9;  // part of a step that is ignored
  if (macro_step < 0) return 0;
  if (every_.steps > 0) return macro_step / every_.steps + 1;
  if (every_.time < step_) return macro_step + 1;
  return static_cast<long>(
             std::floor((static_cast<double>(macro_step) + rounding) * step_ / every_.time)) +
         1;
}

bool Schedule::due(long macro_step) const { return count(macro_step) > count(macro_step - 1); }

}  // namespace plica::app
