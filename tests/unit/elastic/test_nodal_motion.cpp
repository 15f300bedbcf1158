// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <plica/core/error.hpp>
#include <plica/drivers/study/level_probe.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// Nodal elements in motion: by every integrator, cycle and stepper, implicit solves, failures.
namespace {

using namespace plica;
using namespace plica::test;

/// An irregular clamped beam under gravity, of nodal elements.
Problem sagging_beam(int levels = 1, double poisson = 0.45) {
  std::vector<TetMesh> meshes;
  for (int i = 0; i < levels; ++i)
    meshes.push_back(jittered_box(beam_box, {12 - 4 * i, 3 - i, 3 - i}));
  Problem p = body_of(std::move(meshes), "neo_hookean");
  p.body.element = {"nodal"};
  p.body.material.poisson_ratio = poisson;
  p.body.fixed = {left_face()};
  p.gravity = {0, 0, -9.81};
  return p;
}

/// Level 0's displacement after 20 ms.
std::vector<Point> after(const Problem& p, double step) {
  Problem one = p;
  one.integration.macro_step = step;
  Simulation<Host> simulation(one);
  advance(simulation, static_cast<int>(std::lround(0.02 / step)));
  return displacements(simulation, p.body.levels[0]);
}

TEST(NodalMotion, EveryIntegratorFollowsTheSameMotion) {
  const Problem body = sagging_beam();
  Problem fine = body;
  fine.integration.integrator = {"rk4"};
  const auto want = after(fine, 1e-4);
  for (const std::string& integrator : names(integrators())) {
    SCOPED_TRACE(integrator);
    if (integrator == "euler") continue;  // grows visibly in a hundred steps
    Problem p = body;
    // as others do, invisibly
    p.integration.integrator = {integrator}, p.integration.allow_unstable = true;
    EXPECT_LE(largest_difference(after(p, 2e-4), want), 0.06 * largest(want));
  }
}

TEST(NodalMotion, EveryCycleRunsOnLevelsOfEitherElement) {
  const auto want = after(sagging_beam(), 1e-4);
  for (const std::string& cycle : names(cycles()))
    for (const std::vector<std::string>& element :
         {std::vector<std::string>{"nodal"}, {"nodal", "linear"}, {"linear", "nodal"}}) {
      SCOPED_TRACE(cycle + ", " + element.front() + "/" + element.back());
      Problem p = sagging_beam(2);
      p.body.element = element, p.integration.cycle = cycle;
      p.integration.macro_step.reset();
      Simulation<Host> simulation(p);
      EXPECT_EQ(simulation.levels()[0].element, element.front());
      while (simulation.time() < 0.02) advance(simulation, 1);
      // long steps, and what cycles do wrong
      const double sag = largest(displacements(simulation, p.body.levels[0]));
      EXPECT_GT(sag, 0.5 * largest(want));
      EXPECT_LT(sag, 5 * largest(want));
    }
}

TEST(NodalMotion, DampingByStiffnessTakesEnergyAway) {
  Problem p = sagging_beam();
  p.gravity = Point::Zero(), p.body.initial.velocity = {0, 0, 1};
  const auto left = [&](double damping) {
    Problem one = p;
    one.body.damping.stiffness = damping, one.integration.macro_step = 1e-4;
    Simulation<Host> simulation(one);
    advance(simulation, 200);
    return simulation.energies().total();
  };
  const double free = left(0), damped = left(1e-2);
  EXPECT_LT(damped, 0.95 * free);
  EXPECT_GT(damped, 0);
}

// 10 ms at nu 0.45
TEST(NodalMotion, MultigridPreconditionsImplicitSteps) {
  const auto iterations = [](const std::string& preconditioner) {
    Problem p = sagging_beam(2);
    p.integration.integrator = {"implicit_euler"}, p.integration.macro_step = 10e-3;
    p.integration.implicit.preconditioner = preconditioner,
    p.integration.implicit.relative_residual = 1e-8;
    p.integration.implicit.newton_iterations = 1;
    Simulation<Host> simulation(p);
    advance(simulation, 5);
    EXPECT_LE(simulation.worst_residual(), 1e-8);
    return simulation.counters().at("cg_iterations") / 5;
  };
  const long multigrid = iterations("multigrid");
  EXPECT_LE(multigrid, 32);
  EXPECT_GT(iterations("block_jacobi"), multigrid);
}

TEST(NodalMotion, NewtonsMethodSolvesAStepToItsTolerance) {
  Problem p = sagging_beam();
  p.integration.integrator = {"newmark"}, p.integration.macro_step = 5e-3;
  p.integration.on_failure = {0, "stop"}, p.integration.implicit.relative_residual = 1e-10;
  Simulation<Host> simulation(p);
  const double start = simulation.energies().total();
  advance(simulation, 40);
  const Energies e = simulation.energies();
  EXPECT_NEAR(e.total() - start, 0, 0.02 * e.kinetic + 0.02 * e.elastic);
}

/// A stiffer beam at nu 0.4999, whose implicit stages carry their pressures.
Problem incompressible_beam(const std::string& integrator, double step) {
  Problem p = sagging_beam(1, 0.4999);
  p.body.material.young_modulus = 100e3;
  p.integration.integrator = {integrator}, p.integration.macro_step = step;
  return p;
}

// of long steps that bend: with the pressures of the volumes in its tangent each of these blew up
// or was not solved
TEST(NodalMotion, ImplicitStepsOfNearlyIncompressibleBodiesAreSolved) {
  for (const std::string integrator :
       {"implicit_euler", "newmark", "bdf2", "sdirk2", "generalized_alpha"}) {
    for (const int most : {1, 20}) {
      // its explicit half does not know what is carried
      if (integrator == "newmark" && most == 1) continue;
      SCOPED_TRACE(integrator + ", at most " + std::to_string(most) + " of Newton's iterations");
      Problem p = incompressible_beam(integrator, 10e-3);
      p.integration.implicit.newton_iterations = most;
      Simulation<Host> simulation(p);
      advance(simulation, 15);
      // of a linear system, or the part of the forces that is unbalanced
      EXPECT_LE(simulation.worst_residual(),
                most == 1 ? p.integration.implicit.relative_residual : 3e-3);
      const auto counts = simulation.counters();
      EXPECT_EQ(counts.at("cg_misses"), 0);
      // 424 to 525, by block-Jacobi
      EXPECT_LE(counts.at("cg_iterations"), 1000 * counts.at("linear_solves"));
      EXPECT_EQ(counts.at("pressure_updates"), counts.at("linear_solves"));
      if (most == 1) continue;
      EXPECT_EQ(counts.at("newton_misses"), 0);
      EXPECT_LE(counts.at("newton_iterations"), 5 * 15 * 2);  // sdirk2 has two stages
    }
  }
}

TEST(NodalMotion, AtRestNearlyIncompressibleBodiesAreWhereExplicitStepsLeaveThem) {
  const auto at_rest = [](const std::string& integrator, double step, int newtons) {
    Problem p = incompressible_beam(integrator, step);
    p.body.damping.mass = 20, p.integration.implicit.newton_iterations = newtons;
    Simulation<Host> simulation(p);
    advance(simulation, static_cast<int>(std::lround(2 / step)));
    return displacements(simulation, p.body.levels[0]);
  };
  const auto want = at_rest("symplectic_euler", 6e-5, 1);
  for (const int newtons : {1, 20}) {
    SCOPED_TRACE(newtons);
    EXPECT_LE(largest_difference(at_rest("implicit_euler", 20e-3, newtons), want),
              1e-3 * largest(want));
  }
}

// A cube under pressure from all sides: Cauchy's stress is dU/dJ = -p, with kappa 50 p.
TEST(NodalMotion, ImplicitStepsKeepTheLawOfVolume) {
  constexpr double c10 = 3e3, c01 = 1e3, mu = 2 * (c10 + c01), part = 0.02;
  double J = 1;
  for (int i = 0; i < 40; ++i) J = std::exp(-part * J);  // ln J / J = -part
  for (const auto& [volume, want] :
       {std::pair{"simo_hughes", std::sqrt(1 + part * part) - part}, std::pair{"logarithmic", J},
        std::pair{"quadratic", 1 - part}}) {
    SCOPED_TRACE(volume);
    Problem p = small_cube("mooney_rivlin");
    p.body.element = {"nodal"}, p.body.material.volume = volume;
    p.body.material.parameters = {{"c10", c10}, {"c01", c01}, {"bulk_modulus", 100 * mu}};
    p.body.loads = {{Box{{-1, -1, -1}, {1, 1, 1}}, FollowerPressure{100 * mu * part}, {}}};
    p.integration.integrator = {"implicit_euler"}, p.integration.macro_step = 20e-3;
    p.integration.implicit.newton_iterations = 30, p.integration.implicit.newton_tolerance = 1e-8;
    Simulation<Host> simulation(p);
    advance(simulation, 30);
    EXPECT_GT(simulation.counters().at("pressure_updates"), 0);  // mixed dilatations
    for (const double ratio : simulation.element_fields().J) EXPECT_NEAR(ratio, want, 1e-6);
  }
}

TEST(NodalMotion, CarriedPressuresAreSaved) {
  const Problem p = incompressible_beam("newmark", 10e-3);
  Simulation<Host> one(p), other(p);
  advance(one, 3);
  other.restore(one.save());
  advance(one, 3);
  advance(other, 3);
  EXPECT_TRUE(same_bits(one.positions(), other.positions()));
}

TEST(NodalMotion, WhatNeedsAMatrixIsRefused) {
  for (const bool direct : {true, false}) {
    Problem p = sagging_beam();
    p.integration.integrator = {"implicit_euler"}, p.integration.macro_step = 1e-3;
    (direct ? p.integration.implicit.solver : p.integration.implicit.matrix) =
        direct ? "direct" : "assembled";
    try {
      Simulation<Host> simulation(p);
      ADD_FAILURE() << "accepted";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("nodal elements, whose matrix is not assembled"),
                std::string::npos)
          << error.what();
    }
  }
}

// the cycle is one of lambda = 2 mu at most, so its answer to a change of volume is thousands of
// times too large
TEST(NodalMotion, SmoothedPressuresAreNotSolvedByOneCycle) {
  Problem p = incompressible_beam("v_cycle_euler", 10e-3);
  try {
    Simulation<Host> simulation(p);
    ADD_FAILURE() << "accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("expected implicit_euler"), std::string::npos)
        << error.what();
  }
}

TEST(NodalMotion, AnInvertedVertexIsNamed) {
  Problem p = sagging_beam();
  p.integration.macro_step = 1e-4;
  Simulation<Host> simulation(p);
  auto u = std::vector<Point>(p.body.levels[0].vertices.size(), Point::Zero());
  const std::size_t corner = vertex_at(p.body.levels[0], {0.4, 0.1, 0.1});
  u[corner] = {-0.2, 0, 0};
  simulation.set_state(u, std::vector<Point>(u.size(), Point::Zero()));
  const auto bad = simulation.step_checked();
  ASSERT_TRUE(bad.has_value());
  EXPECT_EQ(bad->kind, "inverted");
  EXPECT_EQ(bad->element, -1);
  EXPECT_GE(bad->vertex, 0);
  EXPECT_LT(bad->J, 0);
  EXPECT_NE(bad->text().find("around a vertex are inside out: level 0, vertex"), std::string::npos)
      << bad->text();
}

TEST(NodalMotion, SavedStatesGoOnBitForBit) {
  Problem p = sagging_beam();
  p.integration.macro_step = 1e-4;
  Simulation<Host> one(p), other(p);
  advance(one, 10);
  const SavedState saved = one.save();
  advance(one, 10);
  other.restore(saved);
  advance(other, 10);
  EXPECT_TRUE(same_bits(one.positions(), other.positions()));
}

TEST(NodalMotion, FieldsArePerVertex) {
  Problem p = sagging_beam();
  p.integration.macro_step = 1e-4;
  Simulation<Host> simulation(p);
  const ElementFields fields = simulation.element_fields();
  EXPECT_TRUE(fields.per_vertex);
  EXPECT_EQ(fields.von_mises.size(), p.body.levels[0].vertices.size());
  for (const double J : fields.J) EXPECT_NEAR(J, 1, 1e-12);
}

}  // namespace
