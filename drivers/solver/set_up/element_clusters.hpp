// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>
#include <vector>

namespace plica {

/// Tetrahedra in groups of neighbours: each of one region, with at most `elements` of them and `vertices` vertices. Within a
/// group in mesh order. By recursive bisection across the longest extent of the centroids.
std::vector<std::vector<int>> element_clusters(const TetMesh& mesh, int elements, int vertices);

}  // namespace plica
