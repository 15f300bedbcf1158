// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/ranks.hpp>

namespace plica::app {

/// Runs the program plica: reads the command line, does what it says, and returns the exit status
/// (ExitStatus in commands/commands.hpp).
/// @param ranks  processes that run the same command together, of which rank 0 alone speaks; null:
///               this one process
int program(int argc, char** argv, Ranks* ranks = nullptr);

}  // namespace plica::app
