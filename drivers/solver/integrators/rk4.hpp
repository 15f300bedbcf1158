// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/solver/integrators/runge_kutta.hpp>

namespace plica {

/// The classical Runge-Kutta method: order 4, four forces per step; stable for h < 2.83/w undamped. Motion near that limit
/// decays. The radius 2.78 is that of the largest half disc in its stability region, so that it holds with any damping (Hairer &
/// Wanner II, IV.2).
struct Rk4 {
  static constexpr const char* name = "rk4";
  static constexpr const char* summary = "explicit, order 4, four forces a step; h < 2.78/w";
  static constexpr bool is_explicit = true;
  static constexpr StabilityLimit limit{.radius = 2.78, .damping = 2.78};

  static constexpr int stages = 4;
  static constexpr double weight[4] = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6}, ahead[3] = {0.5, 0.5, 1};
  template <class B>
  using Step = RungeKutta<B, Rk4>;
};

}  // namespace plica
