// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// Halving the step divides the error at a fixed time by 2 to the order.
namespace {

using namespace plica;
using namespace plica::test;

std::vector<Point> at_end(const std::string& integrator, double step, double damping) {
  Problem p = small_cube("neo_hookean", 2);
  p.integration.integrator = {integrator};
  p.integration.macro_step = step;
  p.integration.allow_unstable = true;
  p.integration.implicit.relative_residual = 1e-10;
  p.integration.implicit.newton_iterations = 5;
  p.integration.implicit.newton_tolerance = 1e-10;
  p.body.damping.mass = damping;
  p.body.fixed = {left_face()};
  const TetMesh& mesh = p.body.levels[0];
  std::vector<Point> u(mesh.vertices.size(), Point::Zero()), v(mesh.vertices.size(), Point::Zero());
  for (std::size_t a = 0; a < u.size(); ++a)  // smooth, and no acceleration at the start at the clamped face
    v[a] = mesh.vertices[a][0] * Point(0.5, 1, -2);
  Simulation<Host> simulation(p);
  simulation.set_state(u, v);
  advance(simulation, static_cast<int>(std::lround(0.016 / step)));
  return displacements(simulation, mesh);
}

void expect_order(const std::string& integrator, double step, double order, double damping) {
  const auto reference = at_end("rk4", 2.5e-5, damping);
  const double coarse = largest_difference(at_end(integrator, step, damping), reference),
               fine = largest_difference(at_end(integrator, step / 2, damping), reference);
  EXPECT_NEAR(std::log2(coarse / fine), order, 0.1 * order) << integrator << " " << coarse << " " << fine;
}

TEST(Order, SymplecticEulerIsFirst) { expect_order("symplectic_euler", 1e-4, 1, 20); }
TEST(Order, EulerIsFirst) { expect_order("euler", 5e-5, 1, 20); }
TEST(Order, ImplicitEulerIsFirst) { expect_order("implicit_euler", 1e-4, 1, 20); }
TEST(Order, CentralDifferenceIsSecond) { expect_order("central_difference", 2e-4, 2, 20); }
TEST(Order, Rk2IsSecond) { expect_order("rk2", 2e-4, 2, 20); }
TEST(Order, NewmarkIsSecond) { expect_order("newmark", 2e-4, 2, 20); }
TEST(Order, Bdf2IsSecond) { expect_order("bdf2", 1e-4, 2, 20); }
TEST(Order, GeneralizedAlphaIsSecond) { expect_order("generalized_alpha", 1e-4, 2, 20); }
TEST(Order, Rk4IsFourth) { expect_order("rk4", 4e-4, 4, 20); }

}  // namespace
