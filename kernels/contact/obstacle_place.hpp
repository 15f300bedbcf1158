// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/fields.hpp>
#include <plica/core/launch.hpp>
#include <plica/core/path.hpp>
#include <plica/core/small.hpp>

namespace plica {

/// How an obstacle is turned: what its shape has at X is at centre + R (X - centre) and its displacement.
struct Attitude {
  bool turned = false;    ///< false: it translates, and nothing of these is used
  Vec3<double> centre;    ///< at t = 0 [m]
  Mat3<double> rotation;  ///< R
  Vec3<double> rate;      ///< angular velocity [rad/s]
  /// The mean velocity of a step of h, of which a place goes the chord: along sin(w h)/(w h) w x r, and inward (1 - cos(w h))/(w h)^2 h.
  /// @{
  double along = 1, inward = 0;
  /// @}
};

/// By its motion and its turn.
struct ObstaclePose {
  Vec3<double> displacement, speed;  ///< [m], [m/s]
  double time = 0;                   ///< [s]
  Attitude turn;
};

/// Where an obstacle is at a time, and how fast: where its motion and its turn say, or as a tool with mass goes, which the device knows
/// and which does not turn.
template <class B>
struct ObstaclePlace {
  using Real = typename B::Real;
  static constexpr int numbers = 7;  ///< of a tool: displacement [m] and velocity [m/s] at a time [s]

  Vec3<double> origin;  ///< at t = 0, what torques are about [m]
  Changing<B, ObstaclePose> pose;
  Doubles<B> tools;  ///< [numbers of each obstacle]; empty: it has no mass
  int first = 0;     ///< its own of them

  KOKKOS_INLINE_FUNCTION Vec3<double> moved() const {
    if (tools.extent(0) == 0) return pose->displacement;
    const double since = pose->time - tools(first + 6);
    Vec3<double> x;
    for (int k = 0; k < 3; ++k) x[k] = tools(first + k) + since * tools(first + 3 + k);
    return x;
  }
  /// What torques are about.
  KOKKOS_INLINE_FUNCTION Vec3<double> about() const {
    const Attitude& turn = pose->turn;
    return turn.turned ? turn.centre + turn.rotation * (origin - turn.centre) + moved() : origin + moved();
  }
  /// A place, as the shape has it.
  KOKKOS_INLINE_FUNCTION Vec3<Real> local(const Vec3<Real>& x) const {
    return pose->turn.turned ? rounded(turned_back(exact(x))) : x - rounded(moved());
  }
  /// How far that is moved [m].
  KOKKOS_INLINE_FUNCTION Vec3<double> way(const Vec3<Real>& x) const {
    return pose->turn.turned ? exact(x) - turned_back(exact(x)) : moved();
  }
  /// A direction, as the shape has it, and back.
  KOKKOS_INLINE_FUNCTION Vec3<Real> inward(const Vec3<Real>& d) const {
    return pose->turn.turned ? rounded(transpose(pose->turn.rotation) * exact(d)) : d;
  }
  KOKKOS_INLINE_FUNCTION Vec3<Real> outward(const Vec3<Real>& d) const {
    return pose->turn.turned ? rounded(pose->turn.rotation * exact(d)) : d;
  }
  KOKKOS_INLINE_FUNCTION bool is_turning() const {
    return pose->turn.turned && dot(pose->turn.rate, pose->turn.rate) > 0;
  }
  /// Its angular velocity [rad/s].
  KOKKOS_INLINE_FUNCTION Vec3<Real> rate() const { return is_turning() ? rounded(pose->turn.rate) : Vec3<Real>{}; }
  /// Of what the obstacle has at x [m/s].
  KOKKOS_INLINE_FUNCTION Vec3<Real> velocity(const Vec3<Real>& x) const {
    if (tools.extent(0) > 0) return rounded({tools(first + 3), tools(first + 4), tools(first + 5)});
    const Vec3<double>& speed = pose->speed;
    const Attitude& turn = pose->turn;
    if (!turn.turned) return rounded(speed);
    const Vec3<double> round = cross(turn.rate, exact(x) - turn.centre - pose->displacement);
    return rounded(speed + turn.along * round + turn.inward * cross(turn.rate, round));
  }

 private:
  static KOKKOS_INLINE_FUNCTION Vec3<Real> rounded(const Vec3<double>& x) {
    return {static_cast<Real>(x[0]), static_cast<Real>(x[1]), static_cast<Real>(x[2])};
  }
  static KOKKOS_INLINE_FUNCTION Vec3<double> exact(const Vec3<Real>& x) {
    return {static_cast<double>(x[0]), static_cast<double>(x[1]), static_cast<double>(x[2])};
  }
  KOKKOS_INLINE_FUNCTION Vec3<double> turned_back(const Vec3<double>& x) const {
    const Attitude& turn = pose->turn;
    return turn.centre + transpose(turn.rotation) * (x - turn.centre - moved());
  }
};

/// A tool with mass m after a macro step T, in which it went on with its velocity: m dv/dt = F + k (x* - x) + c (v* - v) by implicit
/// Euler for the coupling, stable for any k and c, with the mean contact force F of that step. x* and v* are where its motion asks it
/// to be at the end of the next step and how fast it gets there.
template <class B>
struct MoveTool {
  ObstaclePlace<B> place;        ///< at the end of the step
  Changing<B, PathPoint> asked;  ///< at the end of the next
  Doubles<B> wrench;             ///< on the body
  int force;                     ///< its first number in it
  double span, mass, stiffness, damping;

  KOKKOS_INLINE_FUNCTION void operator()(int k) const {
    const int x = place.first + k, v = x + 3;
    const double T = span, now = place.tools(x) + T * place.tools(v);
    const double pull = -wrench(force + k) + stiffness * (asked->displacement[k] - now) + damping * asked->velocity[k];
    place.tools(v) = (place.tools(v) + T / mass * pull) / (1 + T / mass * (damping + T * stiffness));
    place.tools(x) = now;
    if (k == 0) place.tools(place.first + 6) = place.pose->time;
  }
};

}  // namespace plica
