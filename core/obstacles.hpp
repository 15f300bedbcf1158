// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <any>
#include <optional>
#include <plica/core/motion.hpp>
#include <string>

/// Rigid solids that a body's surface can touch.
namespace plica {

/// The options of a shape: one of the structs of kernels/contact/shapes/, such as SphereOptions.
using ShapeOptions = std::any;

/// The spring and damper between a tool with mass and where its motion asks it to be.
struct CouplingOptions {
  double stiffness = 0;                ///< [N/m]
  std::optional<double> damping = {};  ///< [N s/m]; none: critical, 2 sqrt(stiffness mass)
};

/// A shape, how rough it is and how it moves.
struct ObstacleOptions {
  ShapeOptions shape;               ///< at t = 0
  std::optional<double> friction;   ///< Coulomb's coefficient; none: frictionless
  Motion motion;                    ///< from where the shape says
  std::string name = {};            ///< what results call it; empty: obstacle_0, obstacle_1, ... in order
  std::optional<double> mass = {};  ///< [kg]; none: it is where its motion says
  CouplingOptions coupling = {};    ///< of one with mass
};

}  // namespace plica
