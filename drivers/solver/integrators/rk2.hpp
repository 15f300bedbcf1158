// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/solver/integrators/runge_kutta.hpp>

namespace plica {

/// The explicit midpoint rule: order 2, two forces per step. |R|^2 = 1 + (h w)^4/4 - h c: an undamped mode grows at every step, one
/// with mass damping c is stable for h^3 < 4 c/w^4 and h c < 2.
struct Rk2 {
  static constexpr const char* name = "rk2";
  static constexpr const char* summary = "explicit, order 2, two forces a step; undamped it grows at every step";
  static constexpr bool is_explicit = true;
  static constexpr StabilityLimit limit{.growth = 0.25, .power = 4, .damping = 2};

  static constexpr int stages = 2;
  static constexpr double weight[2] = {0, 1}, ahead[1] = {0.5};
  template <class B>
  using Step = RungeKutta<B, Rk2>;
};

}  // namespace plica
