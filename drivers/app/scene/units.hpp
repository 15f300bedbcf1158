// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <optional>
#include <plica/core/keys.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace plica::app {

using namespace keys;

/// A unit that numbers may have.
struct UnitInfo {
  std::string symbol;
  std::string summary;  ///< what it measures, in SI, and whether prefixes go with it
};
std::vector<UnitInfo> unit_infos();

/// A regular expression for the units that a quantity of this dimension may have: one, or one times
/// a power of another.
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

/// What lies between two frames, probes or checkpoints: simulated time or macro steps.
struct Interval {
  double time = 0;  ///< [s], used where `steps` is 0
  long steps = 0;
  bool operator==(const Interval&) const = default;
};

/// Reads "20 ms" or "10 steps". Throws std::invalid_argument with what is wrong.
Interval parse_interval(std::string_view text);

/// "0.02 s", "10 steps".
std::string text_of(const Interval& interval);

/// Which macro steps an interval picks: the zeroth, and the first at or after each of its
/// multiples.
class Schedule {
 public:
  Schedule(const Interval& every, double macro_step) : every_(every), step_(macro_step) {}
  bool due(long macro_step) const;

 private:
  long count(long macro_step) const;
  Interval every_;
  double step_;
};

}  // namespace plica::app
