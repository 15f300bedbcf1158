// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/level/part_of_level.hpp>
#include <vector>

// Vertices and elements that a rank needs beside its own ones, to assemble its rows of a matrix.
namespace plica {

/// Marks the vertices of all tetrahedra at vertices that a rank owns.
void mark_neighbours(const TetMesh& mesh, const RankRanges& ranges, int own,
                     std::vector<char>& is_local);

/// Returns the rows of vertices that ranks with linear elements receive from their owners: all that
/// they have and do not own.
HaloRows rows_of_neighbours(const TetMesh& mesh, const std::vector<std::vector<int>>& runs,
                            const RankRanges& ranges, int own, const RankPart& part);

/// Returns the tetrahedra at the vertices that a rank owns.
MatrixPart matrix_part(const TetMesh& mesh, const std::vector<std::vector<int>>& runs,
                       const RankPart& part);

}  // namespace plica
