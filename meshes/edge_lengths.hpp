// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <plica/core/mesh.hpp>
#include <vector>

namespace plica {

/// The edges of a mesh, each once, lower vertex first, ascending.
std::vector<std::array<int, 2>> mesh_edges(const TetMesh& mesh);
std::vector<std::array<int, 2>> mesh_edges(const TriangleSurface& surface);  ///< the same of a surface

/// Per vertex the mean length of the edges that meet there [m]; 0 for a vertex of no tetrahedron.
std::vector<double> local_edge_lengths(const TetMesh& mesh);

/// The mean over all edges [m]; 0 without any.
double mean_edge_length(const TetMesh& mesh);

/// The mean over the six edges of one tetrahedron. [m]
double mean_edge_length(const TetMesh& mesh, int tet);

}  // namespace plica
