// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/app/scene/kinds.hpp>
#include <plica/drivers/app/scene/scene.hpp>

/// Every key of a scene, once: its name, where it goes, what it may be, and what it means. A visitor walks these
/// tables to read a scene (reader.hpp) or to print the keys (key_list.hpp). `required` keys have no default; exactly
/// one of a struct's `alternative` keys is given.
namespace plica::app {

std::vector<Choice> outside_rules();
std::vector<Choice> frame_formats();

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
  v.alternative("box", o.box, BoxRecipe{}, "a box of cells");
  v.alternative("ball", o.ball, BallRecipe{}, "a ball");
  v.alternative("cylinder", o.cylinder, CylinderRecipe{}, "a cylinder");
  v.alternative_value("file", o.file, Text{}, "a mesh file (.msh, .vtk, .vtu, .ele), relative to the scene");
  v("scale", o.scale, Quantity{number, positive}, "metres per unit of that file: 0.001 for millimetres");
}

template <class V>
void describe(V& v, BallSurfaceRecipe& o) {
  v.required("radius", o.radius, Quantity{length, positive}, "radius");
  v("subdivisions", o.subdivisions, Count{0}, "of an icosahedron: 12, 42, 162, 642, 2562 ... points");
  v("centre", o.centre, Vector{length}, "centre; left out: that of level 0's bounding box");
}

template <class V>
void describe(V& v, SurfaceRecipe& o) {
  v.alternative("sphere", o.sphere, BallSurfaceRecipe{}, "a triangulated sphere");
  v.alternative_value("boundary", o.boundary, Flag{}, "true: the boundary of level 0");
}

template <class V>
void describe(V& v, MaterialOptions& o) {
  v("model", o.model, Name{"material", materials}, "constitutive law");
  v("young_modulus", o.young_modulus, Quantity{pressure, positive}, "stiffness E");
  v("poisson_ratio", o.poisson_ratio, Quantity{number, {.min = 0, .max = 0.5, .max_excluded = true}},
    "lateral contraction nu; close to 0.5 linear tetrahedra are too stiff");
  v("density", o.density, Quantity{density, positive}, "mass per volume at rest");
}

template <class V>
void describe(V& v, RegionOptions& o) {
  v("young_modulus", o.young_modulus, Quantity{pressure, positive}, "instead of the body's");
  v("poisson_ratio", o.poisson_ratio, Quantity{number, {.min = 0, .max = 0.5, .max_excluded = true}},
    "instead of the body's");
  v("density", o.density, Quantity{density, positive}, "instead of the body's");
}

template <class V>
void describe(V& v, Selection& o) {
  v.alternative("box", o.box, Box{}, "the vertices inside, at rest");
  v.alternative_value("group", o.group, Text{}, "the vertices of a named group of the mesh file");
}

template <class V>
void describe(V& v, PrescribedMotion& o) {
  describe(v, o.where);
  v.required("velocity", o.velocity, Vector{velocity}, "with which they move from the start");
}

template <class V>
void describe(V& v, DampingOptions& o) {
  v("mass", o.mass, Quantity{rate, not_negative}, "proportional to the mass: slows all motion, falling too");
}

template <class V>
void describe(V& v, InitialOptions& o) {
  v("position", o.position, Vector{length}, "centre of level 0's bounding box; left out: where the mesh is");
  v("velocity", o.velocity, Vector{velocity}, "of every free vertex");
  v("angular_velocity", o.angular_velocity, Vector{angular_velocity}, "about that centre");
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
  v.map("regions", body.regions, "what parts of it have of their own, by the mesh file's physical volumes");
  v.list("fixed", body.fixed, "vertices that stay where they are");
  v.list("prescribed", body.prescribed, "vertices whose motion is given");
  v.group("damping", body.damping, "damping");
  v.group("initial", body.initial, "state at the start");
  v.group("surface", o.scene.surface, "embedded in every level: it touches the obstacles and is looked at");
}

template <class V>
void describe(V& v, ImplicitOptions& o) {
  v("relative_residual", o.relative_residual,
    Quantity{number, {.min = 0, .max = 1, .min_excluded = true, .max_excluded = true}}, "at which a linear solve ends");
  v("iterations", o.iterations, Count{0}, "above 0: exactly so many per linear solve, whatever the residual");
  v("max_iterations", o.max_iterations, Count{1}, "a solve that is not done by then is counted as a miss");
  v("newton_iterations", o.newton_iterations, Count{1}, "per step; 1: linearly implicit");
  v("newton_tolerance", o.newton_tolerance, Quantity{number, positive}, "relative to the first residual");
}

template <class V>
void describe(V& v, IntegrationOptions& o) {
  v("cycle", o.cycle, Name{"cycle", cycles, {"fas", "him"}}, "how the levels share a macro step");
  v("macro_step", o.macro_step, AutoQuantity{{duration, positive}}, "auto: 0.9 of the predicted limit");
  v("distribution", Shares::Target{o.distribution, o.shares}, Shares{{"distribution", distributions}},
    "how much of the macro step each level integrates");
  v("shift_to_coarsest", o.shift_to_coarsest, Quantity{number, {.min = 0, .max = 1, .max_excluded = true}},
    "this part of every finer level's share goes to the coarsest");
  v("integrator", o.integrator,
    NamePerLevel{{"integrator", integrators, {"central_difference", "rk2", "newmark", "bdf2", "generalized_alpha"}}},
    "each level's own");
  v("substeps", o.substeps, AutoCountPerLevel{}, "auto: as many as the level's limit asks for");
  v("safety", o.safety, Quantity{number, {.min = 0, .max = 1, .min_excluded = true}}, "of that limit that auto keeps");
  v("allow_unstable", o.allow_unstable, Flag{}, "run explicit sub-steps above their limit all the same");
  v("switch_threshold", o.switch_threshold, Quantity{number, positive},
    "of the switched mappings: drift over the local edge length");
  v("outside", o.outside, Name{"rule", outside_rules}, "for vertices outside the other level's mesh");
  v.group("implicit", o.implicit, "how implicit levels are solved");
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
void describe(V& v, ObstacleOptions& o) {
  v.alternative("plane", o.shape, PlaneOptions{}, "the half-space below a plane");
  v.alternative("sphere", o.shape, SphereOptions{}, "a solid sphere");
  v.alternative("bowl", o.shape, BowlOptions{}, "the inside of a spherical shell, up to a rim");
  v("friction", o.friction, Quantity{number, not_negative}, "Coulomb's coefficient; left out: frictionless");
  v("velocity", o.velocity, Vector{velocity}, "with which it moves from the start");
}

template <class V>
void describe(V& v, ContactOptions& o) {
  v.list("obstacles", o.obstacles, "what the body's surface touches");
  v("stiffness_scale", o.stiffness_scale, Quantity{number, positive}, "times the penalty stiffness E A / h");
  v("damping_scale", o.damping_scale, Quantity{number, not_negative}, "times the damping of the approach");
  v("tangential_damping_scale", o.tangential_damping_scale, Quantity{number, not_negative},
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

template <class V>
void describe(V& v, Scene& o) {
  v("name", o.name, Text{}, "title; left out: the file's name");
  v.required("duration", o.duration, Quantity{duration, positive}, "simulated time");
  v("gravity", o.problem.gravity, Vector{acceleration}, "acceleration of everything that is free");
  BodyKeys body{o};
  v.required_group("body", body, "the deformable body");
  v.group("integration", o.problem.integration, "how it is stepped in time");
  v.group("contact", o.problem.contact, "what it collides with");
  v.group("output", o.output, "what a run writes");
}

}  // namespace plica::app
