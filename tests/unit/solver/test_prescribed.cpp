// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/drivers/solver/registry.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// Prescribed vertices are where their motion says, on every level at that level's own time.
namespace {

using namespace plica;
using namespace plica::test;

const Point speed{0.2, -0.1, 0.05};

Problem pulled(Problem p) {
  p.body.prescribed = {{left_face(), speed}};
  return p;
}

template <class B>
class Prescribed : public testing::Test {};
TYPED_TEST_SUITE(Prescribed, EachBackend);

template <class B>
void expect_there(const Simulation<B>& simulation, const Problem& p, int level, double time) {
  const TetMesh& mesh = p.body.levels[static_cast<std::size_t>(level)];
  const auto u = displacements(simulation, mesh, level), v = simulation.velocities(level);
  int found = 0;
  for (std::size_t a = 0; a < u.size(); ++a)
    if (mesh.vertices[a][0] == 0) {
      ++found;
      EXPECT_LE((u[a] - time * speed).norm(), round_off<typename B::Real>(50, 0.1)) << "level " << level;
      EXPECT_LE((v[a] - speed).norm(), round_off<typename B::Real>(2)) << "level " << level;
    }
  EXPECT_GT(found, 3);
}

TYPED_TEST(Prescribed, IsExactForEveryIntegrator) {
  for (const std::string& integrator : names(integrators())) {
    SCOPED_TRACE(integrator);
    Problem p = pulled(small_cube());
    p.body.damping.mass = 10;
    p.integration.integrator = {integrator};
    p.integration.macro_step = 5e-4;
    p.integration.substeps = {3};
    p.integration.allow_unstable = true;
    Simulation<TypeParam> simulation(p);
    advance(simulation, 50);
    expect_there(simulation, p, 0, simulation.time());
  }
}

TYPED_TEST(Prescribed, IsOnEveryLevelAtItsOwnTime) {
  for (const std::string& cycle : names(cycles())) {
    if (cycle == "single") continue;
    SCOPED_TRACE(cycle);
    Problem p = pulled(cube_levels(3, 4, cycle));
    p.body.damping.mass = 50;
    p.integration.distribution = "custom", p.integration.shares = {0.2, 0.3, 0.5};
    p.integration.macro_step = 4e-4;
    Simulation<TypeParam> simulation(p);
    advance(simulation, 20);
    const double before = simulation.time() - 4e-4;
    expect_there(simulation, p, 2, before + 0.5 * 4e-4);
    expect_there(simulation, p, 1, before + 0.8 * 4e-4);
    expect_there(simulation, p, 0, simulation.time());
  }
}

// A body whose one side is pulled follows, at first by elastic forces only.
TEST(Prescribed, PullsTheBodyAlong) {
  for (const char* integrator : {"symplectic_euler", "implicit_euler"}) {
    Problem p = pulled(small_cube());
    p.body.damping.mass = 20;
    p.integration.integrator = {integrator};
    p.integration.macro_step = 1e-3;
    p.integration.substeps = {0};
    Simulation<Host> simulation(p);
    advance(simulation, 1500);
    for (const Point& v : simulation.velocities()) EXPECT_LE((v - speed).norm(), 0.02) << integrator;
  }
}

TEST(Prescribed, FixedIsNotPrescribed) {
  Problem p = pulled(small_cube());
  p.body.fixed = {left_face()};
  EXPECT_ANY_THROW(Simulation<Host>{p});
}

}  // namespace
