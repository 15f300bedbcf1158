// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/app/commands/arguments.hpp>
#include <plica/drivers/app/commands/exit_status.hpp>
#include <plica/drivers/study/stability_matrix.hpp>

namespace plica::app {

/// Searches the largest stable macro steps of a scene's methods, or runs the matrix of stiff and extreme cases; keeps stability.json and
/// stability.csv up to date, and says what came out.
ExitStatus stability(const RunArguments& arguments, const StabilityArguments& more);

/// Failed where a row is wrong, interrupted where it was stopped before.
ExitStatus status_of(const MatrixResult& result);

}  // namespace plica::app
