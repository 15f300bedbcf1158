// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>
#include <vector>

namespace plica {

/// The number of parts of a mesh that share no vertex; vertices of no tetrahedron do not count.
int count_parts(const TetMesh& mesh);
int count_parts(const TriangleSurface& surface);

/// Per point one with a lower number within `tolerance` [m], from zero; -1: there is none.
std::vector<int> lower_twins(const std::vector<Point>& points, double tolerance);

/// The number of vertices within `tolerance` [m] of one with a lower number. Two meshes glued together
/// without merging their common vertices show up here: they come apart when simulated.
int count_duplicate_vertices(const TetMesh& mesh, double tolerance);

}  // namespace plica
