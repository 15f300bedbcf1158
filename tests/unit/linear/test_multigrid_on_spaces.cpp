// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/drivers/linear/make_linear_solver.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/files/mesh_files.hpp>
#include <plica/meshes/organs.hpp>

#include "support/him_pieces.hpp"
#include "support/simulate.hpp"

// Multigrid over coarse spaces of one mesh, on meshes with slivers.
namespace {

using namespace plica;
using namespace plica::test;

TEST(Multigrid, RunsOnSpacesOfOneMesh) {
  Problem p = body_of({irregular_beam()}, "linear");
  p.body.fixed = {left_face()};
  p.gravity = {0, 0, -9.81};
  p.integration.integrator = {"implicit_euler"};
  p.integration.macro_step = 5e-3;
  p.integration.implicit.relative_residual = 1e-8;
  const auto iterations = [&](const char* preconditioner) {
    p.integration.implicit.preconditioner = preconditioner;
    Simulation<Host> simulation(p);
    advance(simulation, 4);
    return simulation.counters().at("cg_iterations") / 4;
  };
  const long multigrid = iterations("multigrid");
  EXPECT_LE(multigrid, 30);
  EXPECT_LE(3 * multigrid, iterations("block_jacobi"));
}

void expect_iterations_of_an_organ(const std::string& name, const MaterialOptions& material,
                                   long at_most) {
  Problem p = body_of({read_mesh(PLICA_SOURCE_DIR "/meshes/data/organs/" + name + ".vtk")});
  p.body.element = {"nodal"};
  p.body.material = material;
  p.body.fixed = {HalfSpaceSelection{{0, 0, 0}, {1, 0, 0}}};
  p.gravity = {0, 0, -9.81};
  p.integration.integrator = {"implicit_euler"};
  p.integration.macro_step = 10e-3;
  p.integration.implicit.preconditioner = "multigrid";
  Simulation<Host> simulation(p);
  advance(simulation, 2);
  EXPECT_EQ(simulation.counters().at("cg_misses"), 0);
  EXPECT_LE(simulation.counters().at("cg_iterations"), 2 * at_most)
      << "nu " << material.poisson_ratio;
}

// Spaces are fitted again for tangents that change, and pay where a system takes many iterations.
TEST(Multigrid, OverSpacesIsChosenForLongSteps) {
  Problem p = body_of({box_mesh(decimetre, {8, 8, 8})});
  p.integration.integrator = {"implicit_euler"}, p.integration.macro_step = 10e-3;
  const auto chosen = [&](double critical) {
    return linear_solver_parts(p, 0, true, "auto", critical).options;
  };
  EXPECT_EQ(chosen(1e-3).preconditioner, "block_jacobi");
  EXPECT_EQ(chosen(2e-4).preconditioner, "block_jacobi");
  EXPECT_EQ(chosen(9e-5).preconditioner, "multigrid");
  p.integration.implicit.newton_iterations = 1;
  EXPECT_EQ(chosen(1e-3).preconditioner, "block_jacobi");
  EXPECT_EQ(chosen(2e-4).preconditioner, "multigrid");
  p.integration.implicit.newton_iterations = 20, p.integration.implicit.relative_residual = 1e-8;
  EXPECT_EQ(chosen(2e-4).preconditioner, "multigrid");
}

// Its few slivers have the largest eigenvalues that the smoother has to know of.
TEST(Multigrid, SmoothsTheSliversOfAnOrgan) {
  expect_iterations_of_an_organ("ventricle", {"st_venant_kirchhoff", 20e3, 0.35, 1000}, 45);
}

// The liver is thick enough for that: by a polynomial in linear elements' matrix it takes 31
// and 63. The thin ventricle has the latter.
TEST(Multigrid, SmoothsNodalElementsByTheirOwnTangent) {
  expect_iterations_of_an_organ("liver", {"neo_hookean", 200e3, 0.45, 1000}, 12);
  expect_iterations_of_an_organ("liver", {"neo_hookean", 200e3, 0.49, 1000}, 25);
  expect_iterations_of_an_organ("ventricle", {"neo_hookean", 5e3, 0.45, 1000}, 32);
  expect_iterations_of_an_organ("ventricle", {"neo_hookean", 5e3, 0.49, 1000}, 67);
}

// A capsule that is drawn along a slab: contact begins and ends after the cycle was fitted. By the
// matrix of then it takes 154, and 3 systems are not solved.
TEST(Multigrid, OfNodalElementsKnowsOfContact) {
  Problem p = body_of({box_mesh({{0, 0, 0}, {0.12, 0.08, 0.04}}, {18, 12, 6})});
  p.body.element = {"nodal"};
  p.body.material = {"neo_hookean", 10e3, 0.45, 1000};
  p.body.fixed = {HalfSpaceSelection{{0, 0, 0}, {0, 0, 1}}};
  p.body.surface = boundary_surface(p.body.levels[0]).surface;
  const PathMotion way{{{0, {0, 0, 0}}, {0.1, {0, 0, -0.012}}, {0.2, {0.02, 0, -0.012}}}};
  p.contact.stiffness_scale = 10.0 / 16,
  p.contact.obstacles = {{CapsuleOptions{{0.04, 0.04, 0.05}, {0.04, 0.04, 0.15}, 8e-3}, 0.2, way}};
  p.integration.integrator = {"implicit_euler"};
  p.integration.macro_step = 5e-3;
  p.integration.implicit.preconditioner = "multigrid";
  Simulation<Host> simulation(p);
  advance(simulation, 40);
  const auto counts = simulation.counters();
  EXPECT_EQ(counts.at("cg_misses"), 0);
  EXPECT_LE(counts.at("cg_iterations"), 17 * counts.at("linear_solves"));
  // a solve of contact that has just changed takes more
  EXPECT_LE(counts.at("preconditioner_fits"), 30);
}

// Of nodal elements that stiffen exponentially, whose coarser levels are those of linear ones.
TEST(Multigrid, GivesWayWhereItDoesNotConverge) {
  Problem p = body_of(
      {tube_mesh(
          {.radius = 8e-3, .wall = 2e-3, .length = 4e-2, .around = 16, .across = 2, .along = 12})},
      "costa");
  p.body.element = {"nodal"};
  p.body.material.parameters["a"] = 10e3, p.body.material.parameters["bulk_modulus"] = 250e3;
  for (const char* name : {"b_ff", "b_ss", "b_nn", "b_fs", "b_fn", "b_sn"})
    p.body.material.parameters[name] = 1;
  p.body.material.fibres = FibreOptions{.axis = Point(0, 0, 1)};
  p.body.fixed = {GroupSelection{"inlet"}, GroupSelection{"outlet"}};
  p.body.loads = {{GroupSelection{"lumen"}, FollowerPressure{6e3}, RampCourse{0.6}}};
  p.integration.integrator = {"implicit_euler"};
  p.integration.macro_step = 15e-3;
  p.integration.implicit.preconditioner = "multigrid";
  Simulation<Host> simulation(p);
  advance(simulation, 40);
  EXPECT_EQ(simulation.counters().at("cg_misses"), 0);
  EXPECT_EQ(simulation.counters().at("preconditioner_given_up"), 1);
}

}  // namespace
