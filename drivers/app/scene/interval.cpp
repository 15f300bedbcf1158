// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <plica/drivers/app/scene/interval.hpp>
#include <plica/drivers/app/scene/units.hpp>
#include <stdexcept>

namespace plica::app {

Interval parse_interval(std::string_view text) {
  Interval interval;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), interval.steps);
  const std::size_t digits = static_cast<std::size_t>(rest - text.data());
  const std::string_view word = text.substr(std::min(text.find_first_not_of(' ', digits), text.size()));
  if (error == std::errc{} && (word == "steps" || word == "step")) {
    if (interval.steps < 1) throw std::invalid_argument("less than a step");
    return interval;
  }
  const Measured measured = measure(text);
  if (measured.dimension.value_or(duration) != duration) throw std::invalid_argument(name_of(*measured.dimension));
  if (!(measured.value > 0)) throw std::invalid_argument("no time at all");
  return {measured.value, 0};
}

std::string text_of(const Interval& interval) {
  if (interval.steps > 0) return fmt::format("{} {}", interval.steps, interval.steps == 1 ? "step" : "steps");
  return fmt::format("{:g} s", interval.time);
}

// How many multiples were passed by then, the zeroth among them. 3 s are 100 steps of 30 ms, whatever the last bit says
long Schedule::count(long macro_step) const {
  constexpr double rounding = 1e-9;  // of a step
  if (macro_step < 0) return 0;
  if (every_.steps > 0) return macro_step / every_.steps + 1;
  if (every_.time < step_) return macro_step + 1;
  return static_cast<long>(std::floor((static_cast<double>(macro_step) + rounding) * step_ / every_.time)) + 1;
}

bool Schedule::due(long macro_step) const { return count(macro_step) > count(macro_step - 1); }

}  // namespace plica::app
