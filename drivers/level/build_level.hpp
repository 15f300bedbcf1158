// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/level.hpp>
#include <plica/core/problem.hpp>
#include <plica/drivers/elastic/level_constants.hpp>
#include <vector>

namespace plica {

/// What nodal elements have beside them to precondition implicit steps: linear ones, of which a
/// matrix is assembled, and rows in float.
enum class BesideNodal { nothing, matrix, matrix_and_rows };

/// Model, state and work arrays of a level. No transfers, no surface.
template <class B>
Level<B> build_level(const Body& body, const TetMesh& placed, const LevelConstants& constants,
                     BesideNodal beside = BesideNodal::nothing);

}  // namespace plica
