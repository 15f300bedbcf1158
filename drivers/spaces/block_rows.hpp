// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Core>
#include <array>
#include <plica/core/mesh.hpp>
#include <utility>
#include <vector>

namespace plica {

/// Symmetric matrix of 3x3 blocks on the host, by rows: (column, block), columns ascending.
using BlockRows = std::vector<std::vector<std::pair<int, Eigen::Matrix3d>>>;

/// Returns the stiffness of a mesh of linear elements at rest [N/m].
/// @param lame  lambda and mu per region of the mesh [Pa]
BlockRows rest_stiffness(const TetMesh& mesh, const std::vector<std::array<double, 2>>& lame);

}  // namespace plica
