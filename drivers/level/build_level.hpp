// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/level_data.hpp>
#include <plica/core/problem.hpp>
#include <plica/drivers/elastic/level_constants.hpp>
#include <vector>

namespace plica {

/// Additional data of nodal elements, to precondition implicit steps: none; linear elements, of
/// which a matrix is assembled; or these and rows in float.
enum class BesideNodal { nothing, matrix, matrix_and_rows };

/// Builds model, state and work arrays of a level, without transfers and surface.
template <class B>
LevelData<B> build_level(const Body& body, const TetMesh& placed, const LevelConstants& constants,
                         BesideNodal beside = BesideNodal::nothing);

}  // namespace plica
