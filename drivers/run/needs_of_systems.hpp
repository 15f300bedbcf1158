// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/level/build_level.hpp>
#include <string>

// Data that a level gets besides its elements, for the linear systems of implicit steps.
namespace plica {

/// Returns whether the systems of a level may need a matrix, or a preconditioner that is made from
/// one.
bool may_need_matrix(const Problem& problem, const std::string& integrator);

/// Returns what a level of nodal elements gets to precondition implicit steps. Products with the
/// elements' own tangent (rows in float) need a third of the iterations in thick bodies and two
/// thirds in thin ones; each iteration takes twice as long. In contact they need a sixth, and
/// half of them where pressures are smoothed: cmake/docs/results/solvers.md.
/// @param mesh, constants  of the whole level
BesideNodal beside_nodal(const Problem& problem, const std::string& integrator, const TetMesh& mesh,
                         const LevelConstants& constants);

}  // namespace plica
