// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/core/error.hpp>
#include <plica/drivers/body/masses.hpp>
#include <plica/drivers/methods/methods.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/kernels/time/energies.hpp>
#include <plica/kernels/time/stage_kernels.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/files/mesh_files.hpp>

#include <plica/drivers/study/level_probe.hpp>
#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// Implicit steps by Newton's method: what they solve, how far, and what becomes of those they do
// not.
namespace {

using namespace plica;
using namespace plica::test;

Problem hanging(const std::string& material, double step) {
  Problem p = body_of({jittered_box(beam_box, {8, 2, 2})}, material);
  p.body.fixed = {left_face()}, p.gravity = {0, 0, -9.81};
  p.integration.integrator = {"implicit_euler"}, p.integration.macro_step = step;
  p.integration.implicit.newton_iterations = 40, p.integration.implicit.relative_residual = 1e-8;
  return p;
}

// The slope of the incremental potential is the balance that the steps solve.
TEST(Newton, PotentialIsThatOfTheBalance) {
  Problem p = small_cube("neo_hookean", 2);
  p.gravity = {1, 2, -9.81}, p.body.damping.mass = 30, p.body.fixed = {left_face()};
  LevelProbe<Host> probe(p);
  Level<Host>& level = probe.at(0);
  const std::size_t n = probe.vertices();
  const plica::State<Host> base(device_field<Host>(random_field(n, 1e-3, 1)),
                                device_field<Host>(random_field(n, 1, 2)));
  const auto u = random_field(n, 3e-3, 3);
  auto change = random_field(n, 1, 4);
  for (std::size_t i = 0; i < n; ++i)
    if (p.body.levels[0].vertices[i][0] < 1e-9) change[i].setZero();
  const double a = 3e-4, b = 2e-2;  // not each other's square: as generalized_alpha has them
  const Vectors<Host> dead_loads("test.dead", n);
  level.dead_loads(0, dead_loads);
  const BlockSums<Host> blocks(static_cast<int>(level.partial.extent(0)));
  const Kokkos::View<double*, Host::Memory> result("test.result", 7);
  const auto at = [&](double t) {
    auto x = u, v = u;
    const auto base_u = to_host<Host>({}, base.u), base_v = to_host<Host>({}, base.v);
    for (std::size_t i = 0; i < n; ++i)
      x[i] += t * change[i], v[i] = base_v[i] + b / a * (x[i] - base_u[i]);
    level.state = {device_field<Host>(x), device_field<Host>(v)};
    level.linearise(level.state, 0, {a, b}, 0, level.f);
    reduce<Host, 7, StagePotential<Host>, Sums<7>>(
        {}, "test", static_cast<int>(n),
        StagePotential<Host>{{level.model, base, level.state, a, b},
                             level.f,
                             dead_loads,
                             device_field<Host>(change),
                             0},
        blocks, result);
    return std::array<double, 2>{result(0) + probe.elastic_energy(x), result(2)};
  };
  const double e = 1e-6, slope = (at(e)[0] - at(-e)[0]) / (2 * e);
  EXPECT_NEAR(at(0)[1], slope, 1e-6 * std::abs(slope));
}

TEST(Newton, MeetsItsTolerance) {
  for (const std::string& material : names(materials())) {
    Problem p = hanging(material, 0.05);
    p.integration.implicit.newton_tolerance = 1e-9, p.integration.on_failure = {0, "stop"};
    Simulation<Host> simulation(p);
    advance(simulation, 10);
    EXPECT_EQ(simulation.counters().at("newton_misses"), 0) << material;
  }
}

// A pull so sudden that full steps overshoot: the search shortens them, and the step is solved all
// the same.
TEST(Newton, SearchesAlongItsDirection) {
  Problem p = hanging("neo_hookean", 0.5);
  p.gravity = {0, 0, -200};
  p.integration.implicit.newton_iterations = 100;
  Simulation<Host> simulation(p);
  simulation.step();
  EXPECT_FALSE(simulation.check());
  EXPECT_GT(simulation.counters().at("line_searches"), 0);
  EXPECT_EQ(simulation.counters().at("newton_misses"), 0);
}

TEST(Newton, HalvesStepsItCannotSolve) {
  Problem p = hanging("st_venant_kirchhoff", 0.02);
  p.integration.implicit.newton_tolerance = 1e-6;
  Simulation<Host> solved(p);
  p.integration.implicit.newton_iterations = 2, p.integration.implicit.newton_tolerance = 1e-6;
  p.integration.on_failure.halvings = 8;
  Simulation<Host> halved(p);
  advance(solved, 10), advance(halved, 10);
  EXPECT_GT(halved.counters().at("step_halvings"), 0);
  EXPECT_EQ(halved.time(), solved.time());
  const auto a = displacements(halved, p.body.levels[0]),
             b = displacements(solved, p.body.levels[0]);
  // first order: smaller steps lose less energy
  EXPECT_LE(largest_difference(a, b), 0.1 * largest(b));
}

/// It falls on the ground.
Problem falling_liver() {
  Problem p = body_of({read_mesh(PLICA_SOURCE_DIR "/meshes/data/liver_coarse.msh")});
  const double lowest = bounding_box(p.body.levels[0].vertices).min[2];
  p.body.surface = boundary_surface(p.body.levels[0]).surface;
  p.contact.obstacles.push_back({PlaneOptions{{0, 0, lowest - 0.02}, {0, 0, 1}}, {}, {}});
  p.contact.stiffness_scale = 0.25;
  p.gravity = {0, 0, -9.81};
  p.integration.integrator = {"implicit_euler"}, p.integration.macro_step = 0.02;
  p.integration.implicit.newton_iterations = 10, p.integration.on_failure.halvings = 0;
  return p;
}

/// Its first step has no minimum near.
Problem mirrored(const FailureOptions& on_failure) {
  Problem p = small_cube("corotational");
  p.body.initial.stretch = {-1, 1, 1};
  p.integration.integrator = {"implicit_euler"}, p.integration.macro_step = 0.01;
  p.integration.implicit.newton_iterations = 10, p.integration.on_failure = on_failure;
  return p;
}

TEST(Newton, HalvingCompletesWhatAcceptingCompletes) {
  Simulation<Host> accepted(mirrored({0, "accept"})), halved(mirrored({}));
  advance(accepted, 25), advance(halved, 25);
  EXPECT_GT(accepted.counters().at("newton_misses"), 0);
  EXPECT_GT(halved.counters().at("step_halvings"), 0);
  EXPECT_FALSE(halved.check());
}

/// Tangents of it lead upwards.
Problem crushed() {
  Problem p = mirrored({0, "accept"});
  p.body.material.model = "st_venant_kirchhoff";
  p.body.initial.stretch = {0.3, 0.4, 0.5};
  p.integration.macro_step = 0.1;
  return p;
}

/// So do those of it.
Problem pressed() {
  Problem p = small_cube("neo_hookean");
  p.body.element = {"nodal"}, p.body.material.poisson_ratio = 0.3;
  p.body.loads = {{Box{{-1, -1, -1}, {1, 1, 1}}, FollowerPressure{3e4}, {}}};
  p.integration = crushed().integration;
  p.integration.implicit.solver = "conjugate_gradients";
  p.integration.implicit.preconditioner = "block_jacobi";
  return p;
}

// Once a tangent has led upwards, those of the next systems are projected, also in a run that goes
// on from a saved state.
TEST(Newton, GoesOnProjectingAfterASavedState) {
  long upwards = 0;
  for (const Problem& p : {crushed(), pressed()}) {
    Simulation<Host> whole(p);
    for (int n = 0; n < 15; ++n) {
      Simulation<Host> resumed(p);
      resumed.restore(whole.save());
      whole.step(), resumed.step();
      EXPECT_TRUE(same_bits(whole.positions(), resumed.positions())) << n;
      EXPECT_EQ(whole.counters(), resumed.counters()) << n;
    }
    upwards += whole.counters().at("cg_indefinite");
  }
  EXPECT_GT(upwards, 0);
}

// After a return to a kept state, steps are what they were the first time. Neither projected
// tangents nor smoothed pressures of steps that were taken back are left. Solvers that start from
// their last solutions would differ by rounding: these take a fixed number of iterations.
TEST(Newton, TakesStepsAgainAsTheFirstTime) {
  Problem projected = pressed(), smoothed = hanging("neo_hookean", 0.05);
  smoothed.body.element = {"nodal"}, smoothed.body.material.poisson_ratio = 0.49;
  smoothed.body.pressure = "smoothed";
  smoothed.integration.implicit.solver = "conjugate_gradients";
  smoothed.integration.implicit.preconditioner = "block_jacobi";
  projected.integration.implicit.iterations = smoothed.integration.implicit.iterations = 60;
  smoothed.integration.on_failure = {0, "accept"};
  constexpr std::size_t steps = 8;
  for (const Problem& p : {projected, smoothed}) {
    Simulation<Host> first(p), again(p);
    std::vector<std::vector<Point>> want;
    for (std::size_t n = 0; n < steps; ++n) first.step(), want.push_back(first.positions());
    const auto counters = first.counters();
    EXPECT_TRUE(counters.contains("pressure_updates") || counters.at("cg_indefinite") > 0);
    for (std::size_t n = 1; n <= steps; ++n) {
      for (std::size_t i = 0; i < n; ++i) again.step();
      EXPECT_TRUE(same_bits(again.positions(), want[n - 1])) << n;
      again.return_to_last_good();
    }
  }
}

// A fall that touches ground in steps as long as the impact: contact sets in without a jump, so
// that every step is solved.
TEST(Newton, SolvesAnImpact) {
  Simulation<Host> simulation(falling_liver());
  advance(simulation, 25);
  EXPECT_EQ(simulation.counters().at("newton_misses"), 0);
  EXPECT_GT(simulation.counters().at("newton_iterations"), 25);
}

// An organ that swings by its own length under its weight, in steps of 40 critical ones. One linear
// solve a step turns it inside out.
TEST(Newton, HoldsAnOrganThatSwings) {
  Problem p = body_of({read_mesh(PLICA_SOURCE_DIR "/meshes/data/organs/liver.vtk")}, "neo_hookean");
  p.body.element = {"nodal"}, p.body.material.young_modulus = 3e3,
  p.body.material.poisson_ratio = 0.4;
  p.body.fixed = {Box{{-1, -1, -1}, {-0.05, 1, 1}}}, p.body.damping.mass = 2,
  p.gravity = {9.81, 0, 0};
  p.integration.macro_step = 20e-3;
  for (const char* integrator : {"implicit_euler", "bdf2"}) {
    p.integration.integrator = {integrator};
    Simulation<Host> simulation(p);
    advance(simulation, 20);
    const auto bad = simulation.check();
    EXPECT_FALSE(bad) << integrator << ": " << bad->text();
    EXPECT_EQ(simulation.counters().at("newton_misses"), 0) << integrator;
    EXPECT_GT(largest(displacements(simulation, p.body.levels[0])), 0.05) << integrator;
  }
}

// |v1 - v0|^2/2 in the masses' norm and the potential energy after a step of backward Euler are no more than all energy before it: a step
// that lowers the incremental potential cannot explode, however long it is.
TEST(Newton, AcceptsNoStepThatExplodes) {
  for (const double step : {0.01, 0.1, 1.0}) {
    Problem p = hanging("neo_hookean", step);
    p.body.element = {"nodal"}, p.body.initial.stretch = {0.6, 1, 1}, p.gravity = {0, 0, -50};
    p.integration.implicit.newton_iterations = 0, p.integration.on_failure.halvings = 0;
    Simulation<Host> simulation(p);
    const auto mass = lumped_masses(p.body.levels[0], {p.body.material.density});
    for (int n = 0; n < 5; ++n) {
      const double before = simulation.energies().total();
      const auto v0 = simulation.velocities();
      simulation.step();
      const Energies after = simulation.energies();
      const auto v1 = simulation.velocities();
      double change = 0;
      for (std::size_t a = 0; a < mass.size(); ++a)
        change += mass[a] * (v1[a] - v0[a]).squaredNorm() / 2;
      EXPECT_LE(after.total() - after.kinetic + change, before + 1e-9 * std::abs(before))
          << step << " " << n;
    }
  }
}

TEST(Newton, StoppingEndsTheRun) {
  Simulation<Host> simulation(mirrored({0, "stop"}));
  std::optional<Diagnosis> bad;
  for (int n = 0; n < 25 && !bad; ++n) simulation.step(), bad = simulation.check();
  ASSERT_TRUE(bad);
  EXPECT_EQ(bad->kind, "solver");
  EXPECT_NE(bad->text().find("a step was not solved"), std::string::npos) << bad->text();
}

/// A clamped beam that is let go stretched by 2 % swings for 5 s: the largest change of its energy
/// over that at the start.
double energy_error(const std::string& integrator, const std::string& material,
                    int newton_iterations) {
  Problem p = body_of({jittered_box(beam_box, {8, 2, 2})}, material);
  p.body.fixed = {left_face()}, p.body.initial.stretch = {1.02, 1, 1};
  p.integration.integrator = {integrator}, p.integration.macro_step = 0.01;
  p.integration.implicit.rho_infinity = 1,
  p.integration.implicit.newton_iterations = newton_iterations;
  Simulation<Host> simulation(p);
  const double start = simulation.energies().total();
  double error = 0;
  while (simulation.time() < 5) {
    advance(simulation, 10);
    error = std::max(error, std::abs(simulation.energies().total() / start - 1));
  }
  return error;
}

TEST(Newton, IsIteratedWhereASolveIsNoFixedWork) {
  ImplicitOptions options;
  for (const char* integrator :
       {"implicit_euler", "bdf2", "sdirk2", "newmark", "generalized_alpha"})
    EXPECT_EQ(newton_iterations(options, integrator), 20) << integrator;
  EXPECT_EQ(newton_iterations(options, "v_cycle_euler"), 1);
  options.iterations = 25;
  EXPECT_EQ(newton_iterations(options, "bdf2"), 1);
  EXPECT_EQ(newton_iterations(options, "newmark"), 20);  // or energy is lost
  options.newton_iterations = 3;
  EXPECT_EQ(newton_iterations(options, "newmark"), 3);
}

// Not exactly, as motion is not linear. One iteration loses 9 %, and a quarter in 20 s.
TEST(Newton, LongSwingsKeepTheirEnergy) {
  constexpr int by_default = 0;
  for (const char* integrator : {"newmark", "generalized_alpha"})
    EXPECT_LE(energy_error(integrator, "neo_hookean", by_default), 0.01) << integrator;
  EXPECT_GE(energy_error("newmark", "neo_hookean", 1), 0.08);
}

TEST(Newton, RefusesWhatMakesNoSense) {
  Problem p = hanging("linear", 0.01);
  p.integration.on_failure.unsolved = "stopp";
  EXPECT_THROW(Simulation<Host>{p}, InputError);
  p = hanging("linear", 0.01), p.integration.implicit.tangent = "positve";
  EXPECT_THROW(Simulation<Host>{p}, InputError);
  p = hanging("linear", 0.01), p.integration.implicit.rho_infinity = 1.5;
  EXPECT_THROW(Simulation<Host>{p}, InputError);
}

}  // namespace
