// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/contact/obstacle_pose.hpp>

namespace plica {

/// Tool with mass, and the springs and dampers by which it follows its motion and its turn.
struct RigidTool {
  double mass = 0, stiffness = 0, damping = 0;  ///< [kg], [N/m], [N s/m]
  /// Inertia about the tool's origin, in the axes of the shape [kg m^2]
  Mat3<double> inertia;
  double angular_stiffness = 0, angular_damping = 0;  ///< [N m/rad], [N m s/rad]
};

/// Moves a tool with mass m after a macro step T, in which it went on with its velocity. The law m
/// dv/dt = F + k (x* - x) + c (v* - v) is integrated by implicit Euler for the coupling, which is
/// stable for any k and c. F is the mean contact force of that step. x* and v* are the position and
/// the velocity that its motion asks for at the end of the next step. A tool that turns follows
/// dL/dt = M + k d + c (w* - w), L = I w, with the mean torque M about its origin. The rotation
/// vector d leads to the attitude that its turn asks for. A tool that turns freely keeps L.
template <class B>
struct MoveTool {
  ObstacleMotion<B> place;          ///< pose at the end of the step
  Changing<B, ObstaclePose> asked;  ///< pose asked for at the end of the next step
  Doubles<B> wrench;                ///< force and torque on the body
  int force;                        ///< number of the tool's first component in wrench
  double span;
  RigidTool tool;

  KOKKOS_INLINE_FUNCTION void operator()(int) const {
    const double T = span;
    const int x = place.first, v = x + 3;
    const ObstaclePose is = place.now(), goal = *asked;
    const Vec3<double> way = goal.placed(place.origin) - place.origin,
                       speed = goal.velocity(place.origin + way);
    if (place.turns) turn(is, goal);
    for (int k = 0; k < 3; ++k) {
      const double pull = -wrench(force + k) + tool.stiffness * (way[k] - is.displacement[k]) +
                          tool.damping * speed[k];
      place.tools(v + k) = (is.speed[k] + T / tool.mass * pull) /
                           (1 + T / tool.mass * (tool.damping + T * tool.stiffness));
      place.tools(x + k) = is.displacement[k];
    }
    place.tools(x + ObstacleMotion<B>::at_time) = is.time;
  }

  KOKKOS_INLINE_FUNCTION void turn(const ObstaclePose& is, const ObstaclePose& goal) const {
    const double T = span, k = tool.angular_stiffness, c = tool.angular_damping;
    const int q = place.first + ObstacleMotion<B>::attitude,
              w = place.first + ObstacleMotion<B>::rate;
    const Mat3<double> before = place.last_attitude().rotation(), now = is.turn.rotation;
    const auto turned = [&](const Mat3<double>& R) { return R * (tool.inertia * transpose(R)); };
    const Mat3<double> asked_rotation =
        goal.turn.turned ? goal.turn.rotation : Mat3<double>::identity();
    Vec3<double> L = turned(before) * is.turn.rate + T * k * rotation_between(now, asked_rotation);
    if (goal.turn.turned) L += T * c * goal.turn.rate;
    for (int i = 0; i < 3; ++i) L[i] -= T * wrench(force + 3 + i);
    const Mat3<double> A = turned(now) + Mat3<double>::diagonal(T * (c + T * k)),
                       of_A = cofactor(A);
    const Vec3<double> rate = (1 / dot(A[0], of_A[0])) * (transpose(of_A) * L);
    const Quaternion attitude =
        place.last_attitude().turned((is.time - last_time()) * is.turn.rate);
    place.tools(q) = attitude.w, place.tools(q + 1) = attitude.x;
    place.tools(q + 2) = attitude.y, place.tools(q + 3) = attitude.z;
    for (int i = 0; i < 3; ++i) place.tools(w + i) = rate[i];
  }
  KOKKOS_INLINE_FUNCTION double last_time() const {
    return place.tools(place.first + ObstacleMotion<B>::at_time);
  }
};

}  // namespace plica
