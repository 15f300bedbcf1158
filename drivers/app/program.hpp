// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace plica::app {

/// The program plica: reads the command line, does what it says, and returns the exit status
/// (commands/commands.hpp).
int program(int argc, char** argv);

}  // namespace plica::app
