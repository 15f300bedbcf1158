// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/drivers/solver/registry.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/boundary_triangles.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// Every cycle on one to five levels, nested and not, with and without contact.
namespace {

using namespace plica;
using namespace plica::test;

template <class B>
class CycleMatrix : public testing::Test {};
TYPED_TEST_SUITE(CycleMatrix, EachBackend);

/// Nested: the coarsest level is one cell, every finer one halves the edges. Otherwise 6, 5, 4 ... cells, moved at random.
Problem cube(int levels, bool nested) {
  Problem p = cube_levels(levels, 6, "single");
  for (int i = 0; nested && i < levels; ++i) {
    const int cells = 1 << (levels - 1 - i);
    p.body.levels[static_cast<std::size_t>(i)] = box_mesh(decimetre, {cells, cells, cells});
  }
  return p;
}

/// A quarter of the finest level's critical step in all.
double small_step(Problem p) {
  p.integration.cycle = "single", p.integration.macro_step.reset();
  return 0.25 * Simulation<Host>(p).levels()[0].critical_step;
}

template <class Act>
void for_each_hierarchy(const Act& act) {
  for (const bool nested : {true, false})
    for (int levels = 1; levels <= 5; ++levels) {
      SCOPED_TRACE(std::string(nested ? "nested, " : "not nested, ") + std::to_string(levels) + " levels");
      act(cube(levels, nested));
    }
}

TYPED_TEST(CycleMatrix, TranslatesExactly) {
  using Real = typename TypeParam::Real;
  for_each_hierarchy([](Problem p) {
    p.body.initial.velocity = {1, -2, 0.5};
    p.integration.macro_step = small_step(p);
    for (const std::string& cycle : names(cycles())) {
      p.integration.cycle = cycle;
      Simulation<TypeParam> simulation(p);
      EXPECT_EQ(simulation.levels().size(), cycle == "single" ? 1 : p.body.levels.size());
      advance(simulation, 5);
      const Point want = simulation.time() * p.body.initial.velocity;
      for (const Point& u : displacements(simulation, p.body.levels[0]))
        EXPECT_LE((u - want).norm(), round_off<Real>(500, 0.1)) << cycle;
      for (const Point& v : simulation.velocities())
        EXPECT_LE((v - p.body.initial.velocity).norm(), round_off<Real>(2000, 2)) << cycle;
    }
  });
}

// A cube that turns lands on a floor, its lowest vertices a tenth of a millimetre deep in it.
TYPED_TEST(CycleMatrix, StaysSoundInContact) {
  for_each_hierarchy([](Problem p) {
    p.gravity = {0, 0, -9.81};
    p.body.initial.velocity = {0, 0, -0.2};
    p.body.initial.angular_velocity = {1, 0, 2};
    p.body.surface = boundary_surface(p.body.levels[0]).surface;
    p.contact.obstacles.push_back({PlaneOptions{{0, 0, 1e-4}, {0, 0, 1}}, 0.3, {}});
    p.integration.macro_step = small_step(p);
    std::vector<Point> single;
    for (const std::string& cycle : names(cycles())) {
      p.integration.cycle = cycle;
      Simulation<TypeParam> simulation(p);
      advance(simulation, 10);
      EXPECT_GT(simulation.energies().contact, 0) << cycle;
      EXPECT_LT(largest(displacements(simulation, p.body.levels[0])), 0.5 * simulation.time()) << cycle;
      if (cycle == "single") single = simulation.positions();
      EXPECT_TRUE(p.body.levels.size() > 1 || cycle == "him" || same_bits(simulation.positions(), single)) << cycle;
    }
  });
}

}  // namespace
