// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/files/mesh_files.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// Explicit steps whose number is automatic, of a body that stiffens beyond the limit it has at rest.
namespace {

using namespace plica;
using namespace plica::test;

/// A ball is pressed into a liver that is held on one side.
Problem pressed_liver() {
  Problem p = body_of({read_mesh(PLICA_SOURCE_DIR "/meshes/data/organs/liver.vtk")}, "neo_hookean");
  p.body.element = {"nodal"};
  p.body.material.young_modulus = 20e3, p.body.material.poisson_ratio = 0.45;
  p.body.fixed = {HalfSpaceSelection{{0, 0, 0}, {1, 0, 0}}};
  p.body.surface = boundary_surface(p.body.levels[0]).surface;
  p.gravity = {0, 0, -9.81};
  p.contact.obstacles.push_back({SphereOptions{{0.06, 0, 0.047}, 8e-3}, {}, SineMotion{{0, 0, -12e-3}, 2, 0}});
  return p;
}

TEST(ShorterSteps, AreTakenWhereTheBodyStiffens) {
  Simulation<Host> simulation(pressed_liver());
  simulation.end_at(0.2);
  while (simulation.time() < 0.2)
    if (const auto bad = simulation.step_checked()) FAIL() << bad->text();
  EXPECT_GE(simulation.counters().at("substep_halvings"), 1);

  Problem given = pressed_liver();  // a step that was asked for is not changed
  given.integration.macro_step = simulation.macro_step();
  given.integration.substeps = {1};
  Simulation<Host> stops(given);
  bool stopped = false;
  while (stops.time() < 0.2 && !stopped) stopped = stops.step_checked().has_value();
  EXPECT_TRUE(stopped);
  EXPECT_FALSE(stops.counters().contains("substep_halvings"));
}

TEST(ShorterSteps, GoOnAfterACheckpoint) {
  Simulation<Host> whole(pressed_liver()), second(pressed_liver());
  while (whole.counters().at("substep_halvings") == 0) ASSERT_FALSE(whole.step_checked());
  second.restore(whole.save());
  for (Simulation<Host>* one : {&whole, &second}) advance(*one, 30);
  EXPECT_EQ(second.counters().at("substep_halvings"), whole.counters().at("substep_halvings"));
  EXPECT_TRUE(same_bits(whole.positions(), second.positions()));
}

}  // namespace
