// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/study/largest_stable.hpp>
#include <plica/drivers/study/stability.hpp>

namespace plica {

/// Runs the problem as it is for `duration` [s], time and again, for the largest macro step with which it comes to the end. Explicit
/// sub-steps may be above their limit.
/// @param go_on  called after every macro step; what it throws ends the search
template <class B>
SceneLimit scene_limit(const Problem& problem, double duration, const StepRange& range,
                       const std::function<void()>& go_on);

}  // namespace plica
