// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/app/commands/arguments.hpp>
#include <plica/drivers/app/commands/exit_status.hpp>

namespace plica::app {

/// plica explain: what a run of the scene would do, level by level and part by part.
ExitStatus explain(const SceneArguments& arguments);

/// plica check: sets the scene up, says so, runs nothing.
ExitStatus check(const SceneArguments& arguments);

}  // namespace plica::app
