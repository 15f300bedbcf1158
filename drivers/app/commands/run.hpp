// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/app/commands/arguments.hpp>
#include <plica/drivers/app/commands/exit_status.hpp>

namespace plica::app {

/// plica run: simulates the scene and writes its files.
ExitStatus run(const RunArguments& arguments);

}  // namespace plica::app
