// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/drivers/methods/integrators.hpp>
#include <plica/drivers/study/level_probe.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// What the integrators say of themselves: energy, stiff motion, given motion, cycles.
namespace {

using namespace plica;
using namespace plica::test;

Problem ringing(const std::string& integrator, double steps_of_limit) {
  Problem p = small_cube("linear");
  const double limit = Simulation<Host>(p).levels()[0].critical_step;
  p.integration.integrator = {integrator}, p.integration.macro_step = steps_of_limit * limit;
  p.integration.implicit.relative_residual = 1e-11;
  return p;
}

/// Energy after steps of a clamped body that starts deformed at random, over that at the start.
double energy_left(Problem p, int steps) {
  p.body.fixed = {left_face()};
  Simulation<Host> simulation(p);
  auto u = random_field(p.body.levels[0].vertices.size(), 1e-5, 4);
  for (std::size_t a = 0; a < u.size(); ++a)
    if (p.body.levels[0].vertices[a][0] < 1e-9) u[a].setZero();
  simulation.set_state(u, std::vector<Point>(u.size(), Point::Zero()));
  const double before = simulation.energies().total();
  for (int n = 0; n < steps; ++n) simulation.step();
  return simulation.energies().total() / before;
}

TEST(Integrators, KeepTheEnergyTheySayTheyKeep) {
  EXPECT_NEAR(energy_left(ringing("central_difference", 0.3), 2000), 1, 0.05);  // wavers
  for (const double step : {0.3, 30.0})
    EXPECT_NEAR(energy_left(ringing("newmark", step), 200), 1, 1e-8) << step;
  Problem p = ringing("generalized_alpha", 30);
  p.integration.implicit.rho_infinity = 1;
  EXPECT_NEAR(energy_left(p, 200), 1, 1e-9);
}

TEST(Integrators, DampWhatIsTooFastForTheStep) {
  for (const char* integrator : {"implicit_euler", "bdf2", "sdirk2"})
    EXPECT_LT(energy_left(ringing(integrator, 1e4), 4), 1e-8) << integrator;
  for (const double rho : {0.2, 0.5, 0.9}) {
    Problem p = ringing("generalized_alpha", 1e4);
    p.integration.implicit.rho_infinity = rho;
    // n rho^n in amplitude: a double root
    const double a = energy_left(p, 10), b = energy_left(p, 20);
    EXPECT_NEAR(std::log(b / a) / 10, 2 * std::log(rho), 0.2) << rho;
  }
}

/// Where a clamped beam that starts stretched is after steps that grow and shrink as halved ones
/// do; `parts` of each.
std::vector<Point> after_changing_steps(const std::string& integrator, int parts) {
  Problem p = body_of({jittered_box(beam_box, {4, 2, 2})}, "neo_hookean");
  p.body.fixed = {left_face()};
  p.integration.integrator = {integrator}, p.integration.macro_step = 4e-3;
  p.integration.implicit.newton_tolerance = 1e-10, p.integration.implicit.relative_residual = 1e-12;
  LevelProbe<Host> probe(p);
  Level<Host>& level = probe.at(0);
  auto u = p.body.levels[0].vertices;
  for (Point& x : u) x = {0.02 * x[0], 0.05 * x[0], 0};
  level.state = {device_field<Host>(u), device_field<Host>(probe.zero())};
  double time = 0;
  for (const double factor : {1.0, 0.5, 0.5, 1.0, 2.0, 1.0, 0.25, 0.25, 0.5, 1.0, 2.0}) {
    const double h = factor * 4e-3 / parts;
    level.integrator->advance(level, time, h, parts), time += parts * h;
  }
  return to_host<Host>({}, level.state.u);
}

TEST(Integrators, HaveOrderTwoInStepsThatChange) {
  for (const char* integrator : {"bdf2", "sdirk2"}) {
    const auto exact = after_changing_steps(integrator, 128);
    const double coarse = largest_difference(after_changing_steps(integrator, 4), exact),
                 fine = largest_difference(after_changing_steps(integrator, 8), exact),
                 finer = largest_difference(after_changing_steps(integrator, 16), exact);
    EXPECT_GT(std::log2(coarse / fine), 1.5) << integrator;
    EXPECT_GT(std::log2(fine / finer), 1.7) << integrator;
  }
}

TEST(Integrators, FollowGivenMotionExactly) {
  for (const std::string& integrator : names(integrators())) {
    Problem p = small_cube("linear", 2);
    p.body.prescribed = {{left_face(), SineMotion{Point(0.01, 0, 0), 5, 0}}};
    p.integration.integrator = {integrator}, p.integration.macro_step = 1e-3,
    p.integration.allow_unstable = true;
    Simulation<Host> simulation(p);
    for (int n = 0; n < 20; ++n) simulation.step();
    const double want = 0.01 * std::sin(2 * M_PI * 5 * simulation.time());
    const auto u = displacements(simulation, p.body.levels[0]);
    for (std::size_t a = 0; a < u.size(); ++a)
      if (p.body.levels[0].vertices[a][0] < 1e-9) {
        EXPECT_NEAR(u[a][0], want, 1e-12) << integrator;
      }
  }
}

// A body at rest under given motion and gravity must not care which integrator carries it: falling
// is exact for order 2.
TEST(Integrators, FallFreely) {
  for (const std::string& integrator : names(integrators())) {
    Problem p = small_cube("corotational", 2);
    p.gravity = {0, 0, -10};
    p.integration.integrator = {integrator}, p.integration.macro_step = 1e-3,
    p.integration.allow_unstable = true;
    p.integration.implicit.relative_residual = 1e-12;
    Simulation<Host> simulation(p);
    for (int n = 0; n < 50; ++n) simulation.step();
    for (const Point& v : simulation.velocities()) EXPECT_NEAR(v[2], -0.5, 1e-8) << integrator;
    const bool first = integrator.find("euler") != std::string::npos;  // off by h v / 2
    for (const Point& u : displacements(simulation, p.body.levels[0]))
      EXPECT_NEAR(u[2], -0.0125, first ? 2.6e-4 : 1e-8) << integrator;
  }
}

// Every integrator on every level of every cycle that shares the step: a fall, from which the
// clamped side holds back and a step of first order is off by a tenth.
TEST(Integrators, WorkInCycles) {
  for (const std::string& cycle : sharing_cycles())
    for (const std::string& integrator : names(integrators())) {
      Problem p = cube_levels(2, 4, cycle);
      p.gravity = {0, 0, -9.81}, p.body.fixed = {left_face()}, p.body.damping.mass = 20;
      p.integration.integrator = {integrator};
      p.integration.macro_step = 5e-4, p.integration.allow_unstable = true;
      Simulation<Host> simulation(p);
      for (int n = 0; n < 40; ++n) simulation.step();
      EXPECT_FALSE(simulation.check()) << cycle << " " << integrator;
      EXPECT_NEAR(largest(displacements(simulation, p.body.levels[0])), 0.5 * 9.81 * 0.02 * 0.02,
                  4e-4)
          << cycle << " " << integrator;
    }
}

// What is carried from step to step is saved: the same bits after a restore.
TEST(Integrators, AreRestoredBitForBit) {
  for (const std::string& integrator : names(integrators())) {
    Problem p = small_cube("neo_hookean", 2);
    p.gravity = {0, 0, -9.81}, p.body.fixed = {left_face()};
    p.integration.integrator = {integrator}, p.integration.macro_step = 2e-4,
    p.integration.allow_unstable = true;
    Simulation<Host> one(p), two(p);
    for (int n = 0; n < 5; ++n) one.step();
    two.restore(one.save());
    for (int n = 0; n < 5; ++n) one.step(), two.step();
    EXPECT_EQ(one.positions(), two.positions()) << integrator;
    EXPECT_EQ(one.velocities(), two.velocities()) << integrator;
  }
}

// Halving the step divides the error at a fixed time by 2 to the order.

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
  // smooth, and no acceleration at the start at the clamped face
  for (std::size_t a = 0; a < u.size(); ++a) v[a] = mesh.vertices[a][0] * Point(0.5, 1, -2);
  Simulation<Host> simulation(p);
  simulation.set_state(u, v);
  advance(simulation, static_cast<int>(std::lround(0.016 / step)));
  return displacements(simulation, mesh);
}

/// Halving this step [s] shows the order that the integrator states, as a number and in words.
template <class Kind>
void expect_order(double step) {
  EXPECT_NE(std::string(Kind::summary).find("order " + std::to_string(Kind::order)),
            std::string::npos);
  constexpr double damping = 20;
  const auto reference = at_end("rk4", 2.5e-5, damping);
  const double coarse = largest_difference(at_end(Kind::name, step, damping), reference),
               fine = largest_difference(at_end(Kind::name, step / 2, damping), reference);
  EXPECT_NEAR(std::log2(coarse / fine), Kind::order, 0.1 * Kind::order) << coarse << " " << fine;
}

TEST(Order, SymplecticEuler) { expect_order<SymplecticEuler>(1e-4); }
TEST(Order, Euler) { expect_order<ForwardEuler>(5e-5); }
TEST(Order, ImplicitEuler) { expect_order<ImplicitEuler>(1e-4); }
TEST(Order, CentralDifference) { expect_order<CentralDifference>(2e-4); }
TEST(Order, Rk2) { expect_order<Rk2>(2e-4); }
TEST(Order, Newmark) { expect_order<Newmark>(2e-4); }
TEST(Order, Bdf2) { expect_order<Bdf2>(1e-4); }
TEST(Order, GeneralizedAlpha) { expect_order<GeneralizedAlpha>(1e-4); }
TEST(Order, Rk4) { expect_order<Rk4>(4e-4); }

// A body that falls freely does not deform: every vertex follows its integrator's solution of u'' =
// g - c u'.

/// One step of u, v for one vertex; the reference in long double.
using Stepper = void (*)(long double& u, long double& v, long double h, long double g,
                         long double c);

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
                      // linear in v: backward Euler is the same here
                      {"implicit_euler", symplectic}};

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

// A free body that deforms strongly: nothing inside can change its linear momentum.

std::vector<double> masses(const TetMesh& mesh, double density) {
  std::vector<double> m(mesh.vertices.size(), 0);
  for (const auto& t : mesh.tets) {
    const auto x = [&](std::size_t k) { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
    for (int v : t)
      m[static_cast<std::size_t>(v)] += density * tet_volume(x(0), x(1), x(2), x(3)) / 4;
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

// Explicit symplectic steps conserve angular momentum about a fixed point too (central internal
// forces).
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
