// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/path.hpp>

namespace plica {

/// Where a path has got to at a time, and how fast it moves from there on. `knots` are those of all paths.
KOKKOS_INLINE_FUNCTION PathPoint path_at(const Path& path, const PathKnot* knots, double time) {
  PathPoint p{time * path.velocity, path.velocity};
  if (path.rate > 0) {
    const double angle = path.rate * time + path.phase;
    p.displacement += (Kokkos::sin(angle) - Kokkos::sin(path.phase)) * path.amplitude;
    p.velocity += (path.rate * Kokkos::cos(angle)) * path.amplitude;
  }
  if (path.knots > 0) {
    const PathKnot* k = knots + path.first_knot;
    int after = 0;  // knots that time has reached
    for (int end = path.knots; after < end;) {
      const int middle = (after + end) / 2;
      if (k[middle].time <= time)
        after = middle + 1;
      else
        end = middle;
    }
    if (after == 0 || after == path.knots) {
      p.displacement += k[after == 0 ? 0 : after - 1].displacement;
    } else {
      const PathKnot &a = k[after - 1], &b = k[after];
      const Vec3<double> speed = (1 / (b.time - a.time)) * (b.displacement - a.displacement);
      p.displacement += a.displacement + (time - a.time) * speed;
      p.velocity += speed;
    }
  }
  return p;
}

/// The same with, for ahead > 0 [s], the mean velocity from there to time + ahead: an implicit step ends where the path does.
KOKKOS_INLINE_FUNCTION PathPoint path_step(const Path& path, const PathKnot* knots, double time, double ahead) {
  PathPoint p = path_at(path, knots, time);
  if (ahead > 0) p.velocity = (1 / ahead) * (path_at(path, knots, time + ahead).displacement - p.displacement);
  return p;
}

}  // namespace plica
