// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/app/scene/describe_integration.hpp>
#include <plica/drivers/app/scene/scene.hpp>

/// Every key of a scene, once: its name, where it goes, what it may be, and what it means. A visitor walks these
/// tables to read a scene (reader.hpp) or to print the keys (key_list.hpp). `required` keys have no default; of the
/// `alternative` keys after one_of() exactly one is given, after at_most_one() one or none.
namespace plica::app {

std::vector<Choice> frame_formats();
std::vector<Choice> precisions();

template <class V>
void describe(V& v, Box& o) {
  v.required("min", o.min, Vector{length}, "lowest corner");
  v.required("max", o.max, Vector{length}, "highest corner");
}

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
void describe(V& v, LevelRecipe& o) {
  v.one_of();
  v.alternative("box", o.box, BoxRecipe{}, "a box of cells");
  v.alternative("ball", o.ball, BallRecipe{}, "a ball");
  v.alternative("cylinder", o.cylinder, CylinderRecipe{}, "a cylinder");
  v.alternative_value("file", o.file, Text{}, "a mesh file (.msh, .vtk, .vtu, .ele), relative to the scene");
  v("scale", o.scale, Quantity{number, positive}, "metres per unit of that file: 0.001 for millimetres");
  v("merge_duplicates", o.merge_duplicates, Quantity{length, not_negative},
    "vertices of that file at most this far apart, after scaling, become one; left out: they are reported");
}

template <class V>
void describe(V& v, BallSurfaceRecipe& o) {
  v.required("radius", o.radius, Quantity{length, positive}, "radius");
  v("subdivisions", o.subdivisions, Count{0}, "of an icosahedron: 12, 42, 162, 642, 2562 ... points");
  v("centre", o.centre, Vector{length}, "centre; left out: that of level 0's bounding box");
}

template <class V>
void describe(V& v, SurfaceRecipe& o) {
  v.one_of();
  v.alternative("sphere", o.sphere, BallSurfaceRecipe{}, "a triangulated sphere");
  v.alternative_value("boundary", o.boundary, Flag{}, "true: the boundary of level 0");
  v.alternative_value("file", o.file, Text{}, "a surface file (.obj, .stl, .msh), relative to the scene");
  v("scale", o.scale, Quantity{number, positive}, "metres per unit of that file: 0.001 for millimetres");
}

template <class V>
void describe(V& v, MaterialOptions& o) {
  v("model", o.model, Name{"material", materials}, "constitutive law");
  v("young_modulus", o.young_modulus, Quantity{pressure, positive}, "stiffness E");
  v("poisson_ratio", o.poisson_ratio, Quantity{number, {.min = 0, .max = 0.5, .max_excluded = true}},
    "lateral contraction nu; close to 0.5 linear tetrahedra are too stiff");
  v("density", o.density, Quantity{density, positive}, "mass per volume at rest");
  v("allow_inversion", o.allow_inversion, Flag{}, "false: inverted elements end the run; left out: by the material");
}

template <class V>
void describe(V& v, BallSelection& o) {
  v("centre", o.centre, Vector{length}, "centre");
  v.required("radius", o.radius, Quantity{length, positive}, "radius");
}

template <class V>
void describe(V& v, HalfSpaceSelection& o) {
  v("point", o.point, Vector{length}, "on the plane");
  v("normal", o.normal, Vector{number}, "away from what is chosen; its length does not matter");
}

template <class V>
void describe(V& v, Selection& o) {
  v.one_of();
  v.alternative("box", o, Box{}, "what is inside, at rest");
  v.alternative("sphere", o, BallSelection{}, "what is inside, at rest");
  v.alternative("plane", o, HalfSpaceSelection{}, "what lies on the plane or below it, at rest");
  v.alternative_value("group", o, As<GroupSelection, std::string, Text>{},
                      "a named group of the mesh file: points, lines, surfaces or a volume");
  v.alternative_value("region", o, As<RegionSelection, std::string, Text>{},
                      "a volume of the mesh file, or one of body.regions");
  v.alternative_value("nearest", o, As<NearestSelection, Point, Vector>{{length}},
                      "the one nearest to this point, on every level");
}

template <class V>
void describe(V& v, RegionDamping& o) {
  v("mass", o.mass, Quantity{rate, not_negative}, "instead of the body's");
  v("stiffness", o.stiffness, Quantity{duration, not_negative}, "instead of the body's");
}

template <class V>
void describe(V& v, RegionOptions& o) {
  v.group("where", o.where, "its elements, by their centroids; left out: the mesh file's volume of that name");
  v("young_modulus", o.young_modulus, Quantity{pressure, positive}, "instead of the body's");
  v("poisson_ratio", o.poisson_ratio, Quantity{number, {.min = 0, .max = 0.5, .max_excluded = true}},
    "instead of the body's");
  v("density", o.density, Quantity{density, positive}, "instead of the body's");
  v.group("damping", o.damping, "instead of the body's");
}

template <class V>
void describe(V& v, PathMotion::Knot& o) {
  v.required("time", o.time, Quantity{duration, not_negative}, "after that of the entry before");
  v.required("displacement", o.displacement, Vector{length}, "at that time, from where it is at rest");
}

template <class V>
void describe(V& v, SineMotion& o) {
  v.required("amplitude", o.amplitude, Vector{length}, "largest displacement from the middle");
  v.required("frequency", o.frequency, Quantity{rate, positive}, "in hertz");
  v("phase", o.phase, Quantity{angle}, "at the start, which is at rest's place: -90 deg starts without speed");
}

/// The keys of a motion, beside others of the map they stand in.
template <class V>
void describe_motion(V& v, Motion& o) {
  v.alternative_value("velocity", o, As<SteadyMotion, Point, Vector>{{velocity}}, "with which it moves from the start");
  v.alternative_list("path", o, PathMotion{}, &PathMotion::knots,
                     "displacements at given times, straight in between; before the first and after the last it stays");
  v.alternative("sine", o, SineMotion{}, "to and fro: amplitude * (sin(2 pi frequency t + phase) - sin(phase))");
}

template <class V>
void describe(V& v, PrescribedMotion& o) {
  describe(v, o.where);
  v.one_of();
  describe_motion(v, o.motion);
}

template <class V>
void describe(V& v, PolygonCourse::Knot& o) {
  v.required("time", o.time, Quantity{duration, not_negative}, "after that of the entry before");
  v.required("factor", o.factor, Quantity{number}, "at that time");
}

template <class V>
void describe(V& v, SineCourse& o) {
  v.required("frequency", o.frequency, Quantity{rate, positive}, "in hertz");
  v("phase", o.phase, Quantity{angle}, "at the start");
}

template <class V>
void describe(V& v, LoadOptions& o) {
  describe(v, o.where);
  v.one_of();
  v.alternative_value("traction", o.load, As<Traction, Point, Vector>{{pressure}},
                      "force per area, on the boundary triangles at rest with all their vertices chosen");
  v.alternative_value("force", o.load, As<TotalForce, Point, Vector>{{force}},
                      "of all chosen vertices together, each in proportion to its mass; on a face, traction is evener");
  v.at_most_one();
  v.alternative_value("ramp", o.course, As<RampCourse, double, Quantity>{{duration, positive}},
                      "rises smoothly from nothing in this time");
  v.alternative_list("course", o.course, PolygonCourse{}, &PolygonCourse::knots,
                     "factors at given times, straight in between, constant before and after");
  v.alternative("sine", o.course, SineCourse{}, "times sin(2 pi frequency t + phase)");
}

template <class V>
void describe(V& v, DampingOptions& o) {
  v("mass", o.mass, Quantity{rate, not_negative}, "proportional to the mass: slows all motion, falling too");
  v("stiffness", o.stiffness, Quantity{duration, not_negative},
    "proportional to the stiffness: slows what deforms, fast");
}

template <class V>
void describe(V& v, PartVelocity& o) {
  describe(v, o.where);
  v.required("velocity", o.velocity, Vector{velocity}, "of these vertices, on top of all other");
}

template <class V>
void describe(V& v, TwistOptions& o) {
  v.required("from", o.from, Vector{length}, "point on the axis where nothing turns, of the mesh at rest");
  v.required("to", o.to, Vector{length}, "another one: towards it and beyond, the rotation grows linearly");
  v.required("angular_velocity", o.angular_velocity, Quantity{angular_velocity}, "there");
}

template <class V>
void describe(V& v, InitialOptions& o) {
  v("position", o.position, Vector{length}, "centre of level 0's bounding box; left out: where the mesh is");
  v("velocity", o.velocity, Vector{velocity}, "of every free vertex");
  v("angular_velocity", o.angular_velocity, Vector{angular_velocity}, "about that centre");
  v.group("twist", o.twist, "rotation that grows along an axis, on top of these");
  v.list("parts", o.parts, "velocities of parts of the body, on top of these");
  v("stretch", o.stretch, Vector{number}, "along x, y, z about that centre: 0 flattens, below 0 turns inside out");
  v("random", o.random, Count{0}, "seed: every free vertex starts anywhere in level 0's bounding box at rest");
}

/// The key `body` fills the library's Body and the recipes of its meshes.
struct BodyKeys {
  Scene& scene;
};

template <class V>
void describe(V& v, BodyKeys& o) {
  Body& body = o.scene.problem.body;
  v.required_list("levels", o.scene.levels, "the body's meshes, finest first");
  v.group("material", body.material, "what the body is made of");
  v.map("regions", body.regions, "what parts of it have of their own: volumes of the mesh file, or selections");
  v.list("fixed", body.fixed, "vertices that stay where they are");
  v.list("prescribed", body.prescribed, "vertices whose motion is given");
  v.list("loads", body.loads, "forces from outside, of fixed direction");
  v.group("damping", body.damping, "damping");
  v.group("initial", body.initial, "state at the start");
  v.group("surface", o.scene.surface, "embedded in every level: it touches the obstacles and is looked at");
}

template <class V>
void describe(V& v, PlaneOptions& o) {
  v("point", o.point, Vector{length}, "on the plane");
  v("normal", o.normal, Vector{number}, "out of the solid; its length does not matter");
}

template <class V>
void describe(V& v, SphereOptions& o) {
  v("centre", o.centre, Vector{length}, "centre");
  v.required("radius", o.radius, Quantity{length, positive}, "radius");
}

template <class V>
void describe(V& v, BowlOptions& o) {
  v("centre", o.centre, Vector{length}, "of the sphere");
  v.required("radius", o.radius, Quantity{length, positive}, "of the sphere");
  v("rim", o.rim, Quantity{length, not_negative}, "height of the rim above the lowest point; 0: the radius");
}

template <class V>
void describe(V& v, CapsuleOptions& o) {
  v.required("from", o.from, Vector{length}, "one end of its middle line");
  v.required("to", o.to, Vector{length}, "the other end");
  v.required("radius", o.radius, Quantity{length, positive}, "around the line and its ends");
}

template <class V>
void describe(V& v, BlockOptions& o) {
  v("centre", o.centre, Vector{length}, "centre");
  v.required("size", o.size, Vector{length, positive}, "edges");
  v("rotation", o.rotation, Vector{angle}, "about the centre: [0, 0, 30 deg] turns it by 30 degrees about z");
}

template <class V>
void describe(V& v, CylinderOptions& o) {
  v.required("from", o.from, Vector{length}, "centre of one end");
  v.required("to", o.to, Vector{length}, "centre of the other end");
  v.required("radius", o.radius, Quantity{length, positive}, "radius");
}

template <class V>
void describe(V& v, ToolRecipe& o) {
  v.required("file", o.file, Text{}, "a closed surface (.stl, .obj, .msh), relative to the scene");
  v("scale", o.scale, Quantity{number, positive}, "metres per unit of that file: 0.001 for millimetres");
  v("rotation", o.rotation, Vector{angle}, "about the file's origin: [0, 0, 30 deg] turns it by 30 degrees about z");
  v("position", o.position, Vector{length}, "where that origin is put");
  v("cells", o.cells, Count{0}, "of its distance grid, along the longest extent; 0: 64, and more where it is thin");
}

template <class V>
void describe(V& v, ObstacleRecipe& o) {
  auto& shape = o.options.shape;
  v.one_of();
  v.alternative("plane", shape, PlaneOptions{}, "the half-space below a plane");
  v.alternative("sphere", shape, SphereOptions{}, "a solid sphere");
  v.alternative("bowl", shape, BowlOptions{}, "the inside of a spherical shell, up to a rim");
  v.alternative("capsule", shape, CapsuleOptions{}, "a cylinder with round ends");
  v.alternative("box", shape, BlockOptions{}, "a solid box");
  v.alternative("cylinder", shape, CylinderOptions{}, "a cylinder with flat ends");
  v.alternative("surface", o.tool, ToolRecipe{}, "the inside of a closed triangulated surface");
  v("friction", o.options.friction, Quantity{number, not_negative}, "Coulomb's coefficient; left out: frictionless");
  v.at_most_one();
  describe_motion(v, o.options.motion);
}

/// `contact` fills the library's options and the recipes of its obstacles.
struct ContactKeys {
  Scene& scene;
};

template <class V>
void describe(V& v, ContactKeys& o) {
  ContactOptions& contact = o.scene.problem.contact;
  v.list("obstacles", o.scene.obstacles, "what the body's surface touches");
  v("stiffness_scale", contact.stiffness_scale, Quantity{number, positive}, "times the penalty stiffness E A / h");
  v("damping_scale", contact.damping_scale, Quantity{number, not_negative}, "times the damping of the approach");
  v("tangential_damping_scale", contact.tangential_damping_scale, Quantity{number, not_negative},
    "times the damping of slow sliding, where friction is not yet at its cap");
}

template <class V>
void describe(V& v, OutputOptions& o) {
  v("every", o.every, Every{}, "between frames and rows of history.csv; left out: duration / 60");
  v("volume", o.volume, LevelChoice{}, "whose tetrahedra are written as well, with stress and volume ratio");
  v("probes", o.probes, NamedPoints{}, "points of level 0 at rest whose motion goes to probes.csv");
  v("probe_every", o.probe_every, Every{}, "between rows of probes.csv; left out: 1 step");
  v("format", o.format, Name{"format", frame_formats}, "of the frames");
}

/// The same kinds as in IntegrationOptions, none of them with a default.
template <class V>
void describe(V& v, StudyVariant& o) {
  v("shift_to_coarsest", o.shift_to_coarsest, Quantity{number, {.min = 0, .max = 1, .max_excluded = true}},
    "instead of integration's");
  v("integrator", o.integrator, NamePerLevel{{"integrator", integrators}}, "instead of integration's");
  v("substeps", o.substeps, AutoCountPerLevel{}, "instead of integration's");
  v("safety", o.safety, Quantity{number, {.min = 0, .max = 1, .min_excluded = true}}, "instead of integration's");
  v("allow_unstable", o.allow_unstable, Flag{}, "instead of integration's");
  v("switch_threshold", o.switch_threshold, Quantity{number, positive}, "instead of integration's");
  v("outside", o.outside, Name{"rule", outside_rules}, "instead of integration's");
}

template <class V>
void describe(V& v, StudyOptions& o) {
  v("methods", o.methods, ListOf<Text>{},
    "single, coarse, cycle, or one of them: single/rk4, coarse/1, cycle/rsv, cycle/rsv/equal, with a variant "
    "cycle/rsv/equal+hybrid; left out: the default set");
  v.map("variants", o.variants, "what cycles have instead of the scene's integration when they are named with it");
  v("macro_steps", o.macro_steps, ListOf<AutoQuantity>{{{duration, positive}}},
    "of cycles and implicit methods, and of explicit ones those below their limit; left out: multiples of the finest "
    "limit");
  v("precision", o.precision, ListOf<Name>{{"precision", precisions}}, "in which each method runs");
  v("threads", o.threads, ListOf<Count>{{1}}, "with which each method runs; left out: all there are");
  v("samples", o.samples, Count{1}, "times, evenly over the duration, at which states are compared");
  v("timed_runs", o.timed_runs, Count{0}, "of each row, short ones at least five; 0: the compared one is timed");
  v("growth", o.growth, Flag{}, "find the growth of small motions by every cycle, linearised about rest");
}

template <class V>
void describe(V& v, Scene& o) {
  v("name", o.name, Text{}, "title; left out: the file's name");
  v.required("duration", o.duration, Quantity{duration, positive}, "simulated time");
  v("gravity", o.problem.gravity, Vector{acceleration}, "acceleration of everything that is free");
  BodyKeys body{o};
  v.required_group("body", body, "the deformable body");
  v.group("integration", o.problem.integration, "how it is stepped in time");
  ContactKeys contact{o};
  v.group("contact", contact, "what it collides with");
  v.group("output", o.output, "what a run writes");
  v.group("study", o.study, "what plica study compares");
}

}  // namespace plica::app
