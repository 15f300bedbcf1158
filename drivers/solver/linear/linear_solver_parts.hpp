// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/problem.hpp>
#include <plica/drivers/solver/spaces/transfer_matrix.hpp>
#include <vector>

namespace plica {

/// Of the coarsest level of multigrid, which is answered by a dense inverse.
inline constexpr int most_dense_unknowns = 1536;

/// What a linear solver is given at set-up, no `auto` left in its options.
struct LinearSolverParts {
  ImplicitOptions options;
  std::vector<RowMatrix> transfers;  ///< from the body's coarser meshes, finest first; for multigrid only
};

}  // namespace plica
