// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/level_data.hpp>
#include <plica/core/problem.hpp>
#include <plica/drivers/elastic/level_constants.hpp>
#include <plica/drivers/level/part_of_level.hpp>
#include <vector>

namespace plica {

/// Additional data of nodal elements, to precondition implicit steps: none; linear elements, of
/// which a matrix is assembled; or these and rows in float.
enum class BesideNodal { nothing, matrix, matrix_and_rows };

/// Builds model, state and work arrays of a level, without transfers and surface.
/// @param part  this rank's part of the level, of which mesh and constants are; null: the mesh is
///              the whole level. All ranks build their parts at the same time
template <class B>
LevelData<B> build_level(const Body& body, const TetMesh& placed, const LevelConstants& constants,
                         BesideNodal beside = BesideNodal::nothing,
                         const LevelPart* part = nullptr);

}  // namespace plica
