// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/drivers/solver/set_up/join_bodies.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/generators.hpp>

#include "any_order.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"

// Whole macro steps as a device might do them. What is right is known from the other tests, and from test_stored_values.cpp, which this
// program has, too.
namespace {

using namespace plica;
using namespace plica::test;

/// A cube that is thrown at a plane and slides on it.
Problem thrown(const std::string& cycle, int levels, const std::string& element) {
  Problem p = cube_levels(levels, 5, cycle);
  p.body.element = {element};
  p.body.material = {"neo_hookean", 20e3, 0.45, 1000};
  p.body.surface = boundary_surface(p.body.levels[0]).surface;
  p.body.initial.velocity = {0.3, 0, -0.5};
  p.body.initial.angular_velocity = {2, 0, 5};
  p.gravity = {0, 0, -9.81};
  p.contact.obstacles.push_back({PlaneOptions{{0, 0, -0.001}, {0, 0, 1}}, 0.3, {}});
  p.integration.macro_step = 5e-4;
  return p;
}

Problem viscous() {
  Problem p = thrown("single", 1, "nodal");
  p.body.material.prony = {{0.3, 0.01}, {0.2, 0.1}};
  p.body.damping.stiffness = 1e-4;
  return p;
}

Problem by_him() {
  Problem p = thrown("him", 1, "nodal");
  p.body.levels = {jittered_box(decimetre, {7, 7, 7})};
  p.body.coarsen.emplace();
  p.body.surface = boundary_surface(p.body.levels[0]).surface;
  return p;
}

/// By matrices; the first step is halved where it must be.
Problem implicit(const std::string& element, const std::string& preconditioner) {
  Problem p = thrown("single", 2, element);
  p.integration.cycle = "single", p.integration.integrator = {"implicit_euler"}, p.integration.macro_step = 2e-3;
  p.integration.implicit.solver = "conjugate_gradients";
  p.integration.implicit.preconditioner = preconditioner;
  return p;
}

/// Two cubes that meet, friction between them.
Problem collision() {
  std::vector<std::pair<std::string, Body>> cubes;
  for (const bool second : {false, true}) {
    Body one = thrown("rsv", 2, "linear").body;
    if (second)
      for (TetMesh& mesh : one.levels)
        for (Point& x : mesh.vertices) x += Point(0.02, 0.01, 0.101);
    one.surface = boundary_surface(one.levels[0]).surface;
    one.initial.velocity = {0, 0, second ? -1.0 : 1.0};
    cubes.emplace_back(second ? "second" : "first", one);
  }
  Problem p;
  p.body = join_bodies(cubes);
  p.contact.friction = 0.3, p.contact.self = true;
  p.integration.cycle = "rsv", p.integration.macro_step = 5e-4;
  return p;
}

std::vector<double> after_some_steps(const Problem& problem) {
  Simulation<Host> simulation(problem);
  advance(simulation, 12);
  EXPECT_GT(simulation.energies().contact, 0);
  std::vector<double> all;
  for (const auto& field : {simulation.positions(), simulation.velocities()})
    for (const Point& x : field) all.insert(all.end(), x.begin(), x.end());
  return all;
}

class Steps : public testing::TestWithParam<std::pair<const char*, Problem (*)()>> {};

// Sums of a team of another size are added in another order, by design: the bits are the same in any order of the teams.
TEST_P(Steps, AreTheSameInAnyOrder) {
  const Problem problem = GetParam().second();
  std::vector<double> by_one;
  for (const int team : {1, 2, 8}) {
    const auto want = [&] {
      const LikeDevice like(team, 0);
      return after_some_steps(problem);
    }();
    for (const unsigned order : {1U, 2U}) {
      const LikeDevice like(team, order);
      EXPECT_TRUE(same_bits(after_some_steps(problem), want)) << "teams of " << team << ", order " << order;
    }
    if (team == 1) by_one = want;
    double size = 0, difference = 0;
    for (std::size_t i = 0; i < want.size(); ++i)
      size = std::max(size, std::abs(want[i])), difference = std::max(difference, std::abs(want[i] - by_one[i]));
    EXPECT_LE(difference, 1e-8 * size) << "teams of " << team;
  }
}

INSTANTIATE_TEST_SUITE_P(LikeDevice, Steps,
                         testing::Values(std::pair{"explicit", +[] { return thrown("single", 1, "linear"); }},
                                         std::pair{"viscous", &viscous},
                                         std::pair{"rsv", +[] { return thrown("rsv", 3, "nodal"); }},
                                         std::pair{"fas", +[] { return thrown("fas", 3, "linear"); }},
                                         std::pair{"him", &by_him},
                                         std::pair{"implicit", +[] { return implicit("linear", "block_jacobi"); }},
                                         std::pair{"multigrid", +[] { return implicit("nodal", "multigrid"); }},
                                         std::pair{"collision", &collision}),
                         [](const auto& each) { return std::string(each.param.first); });

}  // namespace
