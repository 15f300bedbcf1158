// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <any>
#include <limits>
#include <optional>
#include <plica/core/motion.hpp>
#include <plica/core/selection.hpp>
#include <string>
#include <vector>

/// Rigid solids that a body's surface can touch.
namespace plica {

/// The options of a shape: one of the structs of kernels/contact/shapes/, such as SphereOptions.
using ShapeOptions = std::any;

/// Spring and damper between a tool with mass and the pose that its motion asks for.
struct CouplingOptions {
  double stiffness = 0;                ///< [N/m]
  std::optional<double> damping = {};  ///< [N s/m]; none: critical, 2 sqrt(stiffness mass)
  /// Stiffness of the spring to the attitude that the turn asks for [N m/rad]
  double angular_stiffness = 0;
  /// Damping of the rotation [N m s/rad]; none: critical for the largest moment of inertia
  std::optional<double> angular_damping = {};
};

/// Grasp of the surface points near an obstacle: when it closes and opens, and its springs.
struct GraspOptions {
  /// Times at which it closes [s]; empty: when a program says so
  std::vector<double> from = {};
  /// Times at which it opens, each after the same entry of `from` [s]. The last may be left out: it
  /// then stays closed
  std::vector<double> until = {};
  /// Largest distance outside the obstacle at which a point is grasped [m]; none: 0, and with
  /// `where` any distance
  std::optional<double> reach = {};
  /// Stiffness of the spring of each point [N/m]; none: that of contact
  std::optional<double> stiffness = {};
  /// Force at which the spring of a point tears [N]; none: it never does
  std::optional<double> strength = {};
  /// Points that may be grasped, by where they start; none: all
  std::optional<Selection> where = {};
};

/// Returns the largest distance outside an obstacle at which it grasps a point [m]; may be
/// infinite.
inline double grasp_reach(const GraspOptions& grasp) {
  return grasp.reach.value_or(grasp.where ? std::numeric_limits<double>::infinity() : 0.0);
}

/// A rigid obstacle: its shape, friction and motion.
struct ObstacleOptions {
  ShapeOptions shape;              ///< shape at t = 0
  std::optional<double> friction;  ///< Coulomb's coefficient; none: frictionless
  Motion motion;                   ///< motion from the pose of the shape
  /// Name in results; empty: obstacle_0, obstacle_1, ... in order
  std::string name = {};
  std::optional<double> mass = {};  ///< [kg]; none: its motion gives its pose
  /// Moments of inertia about the centre of mass at t = 0 [kg m^2]. They are xx yy zz, or xx yy zz
  /// xy xz yz. The obstacle must have mass. Empty: it does not turn
  std::vector<double> inertia = {};
  /// Position at t = 0 [m]; none: the shape's origin
  std::optional<Point> centre_of_mass = {};
  /// Coupling of an obstacle with mass to its motion
  CouplingOptions coupling = {};
  std::optional<GraspOptions> grasp = {};  ///< none: it grasps nothing
  /// Rotation beside the motion; none: it translates. For an obstacle with inertia, its coupling
  /// pulls it to this rotation
  std::optional<Turn> turn = {};
};

}  // namespace plica
