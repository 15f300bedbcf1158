// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <string>
#include <string_view>

namespace plica::app {

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

/// Which macro steps an interval picks: the zeroth, and the first at or after each of its multiples.
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
