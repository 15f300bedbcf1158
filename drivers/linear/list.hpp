// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/type_list.hpp>
#include <plica/drivers/linear/conjugate_gradients.hpp>
#include <plica/drivers/linear/direct.hpp>
#include <plica/drivers/linear/v_cycle.hpp>

namespace plica {

/// All solvers of linear systems. To add one, include its file above and write its name here.
using LinearSolvers = TypeList<ConjugateGradients, Direct, VCycleSolver>;

}  // namespace plica
