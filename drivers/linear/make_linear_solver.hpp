// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <memory>
#include <plica/drivers/linear/linear_solver.hpp>

namespace plica {

/// Chooses the solver of a level's systems and its options, where these are `auto`.
/// The choice is a direct solver for small meshes where the host can read the matrix. Else it is
/// conjugate gradients on an assembled matrix, with multigrid where the body has coarser meshes, or
/// one mesh and long steps. With a fixed number of iterations conjugate gradients are
/// preconditioned by vertex blocks.
/// @param on_host        whether the host can read all of a matrix: not where several ranks share it
/// @param solver         a name of the list, or auto
/// @param critical_step  critical step of the level [s]; 0: not known, and no step is long
LinearSolverParts linear_solver_parts(const Problem& problem, std::size_t level, bool on_host,
                                      std::string solver, double critical_step = 0);

/// Returns a description such as "conjugate_gradients, multigrid over 3 levels, assembled".
std::string describe(const LinearSolverParts& parts);

/// Makes the linear solver of a level.
/// Throws InputError for a name that is not in the list, with the nearest one, and for a direct
/// solver where the host cannot read device memory.
template <class B>
std::unique_ptr<LinearSolver<B>> make_linear_solver(const LinearSolverParts& parts,
                                                    const LevelData<B>& level);

}  // namespace plica
