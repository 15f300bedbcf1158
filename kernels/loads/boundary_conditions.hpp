// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/level_data.hpp>
#include <plica/core/path.hpp>
#include <plica/kernels/vectors.hpp>

// Boundary conditions: vertices that follow a path, and loads.
namespace plica {

/// Returns the displacement of a path at a time and its velocity from there on. `knots` are the
/// knots of all paths.
KOKKOS_INLINE_FUNCTION PathPoint path_at(const Path& path, const PathKnot* knots, double time) {
  PathPoint p{time * path.velocity, path.velocity};
  if (path.rate > 0) {
    const double angle = path.rate * time + path.phase;
    p.displacement += (Kokkos::sin(angle) - Kokkos::sin(path.phase)) * path.amplitude;
    p.velocity += (path.rate * Kokkos::cos(angle)) * path.amplitude;
  }
  if (path.knots > 0) {
    const PathKnot* k = knots + path.first_knot;
    int after = 0;  // number of knots that time has reached
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

/// Returns the displacement of a path at a time and, for ahead > 0 [s], its mean velocity up to
/// time + ahead. With it an implicit step ends where the path does. For ahead = 0 it is path_at().
KOKKOS_INLINE_FUNCTION PathPoint path_step(const Path& path, const PathKnot* knots, double time,
                                           double ahead) {
  PathPoint p = path_at(path, knots, time);
  if (ahead > 0)
    p.velocity = (1 / ahead) * (path_at(path, knots, time + ahead).displacement - p.displacement);
  return p;
}

/// Puts the vertices whose motion is given where their path says, with its velocity. Nothing is
/// integrated, so nothing drifts.
template <class B>
struct PrescribeMotion {
  PrescribedVertices<B> given;
  State<B> state;
  Changing<B, double> time;
  double ahead;

  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    using Real = typename B::Real;
    const PathPoint p = path_step(given.paths(given.path(i)), given.knots.data(), *time, ahead);
    for (int k = 0; k < 3; ++k) {
      state.u(given.vertex(i), k) = static_cast<Real>(p.displacement[k]);
      state.v(given.vertex(i), k) = static_cast<Real>(p.velocity[k]);
    }
  }
};

/// Puts the vertices whose motion is given into a level's state at a time [s]; see path_step() for
/// `ahead`.
template <class B>
void prescribe(const typename B::Exec& exec, const LevelData<B>& level, const State<B>& state,
               double time, double ahead = 0) {
  if (level.prescribed.count > 0)
    update_vertices<B>(exec, "plica::prescribe", level.prescribed.count,
                       PrescribeMotion<B>{level.prescribed, state, time, ahead});
}

/// Adds factor * the load's forces to f, vertex by vertex.
template <class B>
struct AddLoad {
  using Real = typename B::Real;
  Indices<B> vertex;
  Vectors<B> force, f;
  Changing<B, Real> factor;

  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    for (int k = 0; k < 3; ++k) f(vertex(i), k) += *factor * force(i, k);
  }
};

template <class B>
void add_load(const typename B::Exec& exec, const Load<B>& load, double factor,
              const Vectors<B>& f) {
  update_vertices<B>(exec, "plica::load", load.count,
                     AddLoad<B>{load.vertex, load.force, f, static_cast<typename B::Real>(factor)});
}

}  // namespace plica
