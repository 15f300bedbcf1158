// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstddef>
#include <cstdint>
#include <plica/core/mesh.hpp>
#include <string>
#include <vector>

/// Reports of a simulation: its parts, the decisions for each level, energies, forces, and why a
/// run cannot go on.
namespace plica {

/// A part that a scene may or may not need: in or out, why, and the device memory it takes.
struct Part {
  std::string name;       ///< name, as `plica explain` prints it
  bool in = false;        ///< whether the simulation has it
  std::string reason;     ///< why, or why not
  std::size_t bytes = 0;  ///< size on the device
};

/// An element that by itself would limit explicit steps.
struct StiffElement {
  int element = -1;    ///< number in the level's mesh
  std::string region;  ///< region of the element; empty: nameless
  /// Longest edge over smallest height; 1.22 for a regular tetrahedron
  double height_ratio = 0;
  double step = 0;  ///< critical step 2/w of the element alone [s]
};

/// Kind of a level.
enum class LevelKind {
  mesh,     ///< tetrahedra
  lattice,  ///< tetrahedra that the body fills in part
  space,    ///< motions of the finest mesh, without elements
  slivers,  ///< space in which only the vertices of slivers follow others
  part      ///< tetrahedra of a finer mesh in a part of the body and of coarser ones elsewhere
};

/// A piece of a level of kind `part`: its share of one of the meshes, see TetMesh::piece.
struct PieceReport {
  int tets = 0;             ///< tetrahedra
  int followers = 0;        ///< vertices that follow a coarser piece
  int cut = 0;              ///< tetrahedra that count in part, since a finer piece covers the rest
  int dropped = 0;          ///< tetrahedra that are left out, since finer pieces cover them
  double mass = 0;          ///< mass that is not covered by finer pieces [kg]
  double covered = 0;       ///< volume that finer pieces cover [m^3]
  double least_filled = 1;  ///< smallest part of a tetrahedron that counts
};

/// Decisions for one level.
struct LevelReport {
  LevelKind kind = LevelKind::mesh;  ///< kind of the level
  int vertices = 0;                  ///< vertices of its mesh; points of a coarse space
  int tets = 0;                      ///< tetrahedra of its mesh; a coarse space has none
  double filled = 1;                 ///< part of its volume that is body
  std::vector<PieceReport> pieces;   ///< finest first, of a level of kind `part`
  /// Weights per row of the interpolation to the next finer level, for a coarse space
  double nonzeros = 0;
  double mean_edge = 0;  ///< [m]
  double mass = 0;       ///< [kg]
  /// Largest stable explicit step of its integrator [s]. Contact does not bound it. An implicit
  /// level has that of symplectic_euler, a level that is not integrated 0
  double critical_step = 0;
  /// Lower bound of critical_step without damping, from the worst element [s]
  double element_bound = 0;
  double typical_element = 0;          ///< median of all elements' own critical steps [s]
  std::vector<StiffElement> stiffest;  ///< ten worst elements, the worst first
  /// Share of the macro step; 0 where it is not integrated (coarser levels of cycle him)
  double share = 0;
  /// Factor by which motion is too heavy that only this level represents, in cycle him
  double inertia = 1;
  /// Largest stable step of that motion by itself, in cycle him [s]
  double detail_step = 0;
  int substeps = 0;        ///< sub-steps in its share
  std::string element;     ///< linear or nodal
  std::string integrator;  ///< name of its integrator
  /// Solver, preconditioner and matrix of an implicit integrator
  std::string linear_solver;
  bool explicit_integrator = true;  ///< whether critical_step limits its sub-steps
  int outside_down = 0;             ///< vertices of its mesh outside the next finer mesh
  int outside_up = 0;               ///< vertices of the next finer level outside its mesh
  /// Vertices that have none of the next finer level in their elements (cycle fas)
  int massless = 0;
  /// Largest distance of vertices outside the other mesh, over the local edge length
  double largest_miss = 0;
};

/// Distance of the cycle `him` from its limit at rest.
struct HimReport {
  double product = 0;  ///< t^2 times the largest eigenvalue of A K; below 4 is stable
  /// Upper bound of the product, from each level's own eigenvalue
  double bound = 0;
  int coarsest = 0;        ///< vertices of the coarsest level; of several bodies the fewest
  bool all_modes = false;  ///< whether each mode of the coarsest level has its own frequency
  /// Automatic step before the halvings that the fit needed [s]; 0: the step was given
  double usual_step = 0;
};

/// Energies of level 0.
struct Energies {
  double kinetic = 0;    ///< energy of motion [J]
  double elastic = 0;    ///< energy of deformation [J]
  double potential = 0;  ///< energy of gravity, zero at the start [J]
  double contact = 0;    ///< energy of the penalties [J]
  /// Returns the sum of these energies [J].
  double total() const { return kinetic + elastic + potential + contact; }
};

/// Mean force and torque on the body over the last macro step, from one obstacle. With several
/// bodies, also those on one body from all the others. The force on the obstacle is the negative.
struct Wrench {
  std::string obstacle;         ///< name of the obstacle or of the body, see wrench_names()
  Point force = Point::Zero();  ///< force on the body [N]
  /// Torque about the obstacle's origin, which moves with it, or about the scene's [N m]
  Point torque = Point::Zero();
};

/// Force and moment by which an entry of body.fixed or body.prescribed acts on the body now: those
/// that hold its vertices, or move them as given. What holds the body from outside feels the
/// opposite.
struct Reaction {
  std::string set;               ///< name of the entry, see held_names()
  Point force = Point::Zero();   ///< [N]
  Point torque = Point::Zero();  ///< moment about `about` [N m]
  /// Centre of the set's bounding box at rest on level 0, or the point that it turns about [m]
  Point about = Point::Zero();
};

/// Pose and velocity of an obstacle with mass.
struct ToolState {
  std::string obstacle;  ///< name of the obstacle
  /// Displacement of its centre of mass, from where its shape says [m]
  Point displacement = Point::Zero();
  Point velocity = Point::Zero();  ///< [m/s]
  bool turns = false;              ///< whether it has inertia
  /// Rotation: its direction is the axis, its length the angle, at most pi [rad]
  Point rotation = Point::Zero();
  Point angular_velocity = Point::Zero();  ///< [rad/s]
};

/// Surface points that an obstacle has grasped.
struct HeldBy {
  std::string obstacle;     ///< name of the obstacle
  std::vector<int> points;  ///< points of the embedded surface
};

/// Reason why a run cannot go on. Indices count from 0 in the input mesh, -1: does not apply.
struct Diagnosis {
  /// Kind: non_finite | inverted | energy | speed | contact | solver | stability | cut
  std::string kind;
  int level = -1;      ///< 0: the finest
  int element = -1;    ///< tetrahedron of that level
  int vertex = -1;     ///< vertex of that level
  std::string region;  ///< region of the element; empty: nameless
  double J = 0;        ///< volume ratio of the element
  /// Sub-step of that level over its critical step
  double substep_over_critical = 0;
  /// Maximum motion of a vertex of level 0 in a sub-step, against the body, over its edge
  double motion_over_edge = 0;
  std::string reason;        ///< details in words, such as those of a solver
  std::string remedy;        ///< remedy that is most likely to help
  std::string text() const;  ///< returns one sentence with all of it
};

/// Shares of several ranks in a body, and the messages between them.
struct RankReport {
  int count = 1;              ///< number of ranks
  double imbalance = 1;       ///< largest number of elements of a rank over the mean
  std::int64_t messages = 0;  ///< messages of all ranks so far
  std::int64_t bytes = 0;     ///< size of these
  double waited = 0;          ///< time that a rank has waited for others, mean [s]
  double most_waited = 0;     ///< time that a rank has waited for others, maximum [s]
};

/// Outcome of a cut, or of all cuts of a simulation so far.
struct CutReport {
  int opened_faces = 0;  ///< number of faces between tetrahedra that have opened
  int new_vertices = 0;  ///< number of vertices that are new where others have split
  int pieces = 1;        ///< number of pieces of the body, which share no vertex
  double seconds = 0;    ///< wall time of the cut [s]
};

/// Outcome of a part of the body that follows an obstacle, so far.
struct FollowReport {
  long moves = 0;      ///< number of times that the part was made anew
  double seconds = 0;  ///< wall time of that [s]
};

/// Snapshot of what a simulation carries from one macro step to the next. Only Simulation reads its
/// bytes.
struct SavedState {
  std::vector<unsigned char> bytes;  ///< content, to be kept as it is
};

/// Values per tetrahedron of a level with linear elements, per vertex with nodal ones; in input
/// order.
struct ElementFields {
  bool per_vertex = false;  ///< whether per vertex, else per tetrahedron

  std::vector<double> von_mises;  ///< equivalent stress of the Cauchy stress [Pa]
  std::vector<double> J;          ///< volume ratio

  // Empty unless they are asked for:

  /// [rows][6] Cauchy stress xx yy zz xy yz xz, without that of damping [Pa]
  std::vector<double> stress = {};
  std::vector<double> pressure = {};             ///< minus a third of the stress's trace [Pa]
  std::vector<double> principal_stretches = {};  ///< [rows][3] the largest first
};

}  // namespace plica
