// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <optional>
#include <plica/core/keys.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace plica::app {

using namespace keys;

/// Unit that numbers may have.
struct UnitInfo {
  std::string symbol;   ///< "m", "Pa"
  std::string summary;  ///< quantity, value in SI, and "with prefixes" if it takes them
};
/// Returns all units, then the prefixes and the rule for products.
std::vector<UnitInfo> unit_infos();

/// Returns a regular expression for the units of a quantity of this dimension. A unit is one unit,
/// one unit times a power of another, or what unit_of() returns.
std::string unit_pattern(const Dimension& dimension);

/// Number in SI units. No dimension: it was written without a unit.
struct Measured {
  double value = 0;
  std::optional<Dimension> dimension;
};

/// Reads "20 kPa", "1000 kg/m^3", "0.5 1/s", "-3". Throws std::invalid_argument with what is wrong.
Measured measure(std::string_view text);

/// Reads a finite decimal number; none: the text is not one number.
std::optional<double> parse_number(std::string_view text);

/// Interval between frames, probes or checkpoints: simulated time or macro steps.
struct Interval {
  double time = 0;  ///< simulated time [s], used if `steps` is 0
  long steps = 0;   ///< number of macro steps; 0: `time` counts
  bool operator==(const Interval&) const = default;
};

/// Reads "20 ms" or "10 steps". Throws std::invalid_argument with what is wrong.
Interval parse_interval(std::string_view text);

/// Returns an interval as text: "0.02 s", "10 steps".
std::string text_of(const Interval& interval);

/// Selection of macro steps by an interval: step 0, and the first step at or after each multiple.
class Schedule {
 public:
  Schedule(const Interval& every, double macro_step) : every_(every), step_(macro_step) {}
  /// Returns true if this macro step is selected.
  bool due(long macro_step) const;

 private:
  long count(long macro_step) const;
  Interval every_;
  double step_;
};

}  // namespace plica::app
