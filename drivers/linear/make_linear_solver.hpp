// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <memory>
#include <plica/drivers/linear/linear_solver.hpp>

namespace plica {

/// What solves the systems of a level, chosen where the options say auto: a direct solver for small
/// meshes where the host reads the matrix; else conjugate gradients, by multigrid where the body
/// has coarser meshes, or one mesh and long steps, on an assembled matrix. A fixed number of
/// iterations means plain ones, preconditioned by blocks.
/// @param solver         a name of the list, or auto
/// @param critical_step  of the level [s]; 0: not known, and no step is long
LinearSolverParts linear_solver_parts(const Problem& problem, std::size_t level, bool on_host,
                                      std::string solver, double critical_step = 0);

/// "conjugate_gradients, multigrid over 3 levels, assembled"
std::string describe(const LinearSolverParts& parts);

/// Throws InputError for names that are not in the lists, and a direct solver where the host does
/// not read device memory.
template <class B>
std::unique_ptr<LinearSolver<B>> make_linear_solver(const LinearSolverParts& parts,
                                                    const Level<B>& level);

}  // namespace plica
