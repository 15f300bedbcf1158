// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace plica::app {

/// The least number of whole macro steps, at least one, that covers a duration [s] but for rounding. InputError where
/// nobody could wait for them.
long steps_to_cover(double duration, double macro_step);

}  // namespace plica::app
