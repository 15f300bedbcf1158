// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// A body that falls freely does not deform: every vertex follows its integrator's solution of u'' = g - c u'.
namespace {

using namespace plica;
using namespace plica::test;

/// One step of u, v for one vertex; the reference in long double.
using Stepper = void (*)(long double& u, long double& v, long double h, long double g, long double c);

void symplectic(long double& u, long double& v, long double h, long double g, long double c) {
  v = (v + h * g) / (1 + h * c);
  u += h * v;
}
void forward(long double& u, long double& v, long double h, long double g, long double c) {
  u += h * v;
  v += h * (g - c * v);
}
void runge_kutta(long double& u, long double& v, long double h, long double g, long double c) {
  long double du = 0, dv = 0, ku = 0, kv = 0;
  const long double ahead[4] = {0, 0.5L, 0.5L, 1}, weight[4] = {1, 2, 2, 1};
  for (int k = 0; k < 4; ++k) {
    const long double at = v + ahead[k] * h * kv;
    ku = at, kv = g - c * at;
    du += weight[k] * ku / 6, dv += weight[k] * kv / 6;
  }
  u += h * du, v += h * dv;
}

struct Case {
  const char* integrator;
  Stepper step;
};
const Case cases[] = {{"symplectic_euler", symplectic},
                      {"euler", forward},
                      {"rk4", runge_kutta},
                      {"implicit_euler", symplectic}};  // linear in v: backward Euler is the same here

template <class B>
class FreeFall : public testing::Test {};
TYPED_TEST_SUITE(FreeFall, EachBackend);

template <class B>
void expect_fall(const Case& c, double damping) {
  SCOPED_TRACE(std::string(c.integrator) + " damping " + std::to_string(damping));
  using Real = typename B::Real;
  Problem p = small_cube("neo_hookean");
  p.gravity = {1, 2, -9.81};
  p.body.damping.mass = damping;
  p.body.initial.velocity = {0.5, 0, 2};
  p.integration.integrator = {c.integrator};
  p.integration.macro_step = 2e-4;
  p.integration.substeps = {1};
  p.integration.allow_unstable = true;  // euler
  p.integration.implicit.relative_residual = std::is_same_v<Real, double> ? 1e-12 : 1e-6;
  Simulation<B> simulation(p);
  const int steps = 100;
  advance(simulation, steps);
  EXPECT_DOUBLE_EQ(simulation.time(), steps * 2e-4);
  Point u, v;
  for (int k = 0; k < 3; ++k) {
    long double x = 0, s = p.body.initial.velocity[k];
    for (int n = 0; n < steps; ++n) c.step(x, s, 2e-4L, p.gravity[k], damping);
    u[k] = static_cast<double>(x), v[k] = static_cast<double>(s);
  }
  const auto moved = displacements(simulation, p.body.levels[0]), speed = simulation.velocities();
  for (std::size_t a = 0; a < moved.size(); ++a) {
    EXPECT_LE((moved[a] - u).norm(), round_off<Real>(100, 0.1)) << a;
    EXPECT_LE((speed[a] - v).norm(), round_off<Real>(2000, v.norm())) << a;
  }
}

TYPED_TEST(FreeFall, IsTheIntegratorsOwnParabola) {
  for (const Case& c : cases)
    for (double damping : {0.0, 5.0}) expect_fall<TypeParam>(c, damping);
}

TEST(FreeFall, ClosedFormOfSymplecticEuler) {
  Problem p = small_cube();
  p.gravity = {0, 0, -9.81};
  p.integration.macro_step = 3e-4;
  Simulation<Host> simulation(p);
  const int n = 50;
  advance(simulation, n);
  const double want = -9.81 * 3e-4 * 3e-4 * n * (n + 1) / 2;
  for (const Point& u : displacements(simulation, p.body.levels[0]))
    EXPECT_NEAR(u[2], want, round_off<double>(100, 0.1));
}

// Potential energy is -m g u, kinetic m v^2 / 2, elastic zero.
TYPED_TEST(FreeFall, EnergiesAreThoseOfAPoint) {
  using Real = typename TypeParam::Real;
  Problem p = small_cube();
  p.gravity = {0, 0, -10};
  p.body.initial.velocity = {1, 0, 0};
  p.integration.macro_step = 2e-4;
  Simulation<TypeParam> simulation(p);
  const double m = 1;  // (0.1 m)^3 at 1000 kg/m^3
  EXPECT_NEAR(simulation.energies().kinetic, 0.5 * m, round_off<Real>(20));
  EXPECT_EQ(simulation.energies().potential, 0);
  advance(simulation, 100);
  const double fall = 10 * 4e-8 * 100 * 101 / 2, speed = 10 * 100 * 2e-4;
  const Energies e = simulation.energies();
  EXPECT_NEAR(e.kinetic, 0.5 * m * (1 + speed * speed), round_off<Real>(2000));
  EXPECT_NEAR(e.potential, -m * 10 * fall, round_off<Real>(100));
  EXPECT_NEAR(e.elastic, 0, round_off<Real>(200, 20));
  EXPECT_EQ(e.contact, 0);
  EXPECT_DOUBLE_EQ(e.total(), e.kinetic + e.potential + e.elastic);
}

}  // namespace
