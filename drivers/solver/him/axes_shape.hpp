// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/solver/him/mass_spaces.hpp>

namespace plica {

/// What the axes of the coarsest level are found from, see CoarseAxes.
struct AxesShape {
  RowMatrix restriction;  ///< E: means by mass over what hangs on a coarse vertex; rows sum to 1
  RowMatrix smoothing;    ///< W: six averages over the elements' neighbourhoods, over the volumes; W D = 1 at rest
  std::vector<std::array<double, 10>>
      tets;  ///< inverse edges between restricted rest positions, volume / mean; 0: flat
};

/// @param mass  of the finest level's vertices [kg]
AxesShape axes_shape(const TetMesh& finest, const TetMesh& coarsest, const std::vector<double>& mass);

}  // namespace plica
