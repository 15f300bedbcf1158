// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/core/error.hpp>
#include <plica/drivers/study/level_probe.hpp>
#include <plica/meshes/generators.hpp>
#include <plica/meshes/mesh_quality.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// How a body starts, what is read from it and what is set.
namespace {

using namespace plica;
using namespace plica::test;

template <class B>
class BodyState : public testing::Test {};
TYPED_TEST_SUITE(BodyState, EachBackend);

TYPED_TEST(BodyState, StartsWhereAndAsFastAsItIsTold) {
  using Real = typename TypeParam::Real;
  Problem p = cube_levels(2, 4, "rs");
  p.body.initial.position = Point(1, 2, 3);
  p.body.initial.velocity = {0.1, 0.2, 0.3};
  p.body.initial.angular_velocity = {0, 0, 2};
  p.body.surface = sphere_surface({0.05, 0.05, 0.05}, 0.04, 1);
  Simulation<TypeParam> simulation(p);
  for (int level : {0, 1}) {
    const auto& mesh = p.body.levels[static_cast<std::size_t>(level)];
    const auto x = simulation.positions(level), v = simulation.velocities(level);
    for (std::size_t a = 0; a < x.size(); ++a) {
      const Point arm = mesh.vertices[a] - Point(0.05, 0.05, 0.05);
      EXPECT_LE((x[a] - arm - Point(1, 2, 3)).norm(), round_off<Real>(8, 4));
      EXPECT_LE((v[a] - Point(0.1, 0.2, 0.3) - Point(0, 0, 2).cross(arm)).norm(), round_off<Real>(20));
    }
  }
  const auto surface = simulation.surface_positions(), speed = simulation.surface_velocities();
  for (std::size_t i = 0; i < surface.size(); ++i) {
    const Point arm = p.body.surface->vertices[i] - Point(0.05, 0.05, 0.05);
    EXPECT_LE((surface[i] - arm - Point(1, 2, 3)).norm(), round_off<Real>(8, 4));
    EXPECT_LE((speed[i] - Point(0.1, 0.2, 0.3) - Point(0, 0, 2).cross(arm)).norm(), round_off<Real>(20));
  }
}

TYPED_TEST(BodyState, HasASurfaceOfItsOwn) {
  Problem p = small_cube();
  p.body.surface = sphere_surface({50, 50, 50}, 40, 1);  // as if in millimetres
  EXPECT_THROW(Simulation<TypeParam>{p}, InputError);
}

TYPED_TEST(BodyState, SetIsReadBackAndReachesTheCoarseLevels) {
  using Real = typename TypeParam::Real;
  for (const char* cycle : {"single", "rs", "rv", "rsv", "rsv_sv"}) {
    Problem p = cube_levels(2, 4, cycle);
    Simulation<TypeParam> simulation(p);
    Eigen::Matrix3d A;
    A << 0.1, 0.02, 0, -0.02, 0.05, 0.01, 0, 0, -0.1;
    std::vector<Point> u, v;
    for (const Point& x : p.body.levels[0].vertices) u.push_back(A * x), v.push_back(Point(1, 2, 3) + A * x);
    simulation.set_state(u, v);
    EXPECT_LE(largest_difference(displacements(simulation, p.body.levels[0]), u), round_off<Real>(4, 0.2));
    EXPECT_LE(largest_difference(simulation.velocities(), v), round_off<Real>(4, 4));
    if (std::string(cycle) == "single") continue;
    const auto coarse = displacements(simulation, p.body.levels[1], 1);
    for (std::size_t a = 0; a < coarse.size(); ++a)
      EXPECT_LE((coarse[a] - A * p.body.levels[1].vertices[a]).norm(), round_off<Real>(8, 0.2)) << cycle;
  }
}

TYPED_TEST(BodyState, SetOfAWrongLengthIsRefused) {
  Simulation<TypeParam> simulation(small_cube());
  const std::vector<Point> few(3, Point::Zero());
  EXPECT_THROW(simulation.set_state(few, few), InputError);
}

TYPED_TEST(BodyState, ReportsWhatWasDecided) {
  Problem p = cube_levels(2, 4, "rsv");
  p.integration.integrator = {"symplectic_euler", "implicit_euler"};
  p.integration.distribution = "custom", p.integration.shares = {0.25, 0.75};
  p.integration.substeps = {0, 2};
  p.integration.macro_step = 0.02;
  Simulation<TypeParam> simulation(p);
  const auto& r = simulation.levels();
  ASSERT_EQ(r.size(), 2u);
  EXPECT_EQ(r[0].vertices, 125);
  EXPECT_EQ(r[1].tets, 6 * 27);
  EXPECT_NEAR(r[0].mean_edge, mean_edge_length(p.body.levels[0]), 1e-12);
  EXPECT_NEAR(r[1].mass, 1, 1e-12);
  EXPECT_EQ(r[1].integrator, "implicit_euler");
  EXPECT_FALSE(r[1].explicit_integrator);
  EXPECT_EQ(r[1].substeps, 2);
  EXPECT_EQ(r[0].substeps, static_cast<int>(std::ceil(0.005 / (0.9 * r[0].critical_step))));
  EXPECT_EQ(simulation.macro_step(), 0.02);
  simulation.step();
  const auto counters = simulation.counters();
  EXPECT_EQ(counters.at("force_evaluations"), r[0].substeps + 2);
  EXPECT_EQ(counters.at("linear_solves"), 2);
  EXPECT_TRUE(simulation.stages().empty());
  simulation.time_stages(true);
  simulation.step();
  EXPECT_GT(simulation.stages().size(), 3u);
}

TEST(Implicit, ReachesItsResidualOrCountsAMiss) {
  Problem p = small_cube("corotational");
  p.body.initial.angular_velocity = {0, 0, 10};
  p.integration.integrator = {"implicit_euler"};
  p.integration.macro_step = 0.02;
  p.integration.implicit.solver = "conjugate_gradients";
  for (double tolerance : {1e-3, 1e-9}) {
    p.integration.implicit.relative_residual = tolerance;
    Simulation<Host> simulation(p);
    advance(simulation, 5);
    EXPECT_EQ(simulation.counters().at("cg_misses"), 0);
    EXPECT_LE(simulation.worst_residual(), tolerance);
    EXPECT_GT(simulation.worst_residual(), 0);
  }
  p.integration.implicit.max_iterations = 2;
  Simulation<Host> short_of(p);
  short_of.step();
  EXPECT_EQ(short_of.counters().at("cg_misses"), 1);
  EXPECT_GT(short_of.worst_residual(), 1e-9);
  p.integration.implicit.iterations = 3;
  Simulation<Host> exactly(p);
  exactly.step();
  EXPECT_EQ(exactly.counters().at("cg_iterations"), 3);
  EXPECT_EQ(exactly.counters().at("cg_misses"), 0);
}

// Newton's method to convergence solves the step's own equation M (v - v0) = h (f(u0 + h v) - c M v); a linear material
// takes one iteration.
void expect_step_solved(const std::string& material, int newton_iterations) {
  SCOPED_TRACE(material);
  Problem p = small_cube(material);
  p.gravity = {0, 0, -9.81};
  p.body.fixed = {left_face()};
  p.body.damping.mass = 3;
  p.integration.integrator = {"implicit_euler"};
  p.integration.macro_step = 0.01;
  p.integration.implicit = {
      .relative_residual = 1e-11, .newton_iterations = newton_iterations, .newton_tolerance = 1e-12};
  Simulation<Host> simulation(p);
  advance(simulation, 5);
  const auto v0 = simulation.velocities();
  advance(simulation, 1);
  const auto v = simulation.velocities();
  LevelProbe<Host> probe(p);
  const auto f = probe.force(displacements(simulation, p.body.levels[0]));
  const auto m = probe.mass(), inverse = probe.inverse_mass();
  for (std::size_t a = 0; a < v.size(); ++a)
    if (inverse[a] > 0) {
      EXPECT_LE((m[a] * (v[a] - v0[a]) - 0.01 * (f[a] - 3 * m[a] * v[a])).norm(), 1e-8 * 0.01 * 9.81) << a;
    }
}

TEST(Implicit, NewtonSolvesTheStep) { expect_step_solved("neo_hookean", 20); }
TEST(Implicit, OneIterationSolvesALinearStep) { expect_step_solved("linear", 1); }

}  // namespace
