// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/solver/level_forces.hpp>
#include <plica/kernels/explicit/updates.hpp>
#include <plica/kernels/implicit/bases.hpp>

namespace plica {

/// Base of the trapezoidal rule over h [s] from the level's state at `time`: half a step of forward Euler, and the drift of the
/// implicit half. Uses level.f.
template <class B>
void trapezoidal_base(const typename B::Exec& exec, Level<B>& level, LevelForces<B>& forces, double time, double h,
                      const State<B>& base) {
  using Real = typename B::Real;
  forces.evaluate(level, level.state, time, level.f);
  update_vertices<B>(exec, "plica::accelerations", level.model.vertices,
                     Accelerations<B>{level.model, level.f, level.state.v, level.f});
  update_vertices<B>(exec, "plica::trapezoidal_base", level.model.vertices,
                     ExtrapolateState<B>{level.state, level.f, base, static_cast<Real>(h), static_cast<Real>(h * h / 4),
                                         static_cast<Real>(h / 2)});
}

}  // namespace plica
