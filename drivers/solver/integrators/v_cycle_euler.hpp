// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/solver/integrators/implicit_euler.hpp>

namespace plica {

/// Linearly implicit Euler whose system A = M + h^2 K is answered by exactly one V-cycle C of multigrid over the body's meshes. On the linear
/// problem, with C A in (0, 1], motion against k = h^2 C K < 1 has |eigenvalue|^2 = 1 - k: no limit on the step. What the cycle does not
/// resolve moves as if it were heavier; order 1. Of a body that stiffens, C stays behind until it is fitted again.
struct VCycleEuler {
  static constexpr const char* name = "v_cycle_euler";
  static constexpr const char* summary =
      "implicit, order 1: Euler by one V-cycle of multigrid per step; needs coarser levels";
  static constexpr bool is_explicit = false;
  static constexpr StabilityLimit limit{0.0};
  static constexpr const char* linear_solver = "v_cycle";  ///< whatever integration.implicit.solver says

  template <class B>
  using Step = ImplicitEuler::Step<B>;
};

}  // namespace plica
