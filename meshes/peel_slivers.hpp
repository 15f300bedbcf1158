// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>
#include <vector>

namespace plica {

/// Drops slivers that lie on the boundary with two of their faces and have a height ratio (see TetShape) above 20, again and again:
/// the surface turns the edge between these faces, and moves by the sliver's height at most, a twentieth of its longest edge. One whose
/// other two faces would meet at an edge of the boundary stays.
/// @param numbers  a number per tetrahedron, which keeps to it
/// @return how many
int peel_slivers(TetMesh& mesh, std::vector<int>& numbers);

}  // namespace plica
