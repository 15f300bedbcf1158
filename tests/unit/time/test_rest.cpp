// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <plica/core/error.hpp>
#include <plica/drivers/elastic/materials.hpp>
#include <plica/drivers/study/direct_solves.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/generators.hpp>
#include <plica/meshes/organs.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/refusal.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// The cycle rest: equilibrium by load steps, against closed forms, direct solves and motion that
// has died out.
namespace {

using namespace plica;
using namespace plica::test;

/// Loads that grow in a second, which static_equilibrium() follows too.
LoadCourse growing() { return PolygonCourse{{{0, 0}, {1, 1}}}; }

Problem at_rest(Problem p, double tolerance = 1e-8) {
  p.integration = {};
  p.integration.cycle = "rest", p.integration.rest.tolerance = tolerance;
  return p;
}

/// Runs to the whole loads and returns the displacements.
std::vector<Point> rest_of(const Problem& p) {
  Simulation<Host> simulation(p);
  advance(simulation, 10);
  EXPECT_NEAR(simulation.time(), 1, 1e-12);
  EXPECT_LE(simulation.residual(), p.integration.rest.tolerance.value_or(1e-5));
  EXPECT_EQ(largest(simulation.velocities()), 0);
  return displacements(simulation, p.body.levels[0]);
}

Problem hanging_beam(const std::string& element, double poisson_ratio) {
  Problem p = body_of({jittered_box(beam_box, {8, 2, 2})}, "neo_hookean");
  p.body.element = {element}, p.body.material.poisson_ratio = poisson_ratio;
  p.body.fixed = {left_face()};
  p.body.loads = {{Box{{0.4, -1, -1}, {0.4, 1, 1}}, Traction{{0, 0, -60}}, growing()}};
  return p;
}

TEST(Rest, IsTheEquilibriumOfDirectSolves) {
  for (const auto& [element, nu] : {std::pair{"linear", 0.3}, {"nodal", 0.3}, {"nodal", 0.495}}) {
    const Problem p = hanging_beam(element, nu);
    LevelProbe<HostBackend> probe(p);
    StaticOptions options;
    options.load_steps = 5, options.relative_residual = 1e-8;
    const auto want = static_equilibrium(probe, options), got = rest_of(at_rest(p));
    EXPECT_GT(largest(want), 0.02) << element << nu;
    EXPECT_LE(largest_difference(got, want), 1e-4 * largest(want)) << element << nu;
  }
}

// Gravity grows with the load steps, and none of it is missing at the end.
TEST(Rest, IsWhereDampedMotionEnds) {
  Problem p = body_of({jittered_box(beam_box, {8, 2, 2})}, "neo_hookean");
  p.body.fixed = {left_face()}, p.gravity = {0, 0, -1};
  Problem moving = p;
  moving.integration.integrator = {"implicit_euler"}, moving.integration.macro_step = 1;
  moving.integration.implicit.newton_tolerance = 1e-9;
  Simulation<Host> simulation(moving);
  advance(simulation, 30);
  const auto want = displacements(simulation, p.body.levels[0]);
  EXPECT_LE(largest_difference(rest_of(at_rest(p)), want), 1e-5 * largest(want));
}

/// Nominal stresses of neo_hookean along and across a bar [Pa].
std::array<double, 2> bar_stress(double mu, double kappa, double along, double across) {
  const double J = along * across * across, I = along * along + 2 * across * across,
               shape = mu * std::pow(J, -2.0 / 3), volume = kappa / 2 * (J * J - 1);
  return {shape * (along - I / (3 * along)) + volume / along,
          shape * (across - I / (3 * across)) + volume / across};
}

/// The vertices of the face 0 along an axis, held along it.
FixedVertices roller(int axis, const char* along) {
  Box face{{-1, -1, -1}, {1, 1, 1}};
  face.min[axis] = face.max[axis] = 0;
  FixedVertices held(face);
  held.along = {along};
  return held;
}

// A block on rollers has uniaxial stress everywhere.
TEST(Rest, StretchesABlockAsTheClosedForm) {
  for (const auto& [element, nu] : {std::pair{"linear", 0.3}, {"nodal", 0.3}, {"nodal", 0.45}}) {
    const double mu = 10e3, kappa = 2 * mu * (1 + nu) / (3 * (1 - 2 * nu)), pull = 15e3;
    Problem p = small_cube("neo_hookean");
    p.body.element = {element};
    p.body.material.young_modulus = 2 * mu * (1 + nu), p.body.material.poisson_ratio = nu;
    p.body.fixed = {roller(0, "x"), roller(1, "y"), roller(2, "z")};
    p.body.loads = {{Box{{0.1, -1, -1}, {0.1, 1, 1}}, Traction{{pull, 0, 0}}, {}}};
    const auto u = rest_of(at_rest(p));
    double along = 0, across = 0;
    for (std::size_t a = 0; a < u.size(); ++a)
      if ((p.body.levels[0].vertices[a] - Point(0.1, 0.1, 0.1)).norm() < 1e-9)
        along = 1 + u[a][0] / 0.1, across = 1 + u[a][1] / 0.1;
    const auto stress = bar_stress(mu, kappa, along, across);
    EXPECT_GT(along, 1.4) << element << nu;
    EXPECT_NEAR(stress[0], pull, 1e-5 * pull) << element << nu;
    EXPECT_NEAR(stress[1], 0, 1e-5 * pull) << element << nu;
  }
}

double volume_of(const TetMesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.tets) {
    const auto x = [&](std::size_t k) { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
    sum += tet_volume(x(0), x(1), x(2), x(3));
  }
  return sum;
}

/// Volume of a deformed mesh over that at rest.
double volume_ratio(const TetMesh& mesh, const std::vector<Point>& u) {
  TetMesh moved = mesh;
  for (std::size_t a = 0; a < u.size(); ++a) moved.vertices[a] += u[a];
  return volume_of(moved) / volume_of(mesh);
}

// One vertex holds the body, which may still turn about it: pressures that follow it turn nothing.
// -p = kappa/2 (J - 1/J) everywhere.
TEST(Rest, PressesABodyThatOneVertexHolds) {
  const double pressure = 6e3;
  for (const char* element : {"linear", "nodal"}) {
    Problem p = small_cube("neo_hookean");
    p.body.element = {element};
    const MaterialOptions& m = p.body.material;
    const double kappa = m.young_modulus / (3 * (1 - 2 * m.poisson_ratio)), x = pressure / kappa;
    p.body.fixed = {NearestSelection{{0, 0, 0}}};
    p.body.loads = {{Box{{-1, -1, -1}, {1, 1, 1}}, FollowerPressure{pressure}, {}}};
    EXPECT_NEAR(volume_ratio(p.body.levels[0], rest_of(at_rest(p))), std::sqrt(x * x + 1) - x, 1e-6)
        << element;
  }
}

// A bar of nearly incompressible tissue is pulled to about twice its length, and keeps its volume.
TEST(Rest, FollowsGivenMotions) {
  Problem p = body_of({box_mesh({{0, 0, 0}, {0.6, 0.1, 0.1}}, {12, 2, 2})}, "neo_hookean");
  p.body.element = {"nodal"}, p.body.material.poisson_ratio = 0.499;
  p.body.fixed = {left_face()};
  p.body.prescribed = {
      {Box{{0.6, -1, -1}, {0.6, 1, 1}}, PathMotion{{{0, Point::Zero()}, {1, Point(0.6, 0, 0)}}}}};
  Simulation<Host> simulation(at_rest(p, 1e-5));
  advance(simulation, 10);
  EXPECT_LE(simulation.worst_residual(), 1e-5);
  const TetMesh& mesh = p.body.levels[0];
  const auto u = displacements(simulation, mesh);
  EXPECT_NEAR(volume_ratio(mesh, u), 1, 5e-3);
  double width = 0, first = 0, last = 0;
  for (std::size_t a = 0; a < u.size(); ++a) {
    const Point& at = mesh.vertices[a];
    const auto is = [&](double x, double y) {
      return std::abs(at[0] - x) + std::abs(at[1] - y) + std::abs(at[2] - 0.05) < 1e-9;
    };
    if (is(0.3, 0)) width -= u[a][1];
    if (is(0.3, 0.1)) width += 0.1 + u[a][1];
    if (is(0.25, 0.05)) first = 0.25 + u[a][0];
    if (is(0.35, 0.05)) last = 0.35 + u[a][0];
  }
  EXPECT_NEAR(width / 0.1, 1 / std::sqrt((last - first) / 0.1), 0.01);
}

/// Nothing but the plane under it holds the cube, a millimetre away at the start.
Problem cube_over_a_plane(double gravity) {
  Problem p = body_of({box_mesh(decimetre, {3, 3, 3})}, "neo_hookean");
  p.body.surface = boundary_surface(p.body.levels[0]).surface;
  p.contact.obstacles.push_back({PlaneOptions{{0, 0, -1e-3}, {0, 0, 1}}, {}, {}});
  p.gravity = {0, 0, gravity};
  return p;
}

TEST(Rest, LiesOnAnObstacle) {
  Simulation<Host> simulation(at_rest(cube_over_a_plane(-9.81), 1e-5));
  advance(simulation, 10);
  const double weight = 1000 * 1e-3 * 9.81;
  EXPECT_NEAR(simulation.wrenches()[0].force[2], weight, 1e-3 * weight);
  EXPECT_GT(simulation.contact_depths()[0], 0);
}

// An obstacle that presses a held cube from above bears what holds it from below.
TEST(Rest, IsPressedByAnObstacleThatMoves) {
  Problem p = body_of({box_mesh(decimetre, {4, 4, 4})}, "neo_hookean");
  p.body.surface = boundary_surface(p.body.levels[0]).surface;
  p.body.fixed = {Box{{-1, -1, 0}, {1, 1, 0}}};
  p.contact.obstacles.push_back({PlaneOptions{{0, 0, 0.101}, {0, 0, -1}},
                                 {},
                                 PathMotion{{{0, Point::Zero()}, {1, Point(0, 0, -0.011)}}}});
  const double E = p.body.material.young_modulus;
  Simulation<Host> simulation(at_rest(p, 1e-5));
  advance(simulation, 10);
  const double force = -simulation.wrenches()[0].force[2];
  // a tenth shorter; held below and free to slide above, it is stiffer than a bar
  EXPECT_GT(force, 0.1 * E * 0.01);
  EXPECT_LT(force, 0.2 * E * 0.01);
}

// A sphere touches faces between their corners. The place of contact moves along a face that gives
// way, so that stages without damping go to and fro. The force is near Hertz's, for a block that is
// not much larger than the sphere.
TEST(Rest, IsPressedByASphereBetweenPoints) {
  const double radius = 0.03, depth = 0.02, E = 10e3, nu = 0.45;
  Problem p = body_of({box_mesh(decimetre, {4, 4, 4})}, "neo_hookean");
  p.body.surface = boundary_surface(p.body.levels[0]).surface;
  p.body.element = {"nodal"};
  p.body.material.young_modulus = E, p.body.material.poisson_ratio = nu;
  p.body.fixed = {Box{{-1, -1, 0}, {1, 1, 0}}};
  p.contact.obstacles.push_back(
      {SphereOptions{{0.056, 0.047, 0.101 + radius}, radius},
       {},
       PathMotion{{{0, Point::Zero()}, {1, Point(0, 0, -0.001 - depth)}}}});
  Simulation<Host> simulation(at_rest(p, 1e-5));
  double last = 0;
  for (int step = 0; step < 10; ++step) {
    advance(simulation, 1);
    const double force = -simulation.wrenches()[0].force[2];
    EXPECT_GT(force, last) << step;
    last = force;
  }
  EXPECT_LE(simulation.worst_residual(), 1e-5);
  const double hertz = 4 * E / (3 * (1 - nu * nu)) * std::sqrt(radius) * std::pow(depth, 1.5);
  EXPECT_NEAR(last, hertz, 0.25 * hertz);
}

// Relaxed stress is that of a softer shape and the same volume.
TEST(Rest, IsThatOfTheRelaxedMaterial) {
  Problem p = hanging_beam("linear", 0.3);
  const double E = p.body.material.young_modulus, mu = E / 2.6, kappa = E / 1.2, left = 0.6;
  p.body.material.prony = {{0.3, 0.1}, {0.1, 1e4}};
  const auto got = rest_of(at_rest(p));
  p.body.material.prony.clear();
  const double soft = left * mu;
  p.body.material.young_modulus = 9 * kappa * soft / (3 * kappa + soft);
  p.body.material.poisson_ratio = (3 * kappa - 2 * soft) / (2 * (3 * kappa + soft));
  const auto want = rest_of(at_rest(p));
  EXPECT_LE(largest_difference(got, want), 1e-4 * largest(want));
}

// Masses and damping have no part in it.
TEST(Rest, DependsOnNoMass) {
  Problem p = hanging_beam("nodal", 0.4);
  const auto want = rest_of(at_rest(p));
  p.body.material.density = 30, p.body.damping = {100, 0.1};
  EXPECT_LE(largest_difference(rest_of(at_rest(p)), want), 1e-5 * largest(want));
}

TEST(Rest, GoesOnFromASavedState) {
  Problem p = at_rest(hanging_beam("nodal", 0.495), 1e-5);
  Simulation<Host> whole(p), resumed(p);
  advance(whole, 4);
  resumed.restore(whole.save());
  advance(whole, 3), advance(resumed, 3);
  EXPECT_TRUE(same_bits(whole.positions(), resumed.positions()));
}

TEST(Rest, EndsWhereThereIsNoEquilibrium) {
  // gravity lifts the cube off the plane, which does not hold it
  Simulation<Host> simulation(at_rest(cube_over_a_plane(9.81), 1e-5));
  const auto bad = simulation.step_checked();
  ASSERT_TRUE(bad.has_value());
  EXPECT_EQ(bad->kind, "solver");
  EXPECT_GE(bad->vertex, 0);
  EXPECT_NE(bad->text().find("no equilibrium was found"), std::string::npos) << bad->text();
}

// A thick tube of neo-Hookean tissue bears no pressure above about mu log(outer/inner radius) where
// it is long: there its radius has no bound. It is at rest up to some part of the load.
TEST(Rest, EndsBeyondALimitLoad) {
  const double mu = 10e3;
  Tube tube;
  tube.radius = 0.02, tube.wall = 0.01, tube.length = 0.12, tube.around = 8, tube.across = 1,
  tube.along = 6;
  Problem p = body_of({tube_mesh(tube)}, "neo_hookean");
  p.body.material.young_modulus = 2.8 * mu, p.body.material.poisson_ratio = 0.4;
  p.body.fixed = {GroupSelection{"inlet"}, GroupSelection{"outlet"}};
  p.body.loads = {{GroupSelection{"lumen"}, FollowerPressure{5 * mu}, {}}};
  Simulation<Host> simulation(at_rest(p, 1e-5));
  std::optional<Diagnosis> bad;
  while (!bad && simulation.time() < 1) bad = simulation.step_checked();
  ASSERT_TRUE(bad.has_value());
  EXPECT_EQ(bad->kind, "solver") << bad->text();
  simulation.return_to_last_good();
  EXPECT_LT(simulation.time(), 0.5);
}

TEST(Rest, RefusesWhatHasNoRest) {
  const auto said = [](const Problem& p) { return refusal([&] { Simulation<Host> made(p); }); };
  Problem p = at_rest(small_cube("neo_hookean"));
  EXPECT_TRUE(said(p).starts_with("integration.cycle is rest, but nothing holds")) << said(p);
  p.body.fixed = {left_face()};
  EXPECT_EQ(said(p), "");
  Problem moving = p;
  moving.body.initial.velocity = {1, 0, 0};
  EXPECT_TRUE(said(moving).starts_with("body.initial")) << said(moving);
  Problem integrated = p;
  integrated.integration.integrator = {"newmark"};
  EXPECT_TRUE(said(integrated).starts_with("integration.integrator is newmark"))
      << said(integrated);
  Problem fixed = p;
  fixed.integration.implicit.iterations = 5;
  EXPECT_TRUE(said(fixed).starts_with("integration.implicit.iterations is 5")) << said(fixed);
  p.body.damping.mass = 1;
  EXPECT_EQ(other_doubts(p).size(), 1u);
}

}  // namespace
