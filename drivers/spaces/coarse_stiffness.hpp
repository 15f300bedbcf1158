// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <plica/core/mesh.hpp>
#include <plica/drivers/spaces/transfer_matrix.hpp>
#include <vector>

namespace plica {

/// Returns an approximation of P^T K P, with K the stiffness of a mesh of linear elements at rest.
/// The matrix is dense: [3 columns x 3 columns], xyz interleaved [N/m]. P has at most some hundred
/// columns, and is smooth on the mesh. Elements are grouped into cells, 60 per column of P. A cell
/// uses the part of the gradients of P's motions that is linear over it. The result is never
/// stiffer than P^T K P, and equals it where a cell has at most four elements.
Eigen::MatrixXd coarse_stiffness(const TetMesh& mesh,
                                 const std::vector<std::array<double, 2>>& lame,
                                 const RowMatrix& P);

}  // namespace plica
