// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <plica/core/mesh.hpp>
#include <plica/drivers/spaces/transfer_matrix.hpp>
#include <vector>

namespace plica {

/// P^T K P of the stiffness K of a mesh of linear elements at rest, dense: [3 columns x 3 columns],
/// xyz interleaved [N/m]. For a P of at most some hundred columns, smooth on the mesh: of the
/// gradients of its motions a cell of elements, 60 to a column, takes what is linear: never more
/// than K, all of it where a cell has at most four elements.
Eigen::MatrixXd coarse_stiffness(const TetMesh& mesh,
                                 const std::vector<std::array<double, 2>>& lame,
                                 const RowMatrix& P);

}  // namespace plica
