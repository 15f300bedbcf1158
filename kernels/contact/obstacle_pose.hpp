// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/fields.hpp>
#include <plica/core/launch.hpp>
#include <plica/core/small.hpp>

namespace plica {

/// Rotation of an obstacle: a point X of its shape is at centre + R (X - centre) + displacement.
struct Attitude {
  bool turned = false;    ///< false: it translates, and the other members are not used
  Vec3<double> centre;    ///< centre of the rotation at t = 0 [m]
  Mat3<double> rotation;  ///< R
  Vec3<double> rate;      ///< angular velocity [rad/s]
  /// Factors of the mean velocity of a step of h, over which a place goes the chord: sin(w h)/(w h)
  /// along w x r, and (1 - cos(w h))/(w h)^2 h inward.
  /// @{
  double along = 1, inward = 0;
  /// @}
};

/// Pose of an obstacle at a time, and its velocities.
struct ObstaclePose {
  Vec3<double> displacement, speed;  ///< [m], [m/s]
  double time = 0;                   ///< [s]
  Attitude turn;

  /// Returns the position of a point that the shape has at X [m].
  KOKKOS_INLINE_FUNCTION Vec3<double> placed(const Vec3<double>& X) const {
    return turn.turned ? turn.centre + turn.rotation * (X - turn.centre) + displacement
                       : X + displacement;
  }
  /// Returns a position in the axes of the shape [m].
  template <class Real>
  KOKKOS_INLINE_FUNCTION Vec3<Real> local(const Vec3<Real>& x) const {
    return turn.turned ? rounded<Real>(turned_back(exact(x))) : x - rounded<Real>(displacement);
  }
  /// Returns how far the obstacle has moved its point that is at x [m].
  template <class Real>
  KOKKOS_INLINE_FUNCTION Vec3<double> way(const Vec3<Real>& x) const {
    return turn.turned ? exact(x) - turned_back(exact(x)) : displacement;
  }
  /// Returns a direction in the axes of the shape; outward() turns it back.
  template <class Real>
  KOKKOS_INLINE_FUNCTION Vec3<Real> to_local(const Vec3<Real>& d) const {
    return turn.turned ? rounded<Real>(transpose(turn.rotation) * exact(d)) : d;
  }
  template <class Real>
  KOKKOS_INLINE_FUNCTION Vec3<Real> to_world(const Vec3<Real>& d) const {
    return turn.turned ? rounded<Real>(turn.rotation * exact(d)) : d;
  }
  KOKKOS_INLINE_FUNCTION bool is_turning() const {
    return turn.turned && dot(turn.rate, turn.rate) > 0;
  }
  /// Returns the angular velocity [rad/s].
  template <class Real>
  KOKKOS_INLINE_FUNCTION Vec3<Real> rate() const {
    return is_turning() ? rounded<Real>(turn.rate) : Vec3<Real>{};
  }
  /// Returns the velocity of the obstacle's point at x [m/s].
  template <class Real>
  KOKKOS_INLINE_FUNCTION Vec3<Real> velocity(const Vec3<Real>& x) const {
    if (!turn.turned) return rounded<Real>(speed);
    const Vec3<double> round = cross(turn.rate, exact(x) - turn.centre - displacement);
    return rounded<Real>(speed + turn.along * round + turn.inward * cross(turn.rate, round));
  }

 private:
  template <class Real>
  static KOKKOS_INLINE_FUNCTION Vec3<Real> rounded(const Vec3<double>& x) {
    return {static_cast<Real>(x[0]), static_cast<Real>(x[1]), static_cast<Real>(x[2])};
  }
  template <class Real>
  static KOKKOS_INLINE_FUNCTION Vec3<double> exact(const Vec3<Real>& x) {
    return {static_cast<double>(x[0]), static_cast<double>(x[1]), static_cast<double>(x[2])};
  }
  KOKKOS_INLINE_FUNCTION Vec3<double> turned_back(const Vec3<double>& x) const {
    return turn.centre + transpose(turn.rotation) * (x - turn.centre - displacement);
  }
};

/// Unit quaternion w + x i + y j + z k of a rotation.
struct Quaternion {
  double w = 1, x = 0, y = 0, z = 0;

  KOKKOS_INLINE_FUNCTION Mat3<double> rotation() const {
    return {Vec3<double>{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
            Vec3<double>{2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
            Vec3<double>{2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}};
  }
  /// Returns the quaternion after a turn by d [rad], to the third order: q + d q / 2, normalised.
  KOKKOS_INLINE_FUNCTION Quaternion turned(const Vec3<double>& d) const {
    const double a = d[0] / 2, b = d[1] / 2, c = d[2] / 2;
    const Quaternion q{w - a * x - b * y - c * z, x + a * w + b * z - c * y,
                       y + b * w + c * x - a * z, z + c * w + a * y - b * x};
    const double over = 1 / Kokkos::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    return {over * q.w, over * q.x, over * q.y, over * q.z};
  }
};

/// Returns the rotation vector d [rad], of at most pi, that leads from R to S: S = exp(d) R.
KOKKOS_INLINE_FUNCTION Vec3<double> rotation_between(const Mat3<double>& R, const Mat3<double>& S) {
  const Mat3<double> D = S * transpose(R);
  const Vec3<double> twice_sine{D[2][1] - D[1][2], D[0][2] - D[2][0], D[1][0] - D[0][1]};
  const double sine = Kokkos::sqrt(dot(twice_sine, twice_sine)) / 2, cosine = (trace(D) - 1) / 2;
  const double angle = Kokkos::atan2(sine, cosine);
  return (sine > 1e-9 ? angle / (2 * sine) : 0.5) * twice_sine;
}

/// Source of an obstacle's pose at a time. It is given by motion and turn, or, for a tool with
/// mass, by numbers that the device computes.
template <class B>
struct ObstacleMotion {
  /// Numbers of a tool: displacement [m] and velocity [m/s] at a time [s], then its attitude (w, x,
  /// y, z) and angular velocity [rad/s].
  static constexpr int numbers = 14, at_time = 6, attitude = 7, rate = 11;

  /// Origin at t = 0 [m]: torques are about it, and a tool with mass turns about it
  Vec3<double> origin;
  Changing<B, ObstaclePose> pose;
  Doubles<B> tools;    ///< [numbers of each obstacle]; empty: no mass
  int first = 0;       ///< first number of this obstacle
  bool turns = false;  ///< true for a tool that has inertia

  KOKKOS_INLINE_FUNCTION ObstaclePose now() const {
    if (tools.extent(0) == 0) return *pose;
    ObstaclePose is;
    is.time = pose->time;
    const double since = is.time - tools(first + at_time);
    for (int k = 0; k < 3; ++k) {
      is.speed[k] = tools(first + 3 + k);
      is.displacement[k] = tools(first + k) + since * is.speed[k];
    }
    if (turns) {
      is.turn.turned = true, is.turn.centre = origin;
      for (int k = 0; k < 3; ++k) is.turn.rate[k] = tools(first + rate + k);
      is.turn.rotation = last_attitude().turned(since * is.turn.rate).rotation();
    }
    return is;
  }
  /// Returns the point that torques are about [m].
  KOKKOS_INLINE_FUNCTION Vec3<double> about() const { return now().placed(origin); }
  KOKKOS_INLINE_FUNCTION Quaternion last_attitude() const {
    const int q = first + attitude;
    return {tools(q), tools(q + 1), tools(q + 2), tools(q + 3)};
  }
};

}  // namespace plica
