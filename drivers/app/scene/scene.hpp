// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <map>
#include <optional>
#include <plica/core/problem.hpp>
#include <plica/drivers/app/scene/tree.hpp>
#include <plica/drivers/app/scene/units.hpp>
#include <plica/drivers/study/study_case.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/organs.hpp>
#include <plica/meshes/reordering.hpp>
#include <string>
#include <vector>

/// What a scene file says. The physics is the library's Problem; here is what only files have: how
/// its meshes come about, how long it runs and what it writes.
namespace plica::app {

struct BoxRecipe {
  Point size = Point::Ones();            ///< [m]
  std::array<int, 3> cells = {1, 1, 1};  ///< along each edge
  Point origin = Point::Zero();          ///< its lowest corner [m]
};

struct BallRecipe {
  double radius = 1;             ///< [m]
  int cells = 1;                 ///< across the diameter
  Point centre = Point::Zero();  ///< [m]
};

/// Stands on its base and rises along z.
struct CylinderRecipe {
  double radius = 1;           ///< [m]
  double length = 1;           ///< [m]
  int across = 1;              ///< cells across the diameter
  int along = 1;               ///< cells along the axis
  Point base = Point::Zero();  ///< centre of the lower disc [m]
};

/// See blob_mesh().
struct BlobRecipe {
  double length = 1;             ///< along x [m]
  int cells = 4;                 ///< across, a multiple of 4
  Point centre = Point::Zero();  ///< [m]
};

/// Lattices over a closed surface, see weighted_lattice().
struct LatticesRecipe {
  std::string surface;        ///< a file, relative to the scene
  double scale = 1;           ///< metres per unit of the file
  std::vector<double> sizes;  ///< of their cells, finest first [m]
};

/// One of them, a file, a lattice, or a coarse space of the mesh before.
struct LevelRecipe {
  std::optional<BoxRecipe> box;
  std::optional<BallRecipe> ball;
  std::optional<CylinderRecipe> cylinder;
  std::optional<BlobRecipe> blob;
  std::optional<Tube> tube;
  std::optional<double> lattice;  ///< its cells' size, over Scene::lattices' surface [m]
  std::optional<int> coarsen;     ///< its points; 0: auto, as many spaces as it takes
  std::string file;               ///< relative to the scene
  double scale = 1;               ///< metres per unit of the file
  /// of the file's vertices those this close become one [m]
  std::optional<double> merge_duplicates;
  bool repair = false;  ///< the file's mesh is repaired: see repair_mesh()
};

struct BallSurfaceRecipe {
  double radius = 1;            ///< [m]
  int subdivisions = 3;         ///< of an icosahedron: 12, 42, 162, 642 ... points
  std::optional<Point> centre;  ///< none: the centre of level 0's bounding box [m]
};

/// One of them.
struct SurfaceRecipe {
  std::optional<BallSurfaceRecipe> sphere;
  bool boundary = false;  ///< the boundary of level 0
  std::string file;       ///< relative to the scene
  double scale = 1;       ///< metres per unit of the file
};

/// A rigid solid of a file of triangles: scaled, turned about the file's origin, then moved.
struct ToolRecipe {
  std::string file;                ///< relative to the scene
  double scale = 1;                ///< metres per unit of the file
  Point rotation = Point::Zero();  ///< its direction is the axis, its length the angle [rad]
  Point position = Point::Zero();  ///< of the file's origin [m]
  SurfaceOptions options;          ///< but for its surface, which is the file's
};

struct ObstacleRecipe {
  ObstacleOptions options;
  std::optional<ToolRecipe> tool;  ///< where the shape comes from a file
};

/// How a level's mesh is numbered where it comes from. What is read from a file is put in an order
/// that is faster to simulate; whatever people see has the file's order and numbers.
struct Numbering {
  Reordering input;             ///< per place in the input its number here; empty: the same
  std::vector<int> vertex_ids;  ///< per vertex here its number in the file; empty: the same, from 0
  std::vector<int> tet_ids;     ///< per tetrahedron, likewise
};

/// The number in the input of vertex or tetrahedron `index`; -1 stays -1.
inline int input_number(const std::vector<int>& ids, int index) {
  return index < 0 || ids.empty() ? index : ids[static_cast<std::size_t>(index)];
}

/// Values per vertex or tetrahedron in the order of the input.
template <class Value>
std::vector<Value> in_input_order(const std::vector<Value>& values, const std::vector<int>& order) {
  return order.empty() ? values : permuted(values, order);
}

/// The mesh as the input has it.
inline TetMesh in_input_order(const TetMesh& mesh, const Numbering& numbering) {
  return numbering.input.vertices.empty() ? mesh : reordered(mesh, numbering.input);
}

/// Levels whose tetrahedra are written.
struct VolumeLevels {
  bool all = false;         ///< every level in use
  std::vector<int> levels;  ///< else these, 0: the finest
};

/// One of `bodies`.
struct BodyRecipe {
  std::vector<LevelRecipe> levels;
  std::optional<LatticesRecipe> lattices;
  double jitter = 0;
  Body body;
  std::optional<SurfaceRecipe> surface;
};

struct OutputOptions {
  std::optional<Interval> every;  ///< between frames; none: a sixtieth of the duration
  VolumeLevels volume;
  std::map<std::string, Point> probes;  ///< points of the body at rest, in level 0 [m]
  std::optional<Interval> probe_every;  ///< none: every macro step
  std::string format = "vtu";
};

struct Scene {
  std::string file;
  std::string name;                  ///< none given: the file's
  double duration = 0;               ///< [s]
  Problem problem;                   ///< complete once its meshes are built
  std::vector<Numbering> numbering;  ///< of each of these meshes
  /// about what was found in it and its files, a sentence each
  std::vector<std::string> warnings;
  std::optional<LatticesRecipe> lattices;  ///< what the levels are, if they are lattices
  std::vector<LevelRecipe> levels;
  double jitter = 0;  ///< of every level: see jittered()
  std::optional<SurfaceRecipe> surface;
  /// instead of the five above; what they make is one body of several parts
  std::map<std::string, BodyRecipe> bodies;
  std::vector<ObstacleRecipe> obstacles;
  OutputOptions output;
  StudyOptions study;  ///< but for its duration, which is the scene's
  Tree source;         ///< where what was said, with what the command line changed
};

}  // namespace plica::app
