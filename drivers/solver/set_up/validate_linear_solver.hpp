// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/problem.hpp>

namespace plica {

/// Throws InputError for options of the linear solver out of their range, or that make no sense together.
void validate_linear_solver(const Problem& problem);

}  // namespace plica
