// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstddef>
#include <plica/core/mesh.hpp>
#include <string>
#include <vector>

/// What a simulation tells of itself: what it is made of, what was decided for each level,
/// energies, forces, and why a run cannot go on.
namespace plica {

/// A part that a scene may or may not need: in or out, why, and the device memory it takes.
struct Part {
  std::string name;       ///< as `plica explain` prints it
  bool in = false;        ///< whether the simulation has it
  std::string reason;     ///< why, or why not
  std::size_t bytes = 0;  ///< on the device
};

/// An element that by itself would limit explicit steps.
struct StiffElement {
  int element = -1;    ///< in the level's mesh
  std::string region;  ///< its own; empty: nameless
  /// its longest edge over its smallest height; of a regular tetrahedron 1.22
  double height_ratio = 0;
  double step = 0;  ///< 2/w of it alone [s]
};

/// What a level is.
enum class LevelKind {
  mesh,     ///< tetrahedra
  lattice,  ///< tetrahedra that the body fills in part
  space,    ///< motions of the finest mesh, without elements
  slivers   ///< such a space, in which only the vertices of slivers follow others
};

/// What was decided for one level.
struct LevelReport {
  LevelKind kind = LevelKind::mesh;  ///< what it is made of
  int vertices = 0;                  ///< of its mesh; points of a coarse space
  int tets = 0;                      ///< of its mesh; a coarse space has none
  double filled = 1;                 ///< the body's part of its volume
  /// of a coarse space: weights per row of its interpolation to the next finer level
  double nonzeros = 0;
  double mean_edge = 0;  ///< [m]
  double mass = 0;       ///< [kg]
  double critical_step =
      0;  ///< largest stable explicit step of its integrator; contact does not bound it (implicit:
          ///< of symplectic_euler); 0 where it is not integrated [s]
  /// lower bound of critical_step without damping, from the worst element [s]
  double element_bound = 0;
  double typical_element = 0;          ///< the median of that over all elements [s]
  std::vector<StiffElement> stiffest;  ///< the ten worst of its elements, the worst first
  /// of the macro step; 0 where it is not integrated (coarser levels of cycle him)
  double share = 0;
  /// cycle him: how many times too heavy motion is that only this level represents
  double inertia = 1;
  double detail_step = 0;           ///< cycle him: largest stable step of that motion by itself [s]
  int substeps = 0;                 ///< in its share
  std::string element;              ///< linear or nodal
  std::string integrator;           ///< its name
  std::string linear_solver;        ///< of an implicit integrator: solver, preconditioner, matrix
  bool explicit_integrator = true;  ///< whether critical_step limits its sub-steps
  int outside_down = 0;             ///< its vertices outside the next finer mesh
  int outside_up = 0;               ///< the next finer level's vertices outside its mesh
  /// its vertices without one of the next finer level in their elements (cycle fas)
  int massless = 0;
  double largest_miss = 0;  ///< their largest distance over the local edge length
};

/// How far the cycle `him` is from its limit at rest.
struct HimReport {
  double product = 0;      ///< t^2 times the largest eigenvalue of A K; below 4 is stable
  double bound = 0;        ///< of that, from each level's own eigenvalue: never less
  int coarsest = 0;        ///< vertices of the coarsest level; of several bodies the fewest
  bool all_modes = false;  ///< whether each of its modes has its own frequency
  /// the automatic step before halvings that the fit needed; 0: the step was given [s]
  double usual_step = 0;
};

/// Energies of level 0.
struct Energies {
  double kinetic = 0;    ///< of motion [J]
  double elastic = 0;    ///< of deformation [J]
  double potential = 0;  ///< gravity's, zero at the start [J]
  double contact = 0;    ///< of the penalties [J]
  /// Their sum [J].
  double total() const { return kinetic + elastic + potential + contact; }
};

/// What an obstacle does to the body, or to one of several bodies all the others. The mean force on
/// the body over the last macro step. The force on the obstacle is the negative.
struct Wrench {
  std::string obstacle;         ///< its name, or that of the body, see wrench_names()
  Point force = Point::Zero();  ///< on the body [N]
  /// about the obstacle's origin, which moves with it, or about the scene's [N m]
  Point torque = Point::Zero();
};

/// Where an obstacle with mass is.
struct ToolState {
  std::string obstacle;                ///< its name
  Point displacement = Point::Zero();  ///< of its centre of mass, from where its shape says [m]
  Point velocity = Point::Zero();      ///< [m/s]
  bool turns = false;                  ///< it has inertia
  /// its direction is the axis, its length the angle, at most pi [rad]
  Point rotation = Point::Zero();
  Point angular_velocity = Point::Zero();  ///< [rad/s]
};

/// What an obstacle that can take hold of points holds.
struct HeldBy {
  std::string obstacle;     ///< its name
  std::vector<int> points;  ///< of the embedded surface
};

/// Why a run cannot go on. Indices count from 0 in the input mesh, -1: does not apply.
struct Diagnosis {
  /// non_finite | inverted | energy | speed | contact | solver | stability
  std::string kind;
  int level = -1;                    ///< 0: the finest
  int element = -1;                  ///< tetrahedron of that level
  int vertex = -1;                   ///< vertex of that level
  std::string region;                ///< of the element; empty: nameless
  double J = 0;                      ///< volume ratio of the element
  double substep_over_critical = 0;  ///< of that level
  double motion_over_edge = 0;       ///< the furthest that a vertex of level 0 came in a sub-step,
                                     ///< against the body, over its edge
  std::string reason;                ///< of a solver: its own words
  std::string remedy;                ///< most likely to help
  std::string text() const;          ///< one sentence with all of it
};

/// What a simulation carries from one macro step to the next, in bytes that only Simulation reads.
struct SavedState {
  std::vector<unsigned char> bytes;  ///< to be kept as they are
};

/// Of a level with linear elements per tetrahedron, with nodal ones per vertex; in input order.
struct ElementFields {
  bool per_vertex = false;  ///< else per tetrahedron

  std::vector<double> von_mises;  ///< equivalent stress of the Cauchy stress [Pa]
  std::vector<double> J;          ///< volume ratio
};

}  // namespace plica
