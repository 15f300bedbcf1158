// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <map>
#include <optional>
#include <plica/core/problem.hpp>
#include <plica/drivers/app/scene/interval.hpp>
#include <plica/drivers/app/scene/numbering.hpp>
#include <plica/drivers/app/scene/tree.hpp>
#include <plica/drivers/study/study_case.hpp>
#include <string>
#include <vector>

/// What a scene file says. The physics is the library's Problem; here is what only files have: how its meshes come
/// about, how long it runs and what it writes.
namespace plica::app {

struct BoxRecipe {
  Point size = Point::Ones();            ///< [m] > 0
  std::array<int, 3> cells = {1, 1, 1};  ///< >= 1
  Point origin = Point::Zero();          ///< its lowest corner [m]
};

struct BallRecipe {
  double radius = 1;             ///< [m] > 0
  int cells = 1;                 ///< across the diameter
  Point centre = Point::Zero();  ///< [m]
};

/// Stands on its base and rises along z.
struct CylinderRecipe {
  double radius = 1;           ///< [m] > 0
  double length = 1;           ///< [m] > 0
  int across = 1;              ///< cells across the diameter
  int along = 1;               ///< cells along the axis
  Point base = Point::Zero();  ///< centre of the lower disc [m]
};

/// One of them, or a file.
struct LevelRecipe {
  std::optional<BoxRecipe> box;
  std::optional<BallRecipe> ball;
  std::optional<CylinderRecipe> cylinder;
  std::string file;                        ///< relative to the scene
  double scale = 1;                        ///< metres per unit of the file > 0
  std::optional<double> merge_duplicates;  ///< of the file's vertices those this close become one [m] >= 0
};

struct BallSurfaceRecipe {
  double radius = 1;            ///< [m] > 0
  int subdivisions = 3;         ///< of an icosahedron: 12, 42, 162, 642 ... points
  std::optional<Point> centre;  ///< none: the centre of level 0's bounding box [m]
};

/// One of them.
struct SurfaceRecipe {
  std::optional<BallSurfaceRecipe> sphere;
  bool boundary = false;  ///< the boundary of level 0
  std::string file;       ///< relative to the scene
  double scale = 1;       ///< metres per unit of the file > 0
};

/// A rigid solid of a file of triangles: scaled, turned about the file's origin, then moved.
struct ToolRecipe {
  std::string file;                ///< relative to the scene
  double scale = 1;                ///< metres per unit of the file > 0
  Point rotation = Point::Zero();  ///< its direction is the axis, its length the angle [rad]
  Point position = Point::Zero();  ///< of the file's origin [m]
  int cells = 0;                   ///< see SurfaceOptions
};

struct ObstacleRecipe {
  ObstacleOptions options;
  std::optional<ToolRecipe> tool;  ///< where the shape comes from a file
};

/// Levels whose tetrahedra are written.
struct VolumeLevels {
  bool all = false;         ///< every level in use
  std::vector<int> levels;  ///< else these, 0: the finest
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
  std::string name;                   ///< none given: the file's
  double duration = 0;                ///< [s] > 0
  Problem problem;                    ///< complete once its meshes are built
  std::vector<Numbering> numbering;   ///< of each of these meshes
  std::vector<std::string> warnings;  ///< about what was found in it and its files, a sentence each
  std::vector<LevelRecipe> levels;
  std::optional<SurfaceRecipe> surface;
  std::vector<ObstacleRecipe> obstacles;
  OutputOptions output;
  StudyOptions study;  ///< but for its duration, which is the scene's
  Tree source;         ///< where what was said, with what the command line changed
};

}  // namespace plica::app
