// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// A free body that deforms strongly: nothing inside can change its linear momentum.
namespace {

using namespace plica;
using namespace plica::test;

std::vector<double> masses(const TetMesh& mesh, double density) {
  std::vector<double> m(mesh.vertices.size(), 0);
  for (const auto& t : mesh.tets) {
    const auto x = [&](std::size_t k) { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
    for (int v : t) m[static_cast<std::size_t>(v)] += density * tet_volume(x(0), x(1), x(2), x(3)) / 4;
  }
  return m;
}

template <class B>
class Momentum : public testing::Test {};
TYPED_TEST_SUITE(Momentum, EachBackend);

TYPED_TEST(Momentum, OfAFreeBodyStays) {
  using Real = typename TypeParam::Real;
  const bool fine = std::is_same_v<Real, double>;
  for (const std::string& material : names(materials()))
    for (const char* integrator : {"symplectic_euler", "rk4", "implicit_euler"}) {
      SCOPED_TRACE(material + " " + integrator);
      Problem p = small_cube(material, 4);  // more than one patch
      const TetMesh& mesh = p.body.levels[0];
      p.integration.integrator = {integrator};
      p.integration.macro_step = 5e-4;
      p.integration.implicit.relative_residual = fine ? 1e-13 : 1e-6;
      p.integration.implicit.newton_iterations = 2;
      Simulation<TypeParam> simulation(p);
      const auto start = random_field(mesh.vertices.size(), 0.5, 3);
      simulation.set_state(random_field(mesh.vertices.size(), 0.001, 2), start);
      const auto m = masses(mesh, 1000);
      const auto momentum = [&] {
        const auto v = simulation.velocities();
        Point sum = Point::Zero();
        for (std::size_t a = 0; a < v.size(); ++a) sum += m[a] * v[a];
        return sum;
      };
      const Point before = momentum();
      advance(simulation, 40);
      EXPECT_GT(largest_difference(simulation.velocities(), start), 0.1);  // it did move
      EXPECT_LE((momentum() - before).norm(), round_off<Real>(1000, 0.5)) << before.transpose();
    }
}

// Explicit symplectic steps conserve angular momentum about a fixed point too (central internal forces).
TEST(Momentum, AngularStaysUnderSymplecticEuler) {
  Problem p = small_cube();
  const TetMesh& mesh = p.body.levels[0];
  p.integration.macro_step = 5e-4;
  p.body.initial.angular_velocity = {3, -2, 5};
  Simulation<Host> simulation(p);
  const auto m = masses(mesh, 1000);
  const auto angular = [&] {
    const auto x = simulation.positions(), v = simulation.velocities();
    Point sum = Point::Zero();
    for (std::size_t a = 0; a < v.size(); ++a) sum += m[a] * x[a].cross(v[a]);
    return sum;
  };
  const Point before = angular();
  advance(simulation, 200);
  EXPECT_LE((angular() - before).norm(), round_off<double>(1000, before.norm()));
}

}  // namespace
