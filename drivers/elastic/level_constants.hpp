// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/problem.hpp>
#include <plica/drivers/body/supports.hpp>
#include <plica/drivers/elastic/elements.hpp>
#include <plica/drivers/elastic/fibres.hpp>
#include <plica/drivers/elastic/viscosity.hpp>
#include <vector>

namespace plica {

/// Constants of a level, computed on the host, that several parts of the set-up need.
struct LevelConstants {
  /// constants of the material per region; one entry where the mesh names no region
  std::vector<std::vector<double>> material;
  /// constants per region with lambda at most 2 mu, if the material has a lambda of its own
  std::vector<std::vector<double>> capped;
  std::vector<Lame<double>> lame;  ///< per region, of small strains [Pa]
  ShapeConstants shape;            ///< parts of the elements' constants; only for viscous materials
  /// directions per tetrahedron; empty: they do not vary within a region
  std::vector<FibreAxes> fibres;
  std::vector<FibreAxes> families;    ///< per region, see family_components(); only with `fibres`
  Element element = Element::linear;  ///< kind of elements of this level
  std::vector<double> density;        ///< per region [kg/m^3]
  /// per vertex [1/s]; one entry where it is the same everywhere
  std::vector<double> mass_damping;
  std::vector<double> stiffness_damping;  ///< per region [s]; empty where there is none
  /// per vertex [kg], see lumped_masses()
  std::vector<double> mass;
  std::vector<char> constrained;       ///< per vertex: all of its motion is given
  std::vector<SlidingVertex> sliding;  ///< vertices that are held in part
  std::vector<HeldSet> held;           ///< entries of body.fixed, then those of body.prescribed
  /// [body.prescribed] points that sets turn about, in the placed body; see build_hierarchy() [m]
  std::vector<Point> turned_about;
  std::vector<int> prescribed_vertex;  ///< vertices that follow a given motion
  std::vector<int> prescribed_motion;  ///< index of the body's motion that each of these follows
  /// velocity per free vertex at the start of level 0; 0 on other levels [m/s]
  std::vector<Point> velocity;
};

/// Returns the constants of a level. `mesh` is at rest, before it is placed. `middle`: point that
/// the initial angular velocity is about [m]. Throws InputError where a selection chooses nothing
/// on this level.
LevelConstants level_constants(const Body& body, const TetMesh& mesh, const Point& middle,
                               int level);

}  // namespace plica
