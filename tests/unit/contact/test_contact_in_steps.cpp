// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <plica/core/row_ranges.hpp>
#include <plica/drivers/body/masses.hpp>
#include <plica/drivers/run/energy_meter.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/generators.hpp>
#include <plica/meshes/mesh_quality.hpp>
#include <random>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"
#include "support/watch.hpp"

// Contact that is implicit in explicit steps: it bounds no step, keeps what it must, and says what
// obstacles do.
namespace {

using namespace plica;
using namespace plica::test;

const std::vector<std::string> explicit_integrators = {"symplectic_euler", "central_difference",
                                                       "euler", "rk2", "rk4"};

Point mean(const std::vector<Point>& field) {
  Point sum = Point::Zero();
  for (const Point& x : field) sum += x;
  return sum / static_cast<double>(field.size());
}

/// A block over the plane z = 0, its boundary as surface.
Problem block(double gap, int cells = 4) {
  Problem p = body_of({box_mesh({{0, 0, gap}, {0.1, 0.1, 0.1 + gap}}, {cells, cells, cells})},
                      "corotational");
  p.body.surface = boundary_surface(p.body.levels[0]).surface;
  p.contact.obstacles.push_back({PlaneOptions{}, {}, {}});
  return p;
}

double along_x(const Simulation<Host>& s) { return mean(s.velocities())[0]; }

// --- Steps ---

TEST(ContactInSteps, BoundsNoStep) {
  for (const std::string& integrator : explicit_integrators) {
    Problem p = block(0);
    p.integration.integrator = {integrator};
    p.body.damping.mass = 5;  // euler and rk2 have no step without
    Problem free = p;
    free.contact.obstacles.clear();
    const double alone = Simulation<Host>(free).levels()[0].critical_step;
    for (const double scale : {1.0, 1e4}) {
      p.contact.stiffness_scale = scale;
      EXPECT_EQ(Simulation<Host>(p).levels()[0].critical_step, alone) << integrator;
    }
  }
}

TEST(ContactInSteps, TheCriticalStepDoesNotDependOnThePoints) {
  std::vector<double> steps;
  for (const int subdivisions : {1, 3, 4}) {
    Problem p = body_of({box_mesh(decimetre, {6, 6, 6})}, "neo_hookean");
    p.body.surface = sphere_surface({0.05, 0.05, 0.05}, 0.045, subdivisions);
    p.contact.obstacles.push_back({PlaneOptions{}, 0.3, {}});
    steps.push_back(Simulation<Host>(p).levels()[0].critical_step);
  }
  EXPECT_EQ(steps[0], steps[1]);
  EXPECT_EQ(steps[0], steps[2]);
}

// A block thrown at the floor at 0.95 of the limit of its elements, with contact from soft to all
// but rigid: the energy stays what was put in.
TEST(ContactInSteps, StayStableAtTheLimitOfTheElements) {
  for (const std::string& integrator : explicit_integrators)
    for (const double scale : {0.1, 1.0, 100.0, 1e6})
      for (const double damping : {0.0, 1.0}) {
        Problem p = block(0.005);
        p.body.material.model = "linear";  // the limit is that of any state
        p.body.initial.velocity = {0.1, 0, -0.5};
        p.gravity = {0, 0, -9.81};
        p.contact.obstacles[0].friction = 0.3;
        p.contact.stiffness_scale = scale, p.contact.damping_scale = damping;
        p.integration.integrator = {integrator};
        p.body.damping.mass = integrator == "euler" || integrator == "rk2" ? 100 : 0;
        p.integration.macro_step = 0.95 * Simulation<Host>(p).levels()[0].critical_step;
        Simulation<Host> simulation(p);
        const double start = simulation.energies().total();
        const int steps = static_cast<int>(std::min(1500.0, 0.15 / simulation.macro_step()));
        for (int n = 0; n < steps; ++n) simulation.step();
        const Energies e = simulation.energies();
        EXPECT_LE(e.kinetic + e.elastic, 1.1 * (start - e.potential) + 1e-6)
            << integrator << ", stiffness " << scale << ", damping " << damping;
      }
}

#ifndef PLICA_WITHOUT_FLOAT
TEST(ContactInSteps, OfFloatAndDoubleAgree) {
  const auto height = [](auto backend) {
    using B = decltype(backend);
    Problem p = block(0.005);
    p.body.initial.velocity = {0, 0, -0.5};
    p.gravity = {0, 0, -9.81};
    Simulation<B> simulation(p);
    advance(simulation, static_cast<int>(0.1 / simulation.macro_step()));
    return mean(simulation.positions())[2];
  };
  EXPECT_NEAR(height(HostFloat{}), height(Host{}), 1e-4);
}
#endif

// --- Depths ---

Problem ball(int cells, int subdivisions) {
  Problem p =
      body_of({box_mesh({{-0.055, -0.055, -0.055}, {0.055, 0.055, 0.055}}, {cells, cells, cells})},
              "neo_hookean");
  p.body.material = {"neo_hookean", 50e3, 0.4, 1000};
  p.body.damping.mass = 5;
  p.body.surface = sphere_surface({0, 0, 0}, 0.05, subdivisions);
  p.body.initial.position = Point{0.01, 0, 0.0754};
  p.gravity = {0, 0, -9.81};
  p.contact.obstacles.push_back({BowlOptions{{0, 0, 0.13}, 0.13, 0.08}, 0.3, {}});
  return p;
}

double depth_in_bowl(const std::vector<Point>& surface) {
  double most = 0;
  for (const Point& x : surface) most = std::max(most, (x - Point(0, 0, 0.13)).norm() - 0.13);
  return most;
}

TEST(ContactDepth, OfABallInABowlIsBelowAFortiethOfAnEdge) {
  for (const int subdivisions : {2, 3}) {
    Simulation<Host> simulation(ball(10, subdivisions));
    double most = 0;
    while (simulation.time() < 0.25) {
      advance(simulation, 5);
      most = std::max(most, depth_in_bowl(simulation.surface_positions()));
    }
    EXPECT_GT(most, 0);
    EXPECT_LT(most, 0.022 * simulation.levels()[0].mean_edge) << subdivisions;
  }
}

TEST(ContactDepth, UnderAToolPressedInByAnEdgeIsBelowSevenPercentOfIt) {
  Problem p = body_of({box_mesh({{0, 0, 0}, {0.08, 0.08, 0.04}}, {12, 12, 6})}, "neo_hookean");
  p.body.fixed = {HalfSpaceSelection{{0, 0, 0}, {0, 0, 1}}};
  p.body.damping.mass = 40;
  p.body.surface = boundary_surface(p.body.levels[0]).surface;
  const double edge = mean_edge_length(p.body.levels[0]), radius = 0.012;
  const Point start{0.04, 0.04, 0.04 + radius};
  p.contact.obstacles.push_back(
      {SphereOptions{start, radius}, 0.2, PathMotion{{{0, {0, 0, 0}}, {0.1, {0, 0, -edge}}}}});
  Simulation<Host> simulation(p);
  advance(simulation, static_cast<int>(0.2 / simulation.macro_step()));
  const std::vector<Point> x = simulation.surface_positions();
  double most = 0;
  for (const auto& [a, b, c] : p.body.surface->triangles)
    for (int i = 0; i <= 10; ++i)
      for (int j = 0; i + j <= 10; ++j) {
        const Point place =
            0.1 * (i * x[index_of(a)] + j * x[index_of(b)] + (10 - i - j) * x[index_of(c)]);
        most = std::max(most, radius - (place - start + Point(0, 0, edge)).norm());
      }
  EXPECT_GT(most, 0);
  EXPECT_LT(most, 0.07 * edge);
}

// --- Motion ---

// Where a bounce is in the end: the shorter the step, the nearer to that of very short ones.
TEST(ContactInSteps, ABounceConverges) {
  for (const char* integrator : {"symplectic_euler", "central_difference", "rk4"}) {
    Problem p = ball(6, 2);
    p.integration.integrator = {integrator};
    p.contact.obstacles[0].friction = 0.0;
    const double limit = Simulation<Host>(p).levels()[0].critical_step;
    const auto end = [&](int parts) {
      Problem q = p;
      const double steps = std::ceil(0.15 / (0.9 * limit));
      q.integration.macro_step = 0.15 / steps / parts;
      Simulation<Host> simulation(q);
      advance(simulation, static_cast<int>(steps) * parts);
      return simulation.positions();
    };
    const auto exact = end(16), rough = end(1), finer = end(4);
    const double way = 0.03, first = largest_difference(rough, exact),
                 second = largest_difference(finer, exact);
    EXPECT_LT(first, 0.1 * way) << integrator;
    EXPECT_LT(second, 0.4 * first + 1e-5) << integrator;
  }
}

// On a slope of angle a a block gains g (sin a - mu cos a) where tan a is above mu; else it stays,
// after the first jolt.
TEST(ContactInSteps, SlipOnASlopeAboveTheFrictionAngleOnly) {
  for (const char* integrator : {"symplectic_euler", "central_difference", "rk4"}) {
    const auto gains = [&](double slope) {
      Problem p = block(0);
      p.body.material.young_modulus = 2e5;
      p.contact.obstacles[0].friction = 0.3;
      p.gravity = 10 * Point(std::sin(slope), 0, -std::cos(slope));
      p.integration.integrator = {integrator};
      Simulation<Host> simulation(p);
      advance(simulation, static_cast<int>(0.2 / simulation.macro_step()));
      const double speed = along_x(simulation), start = simulation.time();
      advance(simulation, static_cast<int>(0.2 / simulation.macro_step()));
      return (along_x(simulation) - speed) / (simulation.time() - start);
    };
    const double angle = std::atan(0.3),
                 pull = 10 * (std::sin(1.2 * angle) - 0.3 * std::cos(1.2 * angle));
    EXPECT_LT(gains(0.95 * angle), 0.02 * pull) << integrator;
    EXPECT_NEAR(gains(1.2 * angle), pull, 0.06 * pull) << integrator;
  }
}

// A point that two obstacles touch is held by both.
TEST(ContactInSteps, HoldACornerBetweenTwoPlanes) {
  Problem p = block(0);
  p.contact.obstacles.push_back({PlaneOptions{{0, 0, 0}, {1, 0, 0}}, {}, {}});
  p.gravity = {-7, 0, -7};
  p.body.damping.mass = 50;
  Simulation<Host> simulation(p);
  advance(simulation, static_cast<int>(0.4 / simulation.macro_step()));
  Point lowest(1, 1, 1);
  for (const Point& x : simulation.positions()) lowest = lowest.cwiseMin(x);
  const double edge = simulation.levels()[0].mean_edge;
  EXPECT_GT(lowest[0], -0.02 * edge);
  EXPECT_GT(lowest[2], -0.02 * edge);
}

// --- him ---

// At an impact in steps several times as long as one that the finest mesh would take, elastic,
// kinetic and contact energy together never are more than gravity and the fall have put in.
TEST(ContactInSteps, OfHimAddNoEnergyAtAnImpact) {
  struct Case {
    std::vector<TetMesh> levels;
    double poisson, speed;
  };
  const std::vector<TetMesh> cubes = {jittered_box(decimetre, {6, 6, 6}),
                                      jittered_box(decimetre, {4, 4, 4})},
                             balls = {ball_mesh(Point::Zero(), 0.05, 8),
                                      ball_mesh(Point::Zero(), 0.05, 5)};
  for (const Case& one : {Case{cubes, 0.3, 0.2}, Case{cubes, 0.45, 0.2}, Case{balls, 0.3, 0.5},
                          Case{balls, 0.45, 1}}) {
    Problem p = body_of(one.levels, "neo_hookean");
    p.body.material.young_modulus = 20e3, p.body.material.poisson_ratio = one.poisson;
    p.integration.cycle = "him";
    p.body.surface = boundary_surface(p.body.levels[0]).surface;
    p.body.initial.position = Point(0, 0, 0.055), p.body.initial.velocity = {0, 0, -one.speed};
    p.gravity = {0, 0, -9.81};
    p.contact.obstacles.push_back({PlaneOptions{{0, 0, 0}, {0, 0, 1}}, {}, {}});
    Simulation<Host> simulation(p);
    EnergyBudget energy;
    energy.look(0, simulation.energies());
    double lowest = 1;
    while (simulation.time() < 0.15) {
      ASSERT_FALSE(simulation.step_checked());
      energy.look(simulation.time(), simulation.energies());
      for (const Point& x : simulation.surface_positions()) lowest = std::min(lowest, x[2]);
    }
    EXPECT_LE(energy.growth(), 0.02) << one.poisson << ", " << one.speed;
    EXPECT_GT(lowest, -0.1 * simulation.levels()[0].mean_edge);
  }
}

// A step that is shorter because the run ends with it says nothing of its own of forces.
TEST(ContactInSteps, ForcesAreThoseOfTheLastWholeStep) {
  Problem p = block(0);
  p.body.damping.mass = 5;
  p.gravity = {0, 0, -9.81};
  Simulation<Host> simulation(p);
  simulation.end_at(40.3 * simulation.macro_step());
  advance(simulation, 40);
  const Point force = simulation.wrenches()[0].force;
  simulation.step();
  EXPECT_NEAR(simulation.time(), 40.3 * simulation.macro_step(), 1e-12);
  EXPECT_GT(force[2], 0);
  EXPECT_EQ(simulation.wrenches()[0].force, force);
}

// Mass damping takes its part of a force by contact as of any other: what rests is borne by its
// weight, whatever the step.
TEST(ContactInSteps, WithHimBearsTheWeightOfADampedBody) {
  Problem p = block(0);
  p.body.damping.mass = 40;
  p.gravity = {0, 0, -9.81};
  p.integration.cycle = "him";
  p.integration.macro_step = 3e-3;
  Simulation<Host> simulation(p);
  advance(simulation, 500);
  const double weight = 9.81 * simulation.levels()[0].mass;
  EXPECT_NEAR(simulation.wrenches()[0].force[2], weight, 1e-3 * weight);
}

TEST(ContactInSteps, EnergyThatNobodyPutInIsNoticed) {
  EnergyBudget budget;
  budget.look(0, {.kinetic = 1});
  budget.look(1, {.kinetic = 1.5, .elastic = 0.5, .potential = -1});  // it has fallen
  EXPECT_EQ(budget.warning(), "");
  budget.look(1.5, {.kinetic = 1, .elastic = 0.5, .potential = -1, .contact = 0.5});
  EXPECT_EQ(budget.warning(), "") << "contact stores what motion has lost";
  budget.look(2, {.kinetic = 1, .elastic = 1, .potential = -1, .contact = 0.5});
  EXPECT_NEAR(budget.growth(), 0.25, 1e-12);
  EXPECT_NE(
      budget.warning().find("at 2 s the body had 0.5 J that nobody put in, 0.25 of all that was"),
      std::string::npos)
      << budget.warning();
  budget.look(3, {.kinetic = 3, .elastic = 1, .potential = -1}, 2);  // a tool has pushed it
  EXPECT_NEAR(budget.growth(), 0.125, 1e-12) << "of all that was put in, also later";
}

TEST(ContactInSteps, RoundingIsNoEnergyOfNothing) {
  const Problem p = small_cube();  // at rest
  const Simulation<Host> simulation(p);
  EnergyBudget budget(simulation, p);
  budget.look(0, {.kinetic = 1e-31});
  budget.look(1, {.elastic = 1e-17});
  EXPECT_EQ(budget.warning(), "");
  budget.look(2, {.kinetic = 1e-3});
  EXPECT_NE(budget.warning(), "");
}

// --- Wrenches ---

// What obstacles and weight do to a body is the change of its momentum, in every macro step, to
// rounding.
template <class B>
class Wrenches : public testing::Test {};
TYPED_TEST_SUITE(Wrenches, EachBackend);

TYPED_TEST(Wrenches, AreTheChangeOfMomentum) {
  using Real = typename TypeParam::Real;
  for (const char* cycle : {"single", "him"})
    for (const char* integrator : {"symplectic_euler", "central_difference", "rk4"}) {
      if (cycle == std::string("him") && integrator != std::string("symplectic_euler")) continue;
      Problem p = body_of({jittered_box(decimetre, {5, 5, 5}), jittered_box(decimetre, {3, 3, 3})},
                          "neo_hookean");
      p.integration.cycle = cycle, p.integration.integrator = {integrator};
      p.body.surface = sphere_surface({0.05, 0.05, 0.05}, 0.05, 2);
      p.gravity = {0, 0, -9.81};
      p.contact.obstacles.push_back({PlaneOptions{{0, 0, 0.002}, {0, 0, 1}}, 0.3, {}});
      p.contact.obstacles.push_back(
          {SphereOptions{{-0.048, 0.05, 0.05}, 0.05}, 0.1, Point(0.1, 0, 0), "ball"});
      Simulation<TypeParam> simulation(p);
      const auto mass = lumped_masses(p.body.levels[0], {p.body.material.density});
      const auto now = [&] {
        Point sum = Point::Zero();
        const auto v = simulation.velocities();
        for (std::size_t a = 0; a < v.size(); ++a) sum += mass[a] * v[a];
        return sum;
      };
      Point before = now();
      double pushed = 0;
      for (int n = 0; n < 60; ++n) {
        advance(simulation, 1);
        const Point after = now(), gained = (after - before) / simulation.macro_step();
        const auto wrenches = simulation.wrenches();
        ASSERT_EQ(wrenches.size(), 2u);
        EXPECT_EQ(wrenches[0].obstacle, "obstacle_0");
        EXPECT_EQ(wrenches[1].obstacle, "ball");
        const Point by = wrenches[0].force + wrenches[1].force;
        // in float, what is left of the vertices' momenta in their sum
        const double rounding = round_off<Real>(400, 1.0) / simulation.macro_step();
        EXPECT_LE((gained - by - 1.0 * p.gravity).norm(),
                  rounding + round_off<Real>(100, by.norm()))
            << cycle << ", " << integrator << ", step " << n;
        pushed = std::max(pushed, by.norm());
        before = after;
      }
      EXPECT_GT(pushed, 1);
    }
}

}  // namespace
