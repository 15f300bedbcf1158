// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace plica::app {

/// Runs the program plica: reads the command line, does what it says, and returns the exit status
/// (ExitStatus in commands/commands.hpp).
int program(int argc, char** argv);

}  // namespace plica::app
