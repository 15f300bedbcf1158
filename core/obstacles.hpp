// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <any>
#include <optional>
#include <plica/core/motion.hpp>
#include <plica/core/selection.hpp>
#include <string>
#include <vector>

/// Rigid solids that a body's surface can touch.
namespace plica {

/// The options of a shape: one of the structs of kernels/contact/shapes/, such as SphereOptions.
using ShapeOptions = std::any;

/// The spring and damper between a tool with mass and where its motion asks it to be.
struct CouplingOptions {
  double stiffness = 0;                ///< [N/m]
  std::optional<double> damping = {};  ///< [N s/m]; none: critical, 2 sqrt(stiffness mass)
  /// of one that turns, to the attitude of its turn [N m/rad]
  double angular_stiffness = 0;
  /// [N m s/rad]; none: critical for the largest moment of inertia
  std::optional<double> angular_damping = {};
};

/// When an obstacle takes hold of the surface points near it, and lets them go.
struct GraspOptions {
  std::vector<double> from = {};  ///< it closes [s]; empty: where a program says so
  /// it opens, after each of these [s]; may lack the last: it stays closed
  std::vector<double> until = {};
  /// largest distance outside the obstacle at which a point is grasped [m]
  double reach = 0;
  /// of the spring of each point [N/m]; none: as contact has it
  std::optional<double> stiffness = {};
  /// force at which the spring of a point tears [N]; none: it never does
  std::optional<double> strength = {};
  std::optional<Selection> where = {};  ///< of the points near it, by where they start; none: all
};

/// A shape, how rough it is and how it moves.
struct ObstacleOptions {
  ShapeOptions shape;              ///< at t = 0
  std::optional<double> friction;  ///< Coulomb's coefficient; none: frictionless
  Motion motion;                   ///< from where the shape says
  /// what results call it; empty: obstacle_0, obstacle_1, ... in order
  std::string name = {};
  std::optional<double> mass = {};  ///< [kg]; none: it is where its motion says
  /// Of one with mass, about its centre of mass at t = 0 [kg m^2]: xx yy zz, or xx yy zz xy xz yz;
  /// empty: it does not turn.
  std::vector<double> inertia = {};
  std::optional<Point> centre_of_mass = {};  ///< at t = 0 [m]; none: the shape's origin
  CouplingOptions coupling = {};             ///< of one with mass
  std::optional<GraspOptions> grasp = {};    ///< none: it cannot hold anything
  std::optional<Turn> turn = {};  ///< besides its motion; none: it translates; of one with inertia
                                  ///< what its coupling pulls to
};

}  // namespace plica
