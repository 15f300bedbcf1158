// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/study/sparse_stiffness.hpp>

namespace plica {

/// How Newton's method goes to a body at rest under its loads.
struct StaticOptions {
  Held held;                         ///< besides the fixed vertices
  int load_steps = 1;                ///< the loads' courses are followed from time 0 to 1 s in so many
  std::vector<Point> start;          ///< displacement [m]; empty: none
  std::vector<Point> force;          ///< more forces [N]; empty: none
  double relative_residual = 1e-10;  ///< to the largest residual met, at which a step ends
};

/// The displacement [m] at which all forces on the finest level balance, by Newton's method with direct solves; steps are halved
/// until the residual falls. Throws std::runtime_error where that does not lead there.
std::vector<Point> static_equilibrium(LevelProbe<HostBackend>& probe, const StaticOptions& options);

}  // namespace plica
