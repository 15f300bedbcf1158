// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/motion.hpp>
#include <vector>

namespace plica {

/// A blade: a straight edge that moves. It cuts what it sweeps.
struct BladeOptions {
  std::vector<Point> segment;  ///< both ends of the edge at t = 0 [m]
  Motion motion;               ///< motion from there
};

/// A cut of the finest level by a blade, while the run goes on.
struct CutOptions {
  BladeOptions blade;  ///< blade that cuts
  double from = 0;     ///< time at which the blade begins to cut [s]
  double to = 0;       ///< time at which it ends, above `from` [s]
};

}  // namespace plica
