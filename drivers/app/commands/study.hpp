// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/app/commands/arguments.hpp>
#include <plica/drivers/app/commands/exit_status.hpp>

namespace plica::app {

/// Measures methods on a scene, keeps study.json and study.csv up to date row by row, and says what came out. Goes on with the
/// study that it finds in the folder, where that is of the same scene, program and machine.
ExitStatus study(const RunArguments& arguments, const StudyArguments& more);

}  // namespace plica::app
