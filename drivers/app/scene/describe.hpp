// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/describe.hpp>
#include <plica/drivers/app/scene/scene.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <type_traits>

/// Tables of the keys that only scenes have. core/describe.hpp has those of the library's options.
/// Together they are all keys of a scene.
namespace plica::app {

using namespace keys;

std::vector<Choice> frame_formats();  ///< file formats of frames
std::vector<Choice> frame_fields();  ///< arrays of frames that are written where they are asked for
std::vector<Choice> precisions();    ///< float and double
std::vector<Choice> mesh_orders();   ///< orders of vertices and tetrahedra in memory
std::vector<Choice> second_orders();  ///< treatments of second-order tetrahedra

/// Number of threads; the maximum is what Kokkos allows with OpenMP.
inline constexpr Count thread_count{1, 512};

/// Kind of a value: an interval in simulated time or in macro steps.
struct Every {
  std::string type_text() const { return "a time (s) > 0, or macro steps such as 10 steps"; }
  std::string to_text(const Interval& value) const { return text_of(value); }
};

/// Kind of a value: a selection of levels.
struct LevelChoice {
  std::string type_text() const {
    return "true (level 0), false, all, or a list of levels counted from 0, the finest";
  }
  std::string to_text(const VolumeLevels& value) const;
};

/// Kind of a value: an optional struct. true: the struct with its defaults; false: none; a map: the
/// struct's values.
struct Switch {
  static constexpr const char* words = "true, false, or a map";
  static constexpr bool takes_optional = true;
};

/// Kind of a value: a list of maps, or one map instead. The struct has a member for each.
struct ListOrMap {
  static constexpr const char* words = "a list of maps, or a map";
};

/// Kind of a value: the word part, for all of a mesh, or a selection of its elements.
struct PartOrSelection {
  static constexpr const char* words = "part, or a map";
  static constexpr bool takes_optional = true;
};

/// Kind of a value: points with names.
struct NamedPoints {
  std::string type_text() const { return "a map of names to lists of 3 lengths (m)"; }
  std::string to_text(const std::map<std::string, Point>&) const { return {}; }
};

template <class V>
void describe(V& v, BoxRecipe& o) {
  v.required("size", o.size, Vector{length, positive}, "edges");
  v.required("cells", o.cells, Counts{1}, "cells along each edge, six tetrahedra in each");
  v("origin", o.origin, Vector{length}, "lowest corner");
}

template <class V>
void describe(V& v, BallRecipe& o) {
  v.required("radius", o.radius, Quantity{length, positive}, "radius");
  v.required("cells", o.cells, Count{1}, "cells across the diameter");
  v("centre", o.centre, Vector{length}, "centre");
}

template <class V>
void describe(V& v, CylinderRecipe& o) {
  v.required("radius", o.radius, Quantity{length, positive}, "radius");
  v.required("length", o.length, Quantity{length, positive}, "height, along z");
  v.required("across", o.across, Count{1}, "cells across the diameter");
  v.required("along", o.along, Count{1}, "cells along the axis");
  v("base", o.base, Vector{length}, "centre of the lower disc");
}

template <class V>
void describe(V& v, BlobRecipe& o) {
  v.required("length", o.length, Quantity{length, positive}, "along x");
  v.required("cells", o.cells, Count{4},
             "cells across, a multiple of 4: faces follow the inclusion");
  v("centre", o.centre, Vector{length}, "centre of the ball that it is shaped from");
}

template <class V>
void describe(V& v, Tube& o) {
  v.required("radius", o.radius, Quantity{length, positive}, "radius of the inside");
  v.required("wall", o.wall, Quantity{length, positive}, "thickness of the wall");
  v.required("length", o.length, Quantity{length, positive},
             "length of the axis, which starts along z");
  v("bend", o.bend, Quantity{angle, not_negative}, "angle that the axis turns by, towards x");
  v.required("around", o.around, Count{3}, "cells around");
  v.required("across", o.across, Count{1}, "cells through the wall");
  v.required("along", o.along, Count{1}, "cells along the axis");
  v("start", o.start, Vector{length}, "centre of the first end");
}

inline constexpr const char* scale_help = "metres per unit of that file: 0.001 for millimetres";
inline constexpr const char* weld_help =
    "points on open edges at most this part of the box's diagonal apart become one, as exporters "
    "leave them at seams; 0: they stay";

template <class V>
void describe(V& v, LevelRecipe& o) {
  v.one_of();
  v.alternative("box", o.box, Group{}, "a box of cells");
  v.alternative("ball", o.ball, Group{}, "a ball");
  v.alternative("cylinder", o.cylinder, Group{}, "a cylinder");
  v.alternative("blob", o.blob, Group{}, "a lump like a liver, with the region inclusion");
  v.alternative("tube", o.tube, Group{}, "a bent pipe with a wall, like a vessel");
  v.alternative("file", o.file, Text{},
                "a mesh file (.msh, .mesh, .vtk, .vtu, .ele, .inp, .feb), relative to the scene");
  v.alternative("coarsen", o.coarsen, AutoCount{fewest_points},
                "no mesh, but a coarse space of the mesh before it, of so many points; auto: as "
                "many spaces as it takes");
  v.alternative("refine", o.refine, Group{},
                "no mesh, but elements of the next level, each cut in eight; the rest of the body "
                "is as there");
  v("covers", o.covers, PartOrSelection{},
    "part: its mesh is one of a part of the body, the rest is as on the next level; a map: "
    "elements of its mesh that are used in this way");
  v("border", o.border, Text{},
    "with covers: group of its mesh that is its border inside the body; left out: what is not near "
    "the next level's skin");
  v("scale", o.scale, Quantity{plain, positive}, scale_help);
  v("merge_duplicates", o.merge_duplicates, Quantity{length, not_negative},
    "vertices of that file at most this far apart, after scaling, become one; left out: they are "
    "reported");
  v("repair", o.repair, Flag{},
    "true: duplicates merged, loose parts dropped, slivers shaped better; what changed is said");
  v("regions", o.regions, Text{},
    "array of that file's cells that numbers the regions, such as MaterialIds; none: no regions; "
    "left out: the file's own groups, or an array with a usual name");
  v("leave_out", o.leave_out, ListOf<Text>{},
    "regions of that file, by name or number, that are no body, such as the air around a "
    "segmented organ");
  v("order", o.order, Name{"order", second_orders}, "of that file's second-order tetrahedra");
}

template <class V>
void describe(V& v, LatticesRecipe& o) {
  v.required("surface", o.surface, Text{},
             "a closed surface (.stl, .obj, .ply, .off, .vtp, .vtk, .msh) or a mesh, relative to "
             "the scene");
  v.required("sizes", o.sizes, ListOf<Quantity>{{length, positive}},
             "of the cells of a lattice each, finest first; elements count for the part of them "
             "that is body");
  v("scale", o.scale, Quantity{plain, positive}, scale_help);
  v("weld", o.weld, Quantity{plain, not_negative}, weld_help);
}

/// Targets of the key `body.levels`: a recipe for each level, or one recipe for all levels.
struct LevelsKeys {
  std::vector<LevelRecipe>& list;
  std::optional<LatticesRecipe>& map;
};

template <class V>
void describe(V& v, BallSurfaceRecipe& o) {
  v.required("radius", o.radius, Quantity{length, positive}, "radius");
  v("subdivisions", o.subdivisions, Count{0},
    "of an icosahedron: 12, 42, 162, 642, 2562 ... points");
  v("centre", o.centre, Vector{length}, "centre; left out: that of level 0's bounding box");
}

template <class V>
void describe(V& v, SurfaceRecipe& o) {
  v.one_of();
  v.alternative("sphere", o.sphere, Group{}, "a triangulated sphere");
  v.alternative("boundary", o.boundary, Flag{}, "true: the boundary of level 0");
  v.alternative("file", o.file, Text{},
                "a surface file (.obj, .stl, .ply, .off, .vtp, .vtk, .vtu, .msh, .mesh), relative "
                "to the scene");
  v("scale", o.scale, Quantity{plain, positive}, scale_help);
  v("weld", o.weld, Quantity{plain, not_negative}, weld_help);
}

/// At least 0, below 0.5.
inline constexpr Bounds below_half{.min = 0, .max = 0.5, .max_excluded = true};

/// Targets of the key `body`: the library's Body and the recipes of its meshes.
struct BodyKeys {
  std::vector<LevelRecipe>& levels;
  std::optional<LatticesRecipe>& lattices;
  double& jitter;
  std::string& order;
  Body& body;
  std::optional<SurfaceRecipe>& surface;
};

template <class V>
void describe(V& v, BodyKeys& o) {
  LevelsKeys levels{o.levels, o.lattices};
  v.required("levels", levels, ListOrMap{},
             "the body's meshes, finest first; or a surface that lattices are laid over");
  v("jitter", o.jitter, Quantity{plain, below_half},
    "vertices of every level are moved at random by up to this part of their shortest edge; its "
    "faces stay");
  v("order", o.order, Name{"order", mesh_orders},
    "of vertices and tetrahedra in memory; output has that of the input");
  describe(v, o.body);
  v("surface", o.surface, Group{},
    "embedded in every level: it touches the obstacles, and frames show it; left out: the boundary "
    "where there are obstacles, else none");
}

inline constexpr const char* body_integration_help =
    "over the scene's; bodies are stepped together, so all that have one must come to the same";

template <class V>
void describe(V& v, BodyRecipe& o) {
  BodyKeys keys{o.levels, o.lattices, o.jitter, o.order, o.body, o.surface};
  describe(v, keys);
  IntegrationOptions integration;  // not stored: shared_integration() reads it from the tree
  v("integration", integration, Group{}, body_integration_help);
}

/// Kind of a value: a map of names to the keys of `body`, and `integration`.
struct BodyMap {
  static constexpr const char* words = "a map of maps, each as body, and with integration";
};

template <class V>
void describe(V& v, ToolRecipe& o) {
  v.required("file", o.file, Text{},
             "a closed surface (.stl, .obj, .ply, .off, .vtp, .vtk, .msh), relative to the scene");
  v("scale", o.scale, Quantity{plain, positive}, scale_help);
  v("weld", o.weld, Quantity{plain, not_negative}, weld_help);
  v("rotation", o.rotation, Vector{angle},
    "about the file's origin: [0, 0, 30 deg] turns it by 30 degrees about z");
  v("position", o.position, Vector{length}, "where that origin is put");
  describe(v, o.options);
}

template <class V>
void describe(V& v, ObstacleRecipe& o) {
  v.one_of();
  ObstacleShapes::for_each([&](auto shape) {
    using Shape = decltype(shape);
    if constexpr (std::is_same_v<Shape, SampledSurface>)
      v.alternative(Shape::name, o.tool, Group{}, Shape::summary);
    else
      v.alternative(Shape::name, as<typename Shape::Options>(o.options.shape), Group{},
                    Shape::summary);
  });
  describe(v, o.options);
}

/// Target of the key `contact`: the library's options and the recipes of the obstacles.
struct ContactKeys {
  Scene& scene;
};

template <class V>
void describe(V& v, ContactKeys& o) {
  v("obstacles", o.scene.obstacles, List{}, "what the body's surface touches");
  describe(v, o.scene.problem.contact);
}

template <class V>
void describe(V& v, OutputOptions& o) {
  v("every", o.every, Every{},
    "between frames and rows of history.csv; left out: duration / 60, of cycle rest 1 step");
  v("volume", o.volume, LevelChoice{},
    "whose tetrahedra are written as well, with stress and volume ratio");
  v("fields", o.fields, ListOf<Name>{{"field", frame_fields}},
    "more arrays in frames, beside von Mises' stress and J");
  v("probes", o.probes, NamedPoints{}, "points of level 0 at rest whose motion goes to probes.csv");
  v("probe_every", o.probe_every, Every{}, "between rows of probes.csv; left out: 1 step");
  v("format", o.format, Name{"format", frame_formats}, "of the frames");
}

/// Visits keys of a variant: those of `integration`, without defaults.
template <class V>
void describe(V& v, StudyVariant& o) {
  describe_stepping(v, o);
}

template <class V>
void describe(V& v, TruthOptions& o) {
  v("refinements", o.refinements, Count{1, 6},
    "of level 0's mesh, each with eight times the tetrahedra; left out: 2, or 1 where that takes "
    "half the budget");
  v("jitter", o.jitter, Quantity{plain, below_half},
    "of a second mesh, whose limit checks the first one's; left out: that of linear elements does");
}

template <class V>
void describe(V& v, StudyOptions& o) {
  v("methods", o.methods, ListOf<Text>{},
    "single, coarse, cycle, or one of them: single/rk4, coarse/1, cycle/rsv, cycle/rsv/equal, with "
    "a variant "
    "cycle/rsv/equal+hybrid; left out: the default set");
  v("variants", o.variants, Map{},
    "what cycles have instead of the scene's integration when they are named with it");
  v("macro_steps", o.macro_steps, ListOf<AutoQuantity>{{{duration, positive}}},
    "of cycles and implicit methods, and of explicit ones those below their limit; left out: "
    "multiples of the finest "
    "limit");
  v("precision", o.precision, ListOf<Name>{{"precision", precisions}}, "in which each method runs");
  v("threads", o.threads, ListOf<Count>{thread_count},
    "with which each method runs; left out: all there are");
  v("elements", o.elements, ListOf<Name>{{"element", elements}},
    "with which each method runs; left out: the body's own, with truth all of them");
  v("truth", o.truth, Switch{}, "errors against the limit of refined meshes, in space and in time");
  v("samples", o.samples, Count{1},
    "times, evenly over the duration, at which states are compared");
  v("timed_runs", o.timed_runs, Count{0},
    "of each row, short ones at least five; 0: the compared one is timed");
  v("growth", o.growth, Flag{},
    "find the growth of small motions by every cycle, linearised about rest");
}

template <class V>
void describe(V& v, Scene& o) {
  v("name", o.name, Text{}, "title; left out: the file's name");
  v.required("duration", o.duration, Quantity{duration, positive}, "simulated time");
  describe(v, o.problem);
  BodyKeys body{o.levels, o.lattices, o.jitter, o.order, o.problem.body, o.surface};
  v.one_of();
  v.alternative("body", body, Group{}, "the deformable body");
  v.alternative("bodies", o.bodies, BodyMap{},
                "several: a name for each, and below it the keys of body");
  v("integration", o.problem.integration, Group{}, "how it is stepped in time");
  ContactKeys contact{o};
  v("contact", contact, Group{}, "what it collides with");
  v("attachments", o.problem.contact.attachments, List{}, "of bodies to each other, by springs");
  v("cuts", o.problem.cuts, List{}, "of the body, by blades, while the run goes on");
  v("output", o.output, Group{}, "what a run writes");
  v("study", o.study, Group{}, "what plica study compares");
}

}  // namespace plica::app
