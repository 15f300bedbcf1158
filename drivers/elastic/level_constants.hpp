// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/problem.hpp>
#include <plica/drivers/elastic/elements.hpp>
#include <plica/drivers/elastic/fibres.hpp>
#include <plica/drivers/elastic/viscosity.hpp>
#include <vector>

namespace plica {

/// What a level's set-up works out on the host and other parts of the set-up need too.
struct LevelConstants {
  /// per region, its constants; one entry where the mesh names none
  std::vector<std::vector<double>> material;
  /// likewise with lambda at most 2 mu, where the material has it
  std::vector<std::vector<double>> capped;
  std::vector<Lame<double>> lame;  ///< per region, of small strains [Pa]
  ShapeConstants shape;            ///< of viscous materials: of the elements' constants
  /// per tetrahedron, where they are not the same everywhere in a region
  std::vector<FibreAxes> fibres;
  Element element = Element::linear;  ///< of this level
  std::vector<double> density;        ///< per region [kg/m^3]
  /// per vertex [1/s]; one entry where it is the same everywhere
  std::vector<double> mass_damping;
  std::vector<double> stiffness_damping;  ///< per region [s]; empty where there is none
  /// per vertex [kg], a quarter of each of its tetrahedra
  std::vector<double> mass;
  std::vector<char> constrained;       ///< per vertex: its motion is given
  std::vector<int> prescribed_vertex;  ///< those of them that may move
  std::vector<int> prescribed_motion;  ///< which of the body's motions each of them follows
  /// per vertex, where it is free: at the start, level 0 [m/s]
  std::vector<Point> velocity;
};

/// `mesh` at rest, before it is placed; `middle` is the point its angular velocity is about. Throws
/// InputError where a selection chooses nothing on this level.
LevelConstants level_constants(const Body& body, const TetMesh& mesh, const Point& middle,
                               int level);

}  // namespace plica
