// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <plica/core/problem.hpp>
#include <plica/drivers/app/scene/tree.hpp>
#include <plica/drivers/app/scene/units.hpp>
#include <plica/drivers/study/study_case.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/files/read_options.hpp>
#include <plica/meshes/organs.hpp>
#include <plica/meshes/reordering.hpp>
#include <string>
#include <string_view>
#include <vector>

/// Contents of a scene file. The physics is the library's Problem. The types here describe what
/// only files have: how the meshes are made, how long the scene runs, and what it writes.
namespace plica::app {

/// Mesh of a box, see box_mesh().
struct BoxRecipe {
  Point size = Point::Ones();            ///< lengths of the edges [m]
  std::array<int, 3> cells = {1, 1, 1};  ///< number of cells along each edge
  Point origin = Point::Zero();          ///< lowest corner [m]
};

/// Mesh of a ball, see ball_mesh().
struct BallRecipe {
  double radius = 1;             ///< radius [m]
  int cells = 1;                 ///< number of cells across the diameter
  Point centre = Point::Zero();  ///< centre [m]
};

/// Mesh of a cylinder whose axis is along z, see cylinder_mesh().
struct CylinderRecipe {
  double radius = 1;           ///< radius [m]
  double length = 1;           ///< height [m]
  int across = 1;              ///< number of cells across the diameter
  int along = 1;               ///< number of cells along the axis
  Point base = Point::Zero();  ///< centre of the lower disc [m]
};

/// Mesh of a lump like a liver, see blob_mesh().
struct BlobRecipe {
  double length = 1;             ///< length along x [m]
  int cells = 4;                 ///< number of cells across, a multiple of 4
  Point centre = Point::Zero();  ///< centre of the ball that it is shaped from [m]
};

/// Lattices over a closed surface, see weighted_lattice().
struct LatticesRecipe {
  std::string surface;          ///< file of the surface, relative to the scene
  double scale = 1;             ///< metres per unit of the file
  std::vector<double> sizes;    ///< cell size of each lattice, finest first [m]
  double weld = weld_distance;  ///< see weld_open_edges(), as a part of the box's diagonal
};

/// Source of a level: a generated mesh, a file, a lattice, or a coarse space of the mesh before it.
struct LevelRecipe {
  std::optional<BoxRecipe> box;
  std::optional<BallRecipe> ball;
  std::optional<CylinderRecipe> cylinder;
  std::optional<BlobRecipe> blob;
  std::optional<Tube> tube;
  /// cell size of a lattice over the surface of Scene::lattices [m]
  std::optional<double> lattice;
  /// number of points of a coarse space; 0: auto, as many spaces as are needed
  std::optional<int> coarsen;
  /// elements of the next coarser level that make this one, each cut in eight
  std::optional<Selection> refine = {};
  std::optional<LevelCover> covers = {};  ///< part of the body that it covers; none: all of it
  std::string border = {};                ///< see LevelCover
  std::string file;                       ///< mesh file, relative to the scene
  double scale = 1;                       ///< metres per unit of the file
  /// distance up to which vertices of the file become one; none: they stay [m]
  std::optional<double> merge_duplicates;
  bool repair = false;                 ///< true: the file's mesh is repaired, see repair_mesh()
  std::string regions;                 ///< array of cells that numbers the regions; see ReadOptions
  std::vector<std::string> leave_out;  ///< regions of the file that are left out
  std::string order = "split";         ///< second-order tetrahedra, one of second_orders()
};

/// Returns whether a level covers a part of the body alone.
inline bool is_part(const LevelRecipe& level) { return level.covers || level.refine; }
/// Returns the number of a body's levels: those that cover a part belong to one that covers all.
inline std::size_t count_levels(const std::vector<LevelRecipe>& levels) {
  return levels.size() - static_cast<std::size_t>(std::ranges::count_if(levels, is_part));
}

/// Triangulated sphere, see sphere_surface().
struct BallSurfaceRecipe {
  double radius = 1;            ///< radius [m]
  int subdivisions = 3;         ///< subdivisions of an icosahedron: 12, 42, 162, 642 ... points
  std::optional<Point> centre;  ///< centre [m]; none: that of level 0's bounding box
};

/// Source of the embedded surface: a sphere, the boundary of level 0, or a file.
struct SurfaceRecipe {
  std::optional<BallSurfaceRecipe> sphere;
  bool boundary = false;        ///< true: the boundary of level 0
  std::string file;             ///< surface file, relative to the scene
  double scale = 1;             ///< metres per unit of the file
  double weld = weld_distance;  ///< see weld_open_edges(), as a part of the box's diagonal
};

/// Rigid obstacle from a file of triangles: scaled, turned about the file's origin, then moved.
struct ToolRecipe {
  std::string file;                ///< surface file, relative to the scene
  double scale = 1;                ///< metres per unit of the file
  Point rotation = Point::Zero();  ///< rotation vector: along the axis, length is the angle [rad]
  Point position = Point::Zero();  ///< position of the file's origin [m]
  double weld = weld_distance;     ///< see weld_open_edges(), as a part of the box's diagonal
  SurfaceOptions options;          ///< options of the obstacle; its surface comes from the file
};

/// Obstacle of a scene.
struct ObstacleRecipe {
  ObstacleOptions options;
  std::optional<ToolRecipe> tool;  ///< source of a shape from a file; none: another shape
};

/// Mapping between a level's mesh and its input. A mesh may be put in an order that is faster to
/// simulate, see mesh_orders(); output for users has the order and the numbers of the file.
struct Numbering {
  /// number in the mesh of each vertex and tetrahedron of the input; empty: equal
  Reordering input;
  std::vector<int> vertex_ids;  ///< number in the file of each vertex; empty: equal, from 0
  std::vector<int> tet_ids;     ///< number in the file of each tetrahedron; empty: equal, from 0
};

/// Returns the number in the file of vertex or tetrahedron `index`. It stays where the file has
/// none: -1, and vertices that a cut has added.
inline int input_number(const std::vector<int>& ids, int index) {
  return index < 0 || index >= static_cast<int>(ids.size()) ? index
                                                            : ids[static_cast<std::size_t>(index)];
}

/// Returns values per vertex or tetrahedron in the order of the input.
template <class Value>
std::vector<Value> in_input_order(const std::vector<Value>& values, const std::vector<int>& order) {
  return order.empty() ? values : permuted(values, order);
}

/// Returns the values in the order of the input, `components` of each vertex or tetrahedron.
inline std::vector<double> in_input_order(const std::vector<double>& values,
                                          const std::vector<int>& order, int components) {
  if (order.empty() || values.empty()) return values;
  std::vector<double> result;
  for (const int old : order)
    result.insert(result.end(), values.begin() + components * old,
                  values.begin() + components * (old + 1));
  return result;
}

/// Returns the mesh in the order of the input.
inline TetMesh in_input_order(const TetMesh& mesh, const Numbering& numbering) {
  return numbering.input.vertices.empty() ? mesh : reordered(mesh, numbering.input);
}

/// Choice of the levels whose tetrahedra are written.
struct VolumeLevels {
  bool all = false;         ///< true: every level in use
  std::vector<int> levels;  ///< numbers of the levels if not `all`; 0: the finest
};

/// One entry of the key `bodies`; the members are those of Scene.
struct BodyRecipe {
  std::vector<LevelRecipe> levels;
  std::optional<LatticesRecipe> lattices;
  double jitter = 0;
  std::string order = "auto";
  Body body;
  std::optional<SurfaceRecipe> surface;
};

/// Names of those of frame_fields() that are on the surface. The others are of tetrahedra.
inline constexpr const char* contact_pressure_field = "contact_pressure";
inline constexpr const char* normals_field = "normals";
inline constexpr const char* texture_field = "texture_coordinates";
inline bool is_of_surface(std::string_view field) {
  return field == contact_pressure_field || field == normals_field || field == texture_field;
}

/// Files that a run writes.
struct OutputOptions {
  std::optional<Interval> every;  ///< interval of frames; none: a sixtieth of the duration
  VolumeLevels volume;
  std::vector<std::string> fields;      ///< more arrays of the frames, of frame_fields()
  std::map<std::string, Point> probes;  ///< points of level 0 at rest, by name [m]
  std::optional<Interval> probe_every;  ///< interval of rows; none: every macro step
  std::string format = "vtu";

  bool writes(std::string_view field) const {
    return std::ranges::find(fields, field) != fields.end();
  }
  /// Returns true if a field of tetrahedra is asked for.
  bool writes_tensors() const {
    return std::ranges::any_of(fields, [](const auto& f) { return !is_of_surface(f); });
  }
};

/// Scene: a problem, where its meshes come from, and what a run or a study of it does.
struct Scene {
  std::string file;                  ///< path of the scene
  std::string name;                  ///< title; not given: the name of the file
  double duration = 0;               ///< simulated time [s]
  Problem problem;                   ///< the physics; complete after the meshes are built
  std::vector<Numbering> numbering;  ///< numbering of each mesh
  /// warnings about the scene and its files, one sentence each
  std::vector<std::string> warnings;
  std::optional<LatticesRecipe> lattices;  ///< source of the levels, if they are lattices
  std::vector<LevelRecipe> levels;         ///< source of each level, finest first
  double jitter = 0;                       ///< random displacement of vertices, see jittered()
  std::string order = "auto";              ///< order of the meshes, one of mesh_orders()
  std::optional<SurfaceRecipe> surface;    ///< source of the embedded surface
  /// several bodies by name, instead of `body`; they are joined to one body of several parts
  std::map<std::string, BodyRecipe> bodies;
  std::vector<ObstacleRecipe> obstacles;
  OutputOptions output;
  StudyOptions study;  ///< options of a study; its duration is the scene's
  Tree source;         ///< text of the scene with locations, with the changes of the command line
};

}  // namespace plica::app
