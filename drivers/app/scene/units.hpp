// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace plica::app {

/// Exponents of kilogram, metre, second and radian. An angle counts as a dimension of its own, so that a frequency is
/// not taken for an angular velocity.
struct Dimension {
  int mass = 0, length = 0, time = 0, angle = 0;
  bool operator==(const Dimension&) const = default;
};

inline constexpr Dimension number{};
inline constexpr Dimension length{.length = 1};
inline constexpr Dimension duration{.time = 1};
inline constexpr Dimension rate{.time = -1};
inline constexpr Dimension velocity{.length = 1, .time = -1};
inline constexpr Dimension acceleration{.length = 1, .time = -2};
inline constexpr Dimension angular_velocity{.time = -1, .angle = 1};
inline constexpr Dimension pressure{.mass = 1, .length = -1, .time = -2};
inline constexpr Dimension density{.mass = 1, .length = -3};
inline constexpr Dimension force{.mass = 1, .length = 1, .time = -2};
inline constexpr Dimension angle{.angle = 1};

/// "a pressure", "a length"; a product of SI units where the dimension has no name.
std::string name_of(const Dimension& dimension);
std::string plural_of(const Dimension& dimension);

/// "Pa", "m", "kg/m^3"; empty for a number.
std::string unit_of(const Dimension& dimension);

/// A unit that numbers may have.
struct UnitInfo {
  std::string symbol;
  std::string summary;  ///< what it measures, in SI, and whether prefixes go with it
};
std::vector<UnitInfo> unit_infos();

/// A regular expression for the units that a quantity of this dimension may have: one, or one times a power of another.
std::string unit_pattern(const Dimension& dimension);

/// A number in SI. No dimension: it was written without a unit.
struct Measured {
  double value = 0;
  std::optional<Dimension> dimension;
};

/// Reads "20 kPa", "1000 kg/m^3", "0.5 1/s", "-3". Throws std::invalid_argument with what is wrong.
Measured measure(std::string_view text);

/// Reads a finite decimal number that takes up all of the text.
std::optional<double> parse_number(std::string_view text);

}  // namespace plica::app
