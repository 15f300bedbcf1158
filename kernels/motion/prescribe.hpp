// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/level.hpp>
#include <plica/kernels/motion/path.hpp>

namespace plica {

/// Vertices whose motion is given are where their path says, with its velocity: nothing is integrated, so nothing drifts.
template <class B>
struct PrescribeMotion {
  PrescribedVertices<B> given;
  State<B> state;
  double time, ahead;

  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    using Real = typename B::Real;
    const PathPoint p = path_step(given.paths(given.path(i)), given.knots.data(), time, ahead);
    for (int k = 0; k < 3; ++k) {
      state.u(given.vertex(i), k) = static_cast<Real>(p.displacement[k]);
      state.v(given.vertex(i), k) = static_cast<Real>(p.velocity[k]);
    }
  }
};

/// Puts them into a level's state at a time [s]; see path_step() for `ahead`.
template <class B>
void prescribe(const typename B::Exec& exec, const Level<B>& level, const State<B>& state, double time,
               double ahead = 0) {
  if (level.prescribed.count > 0)
    Kokkos::parallel_for("plica::prescribe", Kokkos::RangePolicy<typename B::Exec>(exec, 0, level.prescribed.count),
                         PrescribeMotion<B>{level.prescribed, state, time, ahead});
}

}  // namespace plica
