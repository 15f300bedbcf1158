// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/app/commands/arguments.hpp>
#include <plica/drivers/app/output/checkpoint.hpp>

namespace plica::app {

/// The scene of the run to go on with: the checkpoint's own, or the given one where it says the same. Only a longer or shorter
/// duration may be new. InputError that names what else is.
Scene scene_to_resume(const RunArguments& arguments, const Checkpoint& from);

/// "every=100" macro steps, "every=100 steps", or "every=0.1s" of simulated time.
Interval checkpoint_interval(const std::string& text);

}  // namespace plica::app
