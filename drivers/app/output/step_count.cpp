// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <plica/core/error.hpp>
#include <plica/drivers/app/output/step_count.hpp>

namespace plica::app {

long steps_to_cover(double duration, double macro_step) {
  constexpr double rounding = 1e-9;  // of a step: 3 s are 100 steps of 30 ms
  constexpr double most = 1e12;
  const double steps = std::ceil(duration / macro_step - rounding);
  if (!(steps <= most))
    throw InputError(fmt::format("a duration of {:g} s is {:.3g} macro steps of {:g} s; expected at most {:g}",
                                 duration, steps, macro_step, most));
  return std::max(1L, std::lround(steps));
}

}  // namespace plica::app
