// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/describe_contact.hpp>
#include <plica/core/keys.hpp>
#include <plica/core/problem.hpp>

/// Tables of the options of problem.hpp: name, place, kind with unit and range, and meaning of
/// each. The table of a struct is describe(visitor, options). A visitor uses it: the reader of
/// scenes, the list of keys, the JSON Schema, the checks of set-up. For each line of a table the
/// visitor is called by
///   v(name, member, kind, help)              optional key; left out: the member's default
///   v.required(name, member, kind, help)     required key
///   v.one_of(), v.at_most_one()              exactly one, or at most one, of the next alternatives
///   v.alternative(name, target, kind, help)
/// A new option is a member of its struct and a line here. The tables of the obstacles' shapes are
/// in kernels/contact/shapes/.
namespace plica {

using namespace keys;

using TissueName = NameOfAll<&MaterialOptions::tissue>;
using PresetName = NameOfAll<&Problem::preset>;

template <class V>
void describe(V& v, Box& o) {
  v.required("min", o.min, Vector{length}, "lowest corner");
  v.required("max", o.max, Vector{length}, "highest corner");
}

template <class V>
void describe(V& v, BallSelection& o) {
  v("centre", o.centre, Vector{length}, "centre");
  v.required("radius", o.radius, Quantity{length, positive}, "radius");
}

template <class V>
void describe(V& v, HalfSpaceSelection& o) {
  v("point", o.point, Vector{length}, "on the plane");
  v("normal", o.normal, Direction{}, "away from what is chosen; its length does not matter");
}

template <class V>
void describe(V& v, Selection& o) {
  v.one_of();
  v.alternative("box", as<Box>(o), Group{}, "what is inside, at rest");
  v.alternative("sphere", as<BallSelection>(o), Group{}, "what is inside, at rest");
  v.alternative("half_space", as<HalfSpaceSelection>(o), Group{},
                "what lies on the plane or below it, at rest");
  v.alternative("group", as<&GroupSelection::name>(o), Text{},
                "a named group of the mesh file: points, lines, surfaces or a volume");
  v.alternative("region", as<&RegionSelection::name>(o), Text{},
                "a volume of the mesh file, or one of body.regions");
  v.alternative("nearest", as<&NearestSelection::to>(o), Vector{length},
                "the one nearest to this point, on every level");
}

template <class V>
void describe(V& v, FollowOptions& o) {
  v.required("obstacle", o.obstacle, Text{}, "its name in contact.obstacles");
  v.required("radius", o.radius, Quantity{length, positive},
             "elements whose centroid is nearer to it than this, wherever both are, are cut");
  v("at", o.at, Vector{length},
    "point of the obstacle that the radius is round, where it is at the start; left out: the "
    "middle of its shape");
}

/// Describes the constants that the body and its regions have in common. Those of a region are
/// optional.
template <class V, class Options>
void describe_constants(V& v, Options& o) {
  v("young_modulus", o.young_modulus, Quantity{pressure, stiffness}, "stiffness E");
  v("poisson_ratio", o.poisson_ratio, Quantity{plain, {.min = 0, .max = 0.5, .max_excluded = true}},
    "lateral contraction nu; close to 0.5 linear tetrahedra are too stiff");
  v("density", o.density, Quantity{density, positive}, "mass per volume at rest");
  for (const MaterialParameter& p : material_parameters())
    v(p.name, o.parameters, Entry{p.name, p.kind}, p.help);
}

template <class V>
void describe(V& v, FibreWinding& o) {
  v("point", o.point, Vector{length}, "on the line");
  v.required("axis", o.axis, Direction{}, "along the line; its length does not matter");
  v("angle", o.angle, Quantity{angle}, "of the helix: 0 round the line, 90 deg along it");
}

template <class V>
void describe(V& v, PronyTerm& o) {
  v.required("alpha", o.alpha, Quantity{plain, inside_zero_one},
             "part of the stress at once that relaxes");
  v.required("tau", o.tau, Quantity{duration, positive}, "time in which e^-1 of it is left");
}

template <class V>
void describe(V& v, FibreOptions& o) {
  v("sheet", o.sheet, Direction{}, "across them: in the plane of their sheets, or of two families");
  v("sheet_field", o.sheet_field, Text{},
    "the same, of each element: vectors of the mesh file by their name");
  v("to", o.to, Group{}, "with `from`: vertices that the fibres run to");
  v.one_of();
  v.alternative("axis", o.axis, Direction{},
                "along the fibres everywhere; its length does not matter");
  v.alternative("around", o.around, Group{},
                "round a line, as in vessels; their sheets are cylinders");
  v.alternative("field", o.field, Text{},
                "of each element: vectors of the mesh file, of its cells or points, by their name");
  v.alternative(
      "from", o.from, Group{},
      "vertices that the fibres run from, to those of `to`, as heat would flow between them");
}

template <class V>
void describe(V& v, OgdenTerm& o) {
  v.required("mu", o.mu, Quantity{pressure}, "its coefficient, in the convention that is named");
  v.required("alpha", o.alpha, Quantity{plain, {.min = -50, .max = 50}}, "its exponent, not 0");
}

template <class V>
void describe(V& v, MaterialOptions& o) {
  v("tissue", o, TissueName{"tissue", tissues},
    "a material with all its values, which the other keys override: plica list tissues");
  v("model", o.model, Name{"material", materials}, "constitutive law");
  describe_constants(v, o);
  v("terms", o.terms, List{}, "of ogden: 1 to 6");
  v("convention", o.convention, Name{"convention", ogden_conventions},
    "of ogden, which has no standard one");
  v("volume", o.volume, Name{"volume", volumes}, "of laws of tissue, U(J); left out: simo_hughes");
  v("prony", o.prony, List{},
    "relaxation of the stress of shape, of neo_hookean and laws of tissue: 1 to 6 terms");
  v("allow_inversion", o.allow_inversion, Flag{},
    "false: inverted elements end the run; left out: by the material");
}

/// Describes the damping of the body, or of a region.
template <class V, class Options>
void describe_damping(V& v, Options& o) {
  v("mass", o.mass, Quantity{rate, not_negative},
    "proportional to the mass: slows all motion, falling too");
  v("stiffness", o.stiffness, Quantity{duration, not_negative},
    "proportional to the stiffness at rest: slows changes of shape, fast ones most, and no "
    "turning");
}
template <class V>
void describe(V& v, DampingOptions& o) {
  describe_damping(v, o);
}
template <class V>
void describe(V& v, RegionDamping& o) {
  describe_damping(v, o);
}

template <class V>
void describe(V& v, RegionOptions& o) {
  v("where", o.where, Group{},
    "its elements, by their centroids; left out: the mesh file's volume of that name");
  describe_constants(v, o);
  v("terms", o.terms, List{}, "of ogden: 1 to 6");
  v("prony", o.prony, List{}, "relaxation: 1 to 6 terms instead of the body's");
  v("fibres", o.fibres, Group{}, "instead of the body's");
  v("damping", o.damping, Group{}, "instead of the body's");
}

template <class V>
void describe(V& v, PathMotion::Knot& o) {
  v.required("time", o.time, Quantity{duration, not_negative}, "after that of the entry before");
  v.required("displacement", o.displacement, Vector{length},
             "at that time, from where it is at rest");
}

template <class V>
void describe(V& v, SineMotion& o) {
  v.required("amplitude", o.amplitude, Vector{length}, "largest displacement from the middle");
  v.required("frequency", o.frequency, Quantity{rate, positive}, "in hertz");
  v("phase", o.phase, Quantity{angle},
    "at the start, where the displacement is zero: -90 deg starts without speed");
}

template <class V>
void describe(V& v, Motion& o) {
  v.alternative("velocity", as<&SteadyMotion::velocity>(o), Vector{velocity},
                "with which it moves from the start");
  v.alternative("curve", as<&PathMotion::knots>(o), List{1},
                "displacements at given times, straight in between; before the first and after the "
                "last it stays");
  v.alternative("sine", as<SineMotion>(o), Group{},
                "oscillates: amplitude * (sin(2 pi frequency t + phase) - sin(phase))");
}

template <class V>
void describe(V& v, PathTurn::Knot& o) {
  v.required("time", o.time, Quantity{duration, not_negative}, "after that of the entry before");
  v.required("angle", o.angle, Quantity{angle}, "at that time");
}

template <class V>
void describe(V& v, SineTurn& o) {
  v.required("amplitude", o.amplitude, Quantity{angle}, "largest angle from the middle");
  v.required("frequency", o.frequency, Quantity{rate, positive}, "in hertz");
  v("phase", o.phase, Quantity{angle},
    "at the start, where the angle is zero: -90 deg starts without speed");
}

template <class V>
void describe(V& v, Turn& o) {
  v("axis", o.axis, Direction{},
    "counter-clockwise where it points at the eye; its length does not matter");
  v("about", o.about, Vector{length},
    "on the axis, at the start; left out: what torques are about");
  v("rotation", o.rotation, Vector{angle},
    "at the start, about the same point: [0, 0, 30 deg] turns it about z");
  v.at_most_one();
  v.alternative("angular_velocity", as<&SteadyTurn::angular_velocity>(o.angle),
                Quantity{angular_velocity}, "with which it turns from the start");
  v.alternative(
      "curve", as<&PathTurn::knots>(o.angle), List{1},
      "angles at given times, straight in between; before the first and after the last it stays");
  v.alternative("sine", as<SineTurn>(o.angle), Group{},
                "swings: amplitude * (sin(2 pi frequency t + phase) - sin(phase))");
}

template <class V>
void describe(V& v, FixedVertices& o) {
  describe(v, o.where);
  v.at_most_one();
  v.alternative("along", o.along, ListOf<Name>{{"axis", axis_choices}},
                "held along these axes alone, free across them; left out: along all");
  v.alternative("slide", o.slide, NormalOrDirection{},
                "held along this normal alone, so that they slide across it; normal: that of the "
                "surface at rest, on the boundary triangles with all their vertices chosen");
}

template <class V>
void describe(V& v, PrescribedMotion& o) {
  describe(v, o.where);
  v.one_of();
  describe(v, o.motion);
  v.alternative(
      "rotate", o.rotate, Group{},
      "turns about an axis, by an angle over time; torques are about the same point: left "
      "out, the centre of the vertices' box");
}

template <class V>
void describe(V& v, PolygonCourse::Knot& o) {
  v.required("time", o.time, Quantity{duration, not_negative}, "after that of the entry before");
  v.required("factor", o.factor, Quantity{plain}, "at that time");
}

template <class V>
void describe(V& v, SineCourse& o) {
  v.required("frequency", o.frequency, Quantity{rate, positive}, "in hertz");
  v("phase", o.phase, Quantity{angle}, "at the start");
}

template <class V>
void describe(V& v, EnclosedVolume& o) {
  v.required("ratio", o.ratio, Quantity{plain, positive},
             "to that at rest, when the curve is at 1");
  v.required("bulk_modulus", o.bulk_modulus, Quantity{pressure, positive},
             "of the fluid: its pressure over the part of the volume that is missing");
}

template <class V>
void describe(V& v, LoadOptions& o) {
  describe(v, o.where);
  v.one_of();
  v.alternative("traction", as<&Traction::value>(o.load), Vector{pressure},
                "force per area, on the boundary triangles at rest with all their vertices chosen");
  v.alternative("force", as<&TotalForce::value>(o.load), Vector{force},
                "of all chosen vertices together, each in proportion to its mass; on a face, "
                "traction is more even");
  v.alternative("follower_pressure", as<&FollowerPressure::value>(o.load), Quantity{pressure},
                "on the same triangles, always against their sides; above 0 into the body");
  v.alternative(
      "enclosed_volume", as<EnclosedVolume>(o.load), Group{},
      "of the cavity on the outer side of these triangles, by the pressure of a fluid in it");
  v("on_cuts", o.on_cuts, Flag{},
    "tractions and pressures also act on faces that cuts open, with all their vertices chosen");
  v.at_most_one();
  v.alternative("ramp", as<&RampCourse::duration>(o.course), Quantity{duration, positive},
                "rises smoothly from zero within this time");
  v.alternative("curve", as<&PolygonCourse::knots>(o.course), List{1},
                "factors at given times, straight in between, constant before and after");
  v.alternative("sine", as<SineCourse>(o.course), Group{}, "times sin(2 pi frequency t + phase)");
}

template <class V>
void describe(V& v, PartVelocity& o) {
  describe(v, o.where);
  v.required("velocity", o.velocity, Vector{velocity}, "of these vertices, on top of all other");
  v("angular_velocity", o.angular_velocity, Vector{angular_velocity},
    "about the centre of their bounding box");
}

template <class V>
void describe(V& v, TwistOptions& o) {
  v.required("from", o.from, Vector{length},
             "point on the axis where nothing turns, of the mesh at rest");
  v.required("to", o.to, Vector{length},
             "another point on the axis: the rotation grows linearly towards it and beyond");
  v.required("angular_velocity", o.angular_velocity, Quantity{angular_velocity}, "there");
}

template <class V>
void describe(V& v, InitialOptions& o) {
  v("position", o.position, Vector{length},
    "centre of level 0's bounding box; left out: where the mesh is");
  v("velocity", o.velocity, Vector{velocity}, "of every free vertex");
  v("angular_velocity", o.angular_velocity, Vector{angular_velocity}, "about that centre");
  v("twist", o.twist, Group{}, "rotation that grows along an axis, on top of these");
  v("parts", o.parts, List{}, "velocities of parts of the body, on top of these");
  v("stretch", o.stretch, Vector{plain},
    "along x, y, z about that centre: 0 flattens, below 0 turns inside out");
  v("random", o.random, Count{0},
    "seed: every free vertex starts anywhere in level 0's bounding box at rest");
}

/// Describes a body without its meshes and its surface.
template <class V>
void describe(V& v, Body& o) {
  v("element", o.element, ListOf<Name>{{"element", elements}, per_level},
    "how strains follow from the vertices, of each level");
  v("stabilisation", o.stabilisation, Quantity{plain, {.min = 0.2, .max = 1}},
    "beta of nodal elements: smaller for thin bending (0.3), larger for clean high modes (0.6)");
  v("volumetric_smoothing", o.pressure, Name{"volumetric_smoothing", pressures},
    "whether nodal elements smooth their volume changes, as nearly incompressible tissue needs");
  v("material", o.material, Group{}, "what the body is made of");
  v("fibres", o.material.fibres, Group{}, "of laws with fibres: their directions at rest");
  v("regions", o.regions, Map{},
    "parts with options of their own: volumes of the mesh file, or selections");
  v("fixed", o.fixed, List{}, "vertices that stay where they are, or slide across a normal");
  v("prescribed", o.prescribed, List{}, "vertices whose motion is given");
  v("loads", o.loads, List{}, "forces from outside");
  v("damping", o.damping, Group{}, "damping");
  v("initial", o.initial, Group{}, "state at the start");
}

template <class V>
void describe(V& v, ImplicitOptions& o) {
  v("solver", o.solver, Name{"solver", linear_solver_choices},
    "of linear systems; auto: direct for small meshes");
  v("preconditioner", o.preconditioner, Name{"preconditioner", preconditioner_choices},
    "of conjugate gradients; auto: multigrid where the body has coarser levels");
  v("matrix", o.matrix, Name{"matrix", matrix_choices},
    "how the system is stored; auto: assembled where that is faster");
  v("polynomial_degree", o.polynomial_degree, Count{2, 16},
    "of chebyshev, and of the smoothing in multigrid");
  v("relative_residual", o.relative_residual, Quantity{plain, inside_zero_one},
    "at which a linear solve ends");
  v("iterations", o.iterations, Count{0},
    "above 0: exactly so many per linear solve, at any residual");
  v("max_iterations", o.max_iterations, Count{1},
    "a solve that has not converged by then is counted as a miss");
  v("newton_iterations", o.newton_iterations, AutoCount{},
    "per stage, at most; 1: linearly implicit; auto: 20, or 1 where a linear solve is a fixed "
    "amount of work");
  v("newton_tolerance", o.newton_tolerance, AutoQuantity{{plain, positive}},
    "part of the forces that a stage may leave unbalanced; auto: 0.003, or 1e-6 where the "
    "integrator conserves energy");
  v("newton_residual", o.newton_residual, Quantity{force, not_negative},
    "or, if that is less strict, this residual");
  v("tangent", o.tangent, Name{"tangent", tangents},
    "of the elements, that linear systems are made of");
  v("rho_infinity", o.rho_infinity, AutoQuantity{{plain, zero_to_one}},
    "of generalized_alpha: the part of the fastest motion that is left after a step; auto: 0.8, "
    "with contact 0");
}

template <class V>
void describe(V& v, HimOptions& o) {
  v("sigma", o.sigma, Quantity{plain, inside_zero_one},
    "part of its stability limit that a step uses at rest; the remainder is reserved for "
    "stiffening");
  v("dissipation", o.dissipation, AutoQuantity{{plain, below_one}},
    "of slowed motion, per step; auto: 1e-4 where the body turns");
  v("smoothing", o.smoothing, Flag{}, "of its transfers between the levels");
}

template <class V>
void describe(V& v, RestOptions& o) {
  v("tolerance", o.tolerance, AutoQuantity{{plain, inside_zero_one}},
    "forces that are not balanced, over all forces, at which the body is at rest; auto: 1e-5, in "
    "float 1e-3");
  v("ramp", o.ramp, AutoQuantity{{duration, positive}},
    "gravity, and loads without ramp, curve or sine, grow from zero within this time; auto: the "
    "duration");
}

template <class V>
void describe(V& v, FailureOptions& o) {
  v("halvings", o.halvings, AutoCount{0, 10, FailureOptions::automatic},
    "of a macro step that fails, at most; auto: 6 where Newton's method judges it; explicit "
    "sub-steps and him shorten "
    "their own");
  v("unsolved", o.unsolved, Name{"outcome", unsolved_outcomes},
    "of the shortest part that Newton's method does not solve");
}

/// Describes the options of stepping that variants of a study may change, too. Those of a variant
/// are optional.
template <class V, class Options>
void describe_stepping(V& v, Options& o) {
  v("shift_to_coarsest", o.shift_to_coarsest, Quantity{plain, below_one},
    "this part of every finer level's share goes to the coarsest");
  v("integrator", o.integrator, ListOf<Name>{{"integrator", integrators}, per_level},
    "each level's own");
  v("substeps", o.substeps, ListOf<AutoCount>{{}, per_level},
    "auto: as many as the level's limit asks for");
  v("safety", o.safety, Quantity{plain, up_to_one}, "part of that limit that auto uses");
  v("allow_unstable", o.allow_unstable, Flag{},
    "run also with explicit sub-steps above their limit");
  v("switch_threshold", o.switch_threshold, Quantity{plain, positive},
    "of the switched mappings: drift over the local edge length");
  v("outside", o.outside, Name{"rule", outside_rules},
    "for vertices outside the other level's mesh");
}

template <class V>
void describe(V& v, IntegrationOptions& o) {
  v("cycle", o.cycle, Name{"cycle", cycle_choices},
    "how the levels share a macro step; auto: chosen by short trials");
  v("error_class", o.error_class, Name{"error class", error_classes},
    "of cycle auto: how far from level 0 alone");
  v("macro_step", o.macro_step, AutoQuantity{{duration, positive}},
    "auto: 0.9 of the predicted limit, with cycle him 8 critical steps of the finest level, or 4 "
    "with contact; the last step ends at the duration");
  v("distribution", Shares::Target{o.distribution, o.shares},
    Shares{{"distribution", distributions}}, "how much of the macro step each level integrates");
  describe_stepping(v, o);
  v("relaxation", o.relaxation, Name{"rule", relaxation_rules},
    "how the stresses of body.material.prony go on");
  v("implicit", o.implicit, Group{}, "how implicit levels are solved");
  v("him", o.him, Group{}, "of the cycle him");
  v("rest", o.rest, Group{}, "of the cycle rest");
  v("on_failure", o.on_failure, Group{},
    "of a macro step: halved, and longer again once it is calm");
}

template <class V>
void describe(V& v, BladeOptions& o) {
  v.required("segment", o.segment, ListOf<Vector>{{length}},
             "both ends of its straight edge, at the start");
  v.one_of();
  describe(v, o.motion);
}

template <class V>
void describe(V& v, CutOptions& o) {
  v.required("blade", o.blade, Group{}, "a straight edge that cuts what it sweeps");
  v("from", o.from, Quantity{duration, not_negative}, "when it begins to cut");
  v.required("to", o.to, Quantity{duration, positive}, "when it ends");
}

/// Describes a problem without the body, its integration, contact and cuts.
template <class V>
void describe(V& v, Problem& o) {
  v("preset", o, PresetName{"preset", presets},
    "a published method, whose options the other keys override: plica list presets");
  v("gravity", o.gravity, Vector{acceleration}, "acceleration of everything that is free");
}

}  // namespace plica
