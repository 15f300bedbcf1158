// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/solver/spaces/edge_graph.hpp>
#include <plica/drivers/solver/spaces/transfer_matrix.hpp>
#include <vector>

namespace plica {

/// A field at some of a mesh's vertices from its values at points, which are vertices of the mesh too, [rows x points]: a linear
/// fit at each (see LinearFit). A point at the distance d counts with the weight of s = d / r, where d is the larger of the straight
/// distance and the distance along edges over 1.4: parts of a body that are close but not connected do not follow each other, and
/// the edges' detours do not count. r is `reach` times `spacing`; it grows up to 1.8 times while there are fewer than six points or
/// they do not give a good fit. What then is still flat is fitted in fewer directions. Weights below 1e-4 are left out; rows sum to 1.
/// @param rows     the vertices
/// @param points   others, or the same
/// @param spacing  see mean_spacing() [m]
RowMatrix moving_least_squares(const TetMesh& mesh, const EdgeGraph& graph, const std::vector<int>& rows,
                               const std::vector<int>& points, double spacing, double reach);

}  // namespace plica
