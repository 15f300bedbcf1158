// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/level_data.hpp>
#include <plica/core/path.hpp>
#include <plica/kernels/followers.hpp>
#include <plica/kernels/vectors.hpp>

// Boundary conditions: vertices that follow a path, or slide, and loads.
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

/// Returns where an arm from an axis is after a turn by an angle [rad]: Rodrigues' formula.
KOKKOS_INLINE_FUNCTION Vec3<double> turned_arm(const Vec3<double>& axis, double angle,
                                               const Vec3<double>& arm) {
  const double c = Kokkos::cos(angle), s = Kokkos::sin(angle);
  return c * arm + s * cross(axis, arm) + ((1 - c) * dot(axis, arm)) * axis;
}

/// Returns the displacement at a time of a vertex that translates along a path, or turns by it, and
/// its velocity; see path_step() for `ahead`. `arm`: from the turn's point to the vertex at rest
/// [m].
KOKKOS_INLINE_FUNCTION PathPoint given_step(const Path& path, const PathKnot* knots,
                                            const TurnAxis& turn, const Vec3<double>& arm,
                                            double time, double ahead) {
  if (!turn.turns) return path_step(path, knots, time, ahead);
  const PathPoint angle = path_at(path, knots, time);
  const Vec3<double> start = turn.before * arm,
                     at = turned_arm(turn.axis, angle.displacement[0], start);
  PathPoint p{at - arm, angle.velocity[0] * cross(turn.axis, at)};
  if (ahead > 0)
    p.velocity =
        (1 / ahead) *
        (turned_arm(turn.axis, path_at(path, knots, time + ahead).displacement[0], start) - at);
  return p;
}

/// Returns given_step() of vertex i of the vertices whose motion is given.
template <class B>
KOKKOS_INLINE_FUNCTION PathPoint given_step(const PrescribedVertices<B>& given, int i, double time,
                                            double ahead) {
  const Path& path = given.paths(given.path(i));
  if (given.turns.extent(0) == 0) return path_step(path, given.knots.data(), time, ahead);
  return given_step(path, given.knots.data(), given.turns(given.path(i)),
                    {given.arm(i, 0), given.arm(i, 1), given.arm(i, 2)}, time, ahead);
}

/// Returns the acceleration of vertex i of the vertices whose motion is given [m/s^2]. At the knots
/// of a curve, where the velocity jumps, it has none.
template <class B>
KOKKOS_INLINE_FUNCTION Vec3<double> given_acceleration(const PrescribedVertices<B>& given, int i,
                                                       double time) {
  const Path& path = given.paths(given.path(i));
  Vec3<double> change;  // change of the velocity, or of the rate of the angle
  if (path.rate > 0)
    change = (-path.rate * path.rate * Kokkos::sin(path.rate * time + path.phase)) * path.amplitude;
  if (given.turns.extent(0) == 0 || !given.turns(given.path(i)).turns) return change;
  const TurnAxis& turn = given.turns(given.path(i));
  const PathPoint angle = path_at(path, given.knots.data(), time);
  const Vec3<double> at =
      turned_arm(turn.axis, angle.displacement[0],
                 turn.before * Vec3<double>{given.arm(i, 0), given.arm(i, 1), given.arm(i, 2)});
  const Vec3<double> round = cross(turn.axis, at);
  const double rate = angle.velocity[0];
  return change[0] * round + (rate * rate) * cross(turn.axis, round);
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
    const PathPoint p = given_step(given, i, *time, ahead);
    for (int k = 0; k < 3; ++k) {
      state.u(given.vertex(i), k) = static_cast<Real>(p.displacement[k]);
      state.v(given.vertex(i), k) = static_cast<Real>(p.velocity[k]);
    }
  }
};

/// Takes out of the vectors of sliding vertices what is along the directions that hold them.
template <class B>
struct HoldSliding {
  SlidingVertices<B> sliding;
  Vectors<B> x;

  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    const int a = sliding.vertex(i);
    Vec3<double> free;
    for (int k = 0; k < 3; ++k) free[k] = static_cast<double>(x(a, k));
    for (int which = 0; which < 2; ++which) {
      const Vec3<double> normal = sliding.normal(i, which);
      free -= dot(normal, free) * normal;
    }
    for (int k = 0; k < 3; ++k) x(a, k) = static_cast<typename B::Real>(free[k]);
  }
};

/// Takes out of a field what is along the directions that hold its sliding vertices. For the field
/// of forces, what is taken out is minus the force that holds them.
template <class B>
void hold_sliding(const typename B::Exec& exec, const LevelData<B>& level, const Vectors<B>& x) {
  if (level.sliding.count > 0)
    update_vertices<B>(exec, "plica::hold_sliding", level.sliding.count,
                       HoldSliding<B>{level.sliding, x});
}

/// Holds sliding vertices in a state.
template <class B>
void hold_sliding(const typename B::Exec& exec, const LevelData<B>& level, const State<B>& state) {
  hold_sliding(exec, level, state.u);
  hold_sliding(exec, level, state.v);
}

/// Puts the vertices whose motion is given into a level's state at a time [s]; see path_step() for
/// `ahead`. Sliding vertices keep their displacement and velocity across what holds them. Followers
/// go where their masters are: every integrator calls this after each update of a state.
template <class B>
void prescribe(const typename B::Exec& exec, const LevelData<B>& level, const State<B>& state,
               double time, double ahead = 0) {
  hold_sliding(exec, level, state);
  if (level.prescribed.count > 0)
    update_vertices<B>(exec, "plica::prescribe", level.prescribed.count,
                       PrescribeMotion<B>{level.prescribed, state, time, ahead});
  follow_masters(exec, level.model, state);
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
