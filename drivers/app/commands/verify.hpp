// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/app/commands/arguments.hpp>
#include <plica/drivers/app/commands/exit_status.hpp>
#include <string>

namespace plica::app {

/// Solves problems with known answers, writes the table, and says which rows are not ok.
ExitStatus verify(const RunArguments& arguments, const VerifyArguments& more);

/// The problems' names, each with what it is, for the manual.
std::string verify_problems_text();

}  // namespace plica::app
