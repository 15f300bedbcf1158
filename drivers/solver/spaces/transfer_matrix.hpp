// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/solver/spaces/smoothing.hpp>
#include <plica/meshes/embedding.hpp>
#include <vector>

namespace plica {

/// P, [fine vertices x coarse vertices]: the fine vertices' places in the coarse mesh, `up`, smoothed on the fine mesh where asked for.
/// Vertices whose motion is given (`constrained`, one per vertex) have no part in it; neither have weights below 1e-6.
RowMatrix transfer_matrix(const TetMesh& fine, const std::vector<char>& fine_constrained, const TetMesh& coarse,
                          const std::vector<char>& coarse_constrained, const Embedding& up, bool smooth);

}  // namespace plica
