// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <plica/core/error.hpp>
#include <plica/drivers/body/masses.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/generators.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/refusal.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// Obstacles that take hold of the surface and let it go.
namespace {

using namespace plica;
using namespace plica::test;

constexpr double side = 0.06, top = side;

/// A cube and a plate just above it that can take hold of its top.
Problem cube_and_plate(const GraspOptions& grasp) {
  Problem p = body_of({box_mesh({{0, 0, 0}, {side, side, side}}, {4, 4, 4})}, "neo_hookean");
  p.body.surface = boundary_surface(p.body.levels[0]).surface;
  ObstacleOptions plate{BlockOptions{{side / 2, side / 2, top + 0.0105}, {0.2, 0.2, 0.02}}, {}, {}};
  plate.name = "plate", plate.grasp = grasp;
  p.contact.obstacles = {plate};
  p.integration.macro_step = 2e-4;
  return p;
}

const GraspOptions from_the_start{.from = {0}, .until = {}, .reach = 1e-3, .stiffness = {}};

std::vector<double> masses_of(const Problem& p) {
  return lumped_masses(p.body.levels[0], {p.body.material.density});
}
Point momentum(const Simulation<Host>& s, const std::vector<double>& mass) {
  Point sum = Point::Zero();
  const auto v = s.velocities();
  for (std::size_t a = 0; a < v.size(); ++a) sum += mass[a] * v[a];
  return sum;
}
std::vector<int> held_points(const Simulation<Host>& s) { return s.held()[0].points; }
double total(const std::vector<double>& mass) {
  double sum = 0;
  for (const double m : mass) sum += m;
  return sum;
}

// A plate, or the half-space above it, that touches the top holds it, on whichever side of it
// rounding puts its face.
TEST(Grasp, HoldsWhatTouches) {
  for (const double off : {-1e-9, 0.0, 1e-9})
    for (const bool endless : {false, true}) {
      Problem p = cube_and_plate({.from = {0}});
      ShapeOptions& shape = p.contact.obstacles[0].shape;
      if (endless)
        shape = PlaneOptions{{0, 0, top + off}, {0, 0, -1}};
      else
        shape = BlockOptions{{side / 2, side / 2, top + off + 0.01}, {0.2, 0.2, 0.02}};
      Simulation<Host> s(p);
      s.step();
      EXPECT_EQ(held_points(s).size(), 25u) << off;
    }
}

// What hangs on the plate pulls by its weight, and its highest points are weight / (points
// stiffness) below where they were held.
TEST(Grasp, HangsByItsSprings) {
  Problem p = cube_and_plate(from_the_start);
  p.gravity = {0, 0, -9.81};
  p.body.damping.mass = 30;
  for (const double stiffness : {20.0, 2000.0}) {
    p.contact.obstacles[0].grasp->stiffness = stiffness;
    Simulation<Host> s(p);
    while (s.time() < 1) advance(s, 1);
    const auto held = s.held();
    ASSERT_EQ(held.size(), 1u);
    EXPECT_EQ(held[0].obstacle, "plate");
    ASSERT_EQ(held[0].points.size(), 25u);  // the top's vertices
    const double weight = 9.81 * total(masses_of(p));
    const Wrench w = s.wrenches()[0];
    EXPECT_NEAR(w.force[2], weight, 0.002 * weight);
    EXPECT_LT(w.torque.norm(), 0.01 * weight * side);
    double sag = 0;
    for (const int point : held[0].points)
      sag += top - s.surface_positions()[static_cast<std::size_t>(point)][2];
    EXPECT_NEAR(sag * stiffness, weight, 0.01 * weight) << stiffness;
    // the contact energy is that of these springs
    double energy = 0;
    for (const int point : held[0].points)
      energy += 0.5 * stiffness *
                (s.surface_positions()[static_cast<std::size_t>(point)] -
                 p.body.surface->vertices[static_cast<std::size_t>(point)])
                    .squaredNorm();
    EXPECT_NEAR(s.energies().contact, energy, 1e-4 * energy);
  }
}

// The grip of a plate that goes up holds where it is stronger than the weight's part on each
// spring, and slips off where it is not.
TEST(Grasp, TearsAtItsStrength) {
  for (const auto& [integrator, step] :
       {std::pair{"symplectic_euler", 2e-4}, {"implicit_euler", 1e-3}})
    for (const double part : {4.0, 0.5}) {
      SCOPED_TRACE(integrator + std::string(" ") + std::to_string(part));
      Problem p = cube_and_plate(from_the_start);
      p.gravity = {0, 0, -9.81};
      p.body.damping.mass = 30;
      p.integration.integrator = {integrator}, p.integration.macro_step = step;
      const double weight = 9.81 * total(masses_of(p));
      p.contact.obstacles[0].grasp->stiffness = 2000;
      p.contact.obstacles[0].grasp->strength = part * weight / 25;
      Simulation<Host> s(p);
      while (s.time() < 0.3) advance(s, 1);
      EXPECT_EQ(held_points(s).size(), part > 1 ? 25u : 0u);
      EXPECT_NEAR(s.wrenches()[0].force[2], part > 1 ? weight : 0, 0.02 * weight);
    }
}

// Pulled, pushed and moved aside the top goes with the plate, and a plate without grasp would leave
// it where it is.
TEST(Grasp, CarriesItsPointsInAllDirections) {
  for (const Point& way : {Point(0, 0, 0.02), Point(0.02, 0, 0), Point(0, -0.02, 0)}) {
    Problem p = cube_and_plate(from_the_start);
    p.body.damping.mass = 40;
    p.contact.obstacles[0].motion = PathMotion{{{0, {0, 0, 0}}, {0.1, way}}};
    Simulation<Host> s(p);
    while (s.time() < 0.6) advance(s, 1);
    for (const int point : held_points(s)) {
      const auto i = static_cast<std::size_t>(point);
      EXPECT_LE((s.surface_positions()[i] - p.body.surface->vertices[i] - way).norm(),
                0.01 * way.norm());
    }
    EXPECT_LT(s.wrenches()[0].force.norm(), 0.02);  // it rests: nothing else acts on it
  }
}

// All momentum that the body gets is the plate's force times the step, in every step, while it
// holds and when it lets go; and where the plate has mass, what one gets the other loses.
TEST(Grasp, KeepsTheMomentum) {
  for (const char* integrator : {"symplectic_euler", "central_difference", "rk2", "rk4", "euler"})
    for (const bool massive : {false, true}) {
      Problem p =
          cube_and_plate({.from = {0.004}, .until = {0.02}, .reach = 1e-3, .stiffness = {}});
      p.integration.integrator = {integrator};
      p.integration.allow_unstable = true;  // without damping rk2 and euler let motion grow
      p.integration.macro_step = 1e-4;
      p.body.initial.velocity = {0.1, 0, -0.05};
      if (massive) p.contact.obstacles[0].mass = 0.6;
      Simulation<Host> s(p);
      const auto mass = masses_of(p);
      Point before = momentum(s, mass);
      const Point start = before;
      double most = 0;
      for (int n = 0; n < 260; ++n) {
        advance(s, 1);
        const Point now = momentum(s, mass), force = s.wrenches()[0].force;
        EXPECT_LE((now - before - force * 1e-4).norm(), round_off<double>(4000, start.norm()))
            << integrator << n;
        const Point of_plate = massive ? Point(0.6 * s.tools()[0].velocity) : Point(start - now);
        EXPECT_LE((now + of_plate - start).norm(), round_off<double>(4000, start.norm()))
            << integrator << n;
        const bool holds = n >= 40 && n < 200;
        EXPECT_EQ(held_points(s).size(), holds ? 25u : 0u) << n;
        EXPECT_TRUE(holds || force == Point(0, 0, 0)) << n;
        before = now, most = std::max(most, force.norm());
      }
      EXPECT_GT(most, 0.1);
    }
}

// The angular momentum about the scene's origin changes by the torque of the wrench, which is about
// the plate's centre, and by the force there: by leapfrog to rounding, since forces are those of
// the places at the start of a step.
TEST(Grasp, TurnsTheBodyByItsTorque) {
  Problem p = cube_and_plate(from_the_start);
  const Point centre(side / 2, side / 2, top + 0.0105), speed(0.1, 0.05, 0);
  p.contact.obstacles[0].motion = SteadyMotion{speed};
  p.body.initial.angular_velocity = {0, 0, 5};
  Simulation<Host> s(p);
  const auto mass = masses_of(p);
  const auto turning = [&] {
    Point sum = Point::Zero();
    const auto x = s.positions(), v = s.velocities();
    for (std::size_t a = 0; a < x.size(); ++a) sum += mass[a] * x[a].cross(v[a]);
    return sum;
  };
  Point before = turning();
  const double size = before.norm();
  double most = 0;
  for (int n = 0; n < 200; ++n) {
    const Point about = centre + s.time() * speed;
    advance(s, 1);
    const Point now = turning();
    const Wrench w = s.wrenches()[0];
    EXPECT_LE((now - before - 2e-4 * (w.torque + about.cross(w.force))).norm(),
              round_off<double>(4000, size))
        << n;
    before = now, most = std::max(most, w.torque.norm());
  }
  EXPECT_GT(most, 0.01);
}

// A needle holds the points within its reach, and lifts them.
TEST(Grasp, ThinToolsHoldPoints) {
  Problem p = cube_and_plate(from_the_start);
  p.body.fixed = {HalfSpaceSelection{{0, 0, 0}, {0, 0, 1}}};
  p.body.damping.mass = 40;
  ObstacleOptions& needle = p.contact.obstacles[0];
  needle.shape =
      CapsuleOptions{{-0.01, side / 2, top + 1e-3}, {side + 0.01, side / 2, top + 1e-3}, 0.5e-3};
  needle.motion = PathMotion{{{0, {0, 0, 0}}, {0.1, {0, 0, 0.004}}}};
  Simulation<Host> s(p);
  while (s.time() < 0.5) advance(s, 1);
  ASSERT_EQ(held_points(s).size(), 5u);  // of the line below it
  for (const int point : held_points(s))
    EXPECT_NEAR(s.surface_positions()[static_cast<std::size_t>(point)][2], top + 0.004,
                0.05 * 0.004);
  EXPECT_GT(s.wrenches()[0].force[2], 0.1);
}

double most_energy(Simulation<Host>& s, int steps) {
  double most = 0;
  for (int n = 0; n < steps; ++n) {
    advance(s, 1);
    const Energies e = s.energies();
    most = std::max(most, e.kinetic + e.elastic);
  }
  return most;
}

// The springs bound no step: at 0.95 of the limit of the elements, however stiff they are, energy
// does not grow. Of the linear law, whose limit is that of any state.
TEST(Grasp, BoundsNoStep) {
  Problem p = cube_and_plate(from_the_start);
  p.body.material = complete({"linear", 20e3, 0.35, 1000});
  p.body.initial.velocity = {0.2, 0.1, -0.1};
  p.integration.macro_step.reset();
  p.integration.safety = 0.95;
  Problem without = p;
  without.contact.obstacles[0].grasp.reset();
  const double step = Simulation<Host>(without).macro_step();
  for (const double stiffness : {1e2, 1e3, 1e6, 1e9})
    for (const double damping : {0.0, 1.0}) {
      p.contact.obstacles[0].grasp->stiffness = stiffness;
      p.contact.damping_scale = damping;
      Simulation<Host> s(p);
      EXPECT_EQ(s.macro_step(), step);
      const double start = s.energies().kinetic, early = most_energy(s, 1000);
      EXPECT_LT(early, 4 * start) << stiffness;  // at this step kinetic energy wavers much
      most_energy(s, 500);
      EXPECT_LT(most_energy(s, 1000), 1.2 * early) << stiffness;
      EXPECT_EQ(held_points(s).size(), 25u);
    }
}

// Several times in turns, and by a program in between.
TEST(Grasp, ClosesAndOpensInTurns) {
  Simulation<Host> s(
      cube_and_plate({.from = {0.01, 0.03}, .until = {0.02}, .reach = 1e-3, .stiffness = {}}));
  const auto held_at = [&](double time) {
    while (s.time() < time) advance(s, 1);
    return held_points(s).size();
  };
  EXPECT_EQ(held_at(0.009), 0u);
  EXPECT_EQ(held_at(0.015), 25u);
  EXPECT_EQ(held_at(0.025), 0u);
  s.grasp(0);
  EXPECT_EQ(held_points(s).size(), 25u);
  s.release(0);
  EXPECT_EQ(held_points(s).size(), 0u);
  EXPECT_EQ(held_at(0.035), 25u);
  for (const Part& part : s.parts())
    if (part.name == "held points") {
      EXPECT_TRUE(part.in && part.bytes > 0);
      EXPECT_EQ(part.reason, "plate from 0.01 s until 0.02 s, from 0.03 s");
    }
}

TEST(Grasp, TakesWhatIsWithinReach) {
  Problem p = cube_and_plate({.from = {0}, .until = {}, .reach = 0.4e-3, .stiffness = {}});
  EXPECT_TRUE([&] {
    Simulation<Host> s(p);
    advance(s, 1);
    return held_points(s).empty();
  }());
  p.contact.obstacles[0].grasp->reach = 0.6e-3;  // the plate is 0.5 mm above the top
  Simulation<Host> near(p);
  advance(near, 1);
  EXPECT_EQ(held_points(near).size(), 25u);
  p.contact.obstacles[0].grasp->reach = 0.02;  // the next row of points is 15 mm below
  Simulation<Host> far(p);
  advance(far, 1);
  EXPECT_EQ(held_points(far).size(), 41u);
}

Problem pulled() {
  Problem p = cube_and_plate({.from = {0.004}, .until = {0.03}, .reach = 4e-3, .stiffness = {}});
  p.contact.obstacles[0].motion = SineMotion{{0.005, 0, 0.005}, 20, 0};
  return p;
}

TEST(Grasp, GoesOnFromASavedState) {
  for (const char* cycle : {"single", "him"}) {
    Problem p = pulled();
    p.integration.cycle = cycle;
    if (p.integration.cycle == "him")
      p.body.levels.push_back(box_mesh({{0, 0, 0}, {side, side, side}}, {2, 2, 2}));
    Simulation<Host> s(p), other(p);
    advance(s, 100);
    ASSERT_EQ(held_points(s).size(), 25u);
    const SavedState saved = s.save();
    advance(s, 100);
    other.restore(saved);
    advance(other, 100);
    EXPECT_TRUE(same_bits(s.positions(), other.positions()));
    EXPECT_TRUE(held_points(s).empty());
  }
}

// Steps that are taken again take hold and let go again.
TEST(Grasp, GoesBackWithTheState) {
  Problem p = pulled();
  p.integration.on_failure.halvings = 3;
  Simulation<Host> s(p), other(p);
  // over the step that closes, then over that which opens
  for (int round = 0; round < 2; ++round) {
    advance(s, round == 0 ? 20 : 129), advance(other, round == 0 ? 20 : 129);
    s.step();  // without a check, and so not kept
    EXPECT_EQ(held_points(s).size(), round == 0 ? 25u : 0u);
    s.return_to_last_good();
    EXPECT_EQ(held_points(s).size(), round == 0 ? 0u : 25u);
    advance(s, 1), advance(other, 1);
  }
  advance(s, 50), advance(other, 50);
  EXPECT_TRUE(same_bits(s.positions(), other.positions()));
}

// Cycles hold the same points on every level. (Cycle rv lets motion grow, also where the top is
// moved by given motions.)
TEST(Grasp, HoldsOnEveryLevel) {
  for (const char* cycle : {"rs", "rsv", "fas", "him"}) {
    Problem p = cube_and_plate(from_the_start);
    p.body.levels.push_back(box_mesh({{0, 0, 0}, {side, side, side}}, {2, 2, 2}));
    p.integration.cycle = cycle;
    p.body.damping.mass = 20;
    p.contact.obstacles[0].motion = PathMotion{{{0, {0, 0, 0}}, {0.1, {0, 0, 0.01}}}};
    Simulation<Host> s(p);
    while (s.time() < 0.5) advance(s, 1);
    ASSERT_EQ(held_points(s).size(), 25u) << cycle;
    Point mean = Point::Zero();
    for (const int point : held_points(s)) {
      const auto i = static_cast<std::size_t>(point);
      mean += (s.surface_positions()[i] - p.body.surface->vertices[i]) / 25;
    }
    EXPECT_LE((mean - Point(0, 0, 0.01)).norm(), 0.05 * 0.01) << cycle << " " << mean.transpose();
  }
}

// It holds the points that are chosen, of those in reach, and two obstacles choose for themselves.
TEST(Grasp, HoldsWhatIsChosen) {
  Problem p = cube_and_plate(from_the_start);
  ObstacleOptions second = p.contact.obstacles[0];
  second.name = "second";
  p.contact.obstacles.push_back(second);
  // more than is in reach
  p.contact.obstacles[0].grasp->where = Box{{0, 0, 0}, {side / 2, side, side}};
  p.contact.obstacles[1].grasp->where = NearestSelection{{side, side, top}};
  const auto chosen = [&](const auto& inside) {
    std::vector<int> points;
    for (std::size_t i = 0; i < p.body.surface->vertices.size(); ++i)
      if (const Point x = p.body.surface->vertices[i]; x[2] > top - 1e-9 && inside(x))
        points.push_back(static_cast<int>(i));
    return points;
  };
  Simulation<Host> s(p);
  advance(s, 1);
  const auto held = s.held();
  ASSERT_EQ(held.size(), 2u);
  EXPECT_EQ(held[0].points.size(), 15u);
  EXPECT_EQ(held[0].points, chosen([](const Point& x) { return x[0] < side / 2 + 1e-9; }));
  EXPECT_EQ(held[1].points,
            chosen([](const Point& x) { return x[0] > side - 1e-9 && x[1] > side - 1e-9; }));
}

// With a region and no reach it holds all points of the region, and so the same ones however far it
// is and however long a step is.
TEST(Grasp, HoldsARegion) {
  const Box region{{-1, -1, 0.02}, {0.031, 1, 1}};
  std::vector<int> wanted;
  for (const double away : {0.0, 0.05})
    for (const double step : {2e-4, 5e-5}) {
      Problem p = cube_and_plate({.from = {0.01}, .where = region});
      p.body.levels[0] = with_slivers(jittered_box({{0, 0, 0}, {side, side, side}}, {4, 4, 4}));
      p.body.surface = boundary_surface(p.body.levels[0]).surface;
      p.contact.obstacles[0].shape =
          BlockOptions{{side / 2, side / 2, top + 0.0105 + away}, {0.2, 0.2, 0.02}};
      p.integration.macro_step = step;
      p.gravity = {0, 0, -9.81};
      wanted.clear();
      const auto& points = p.body.surface->vertices;
      for (std::size_t i = 0; i < points.size(); ++i)
        if (points[i][2] >= 0.02 && points[i][0] <= 0.031) wanted.push_back(static_cast<int>(i));
      Simulation<Host> s(p);
      while (s.time() < 0.02) advance(s, 1);
      EXPECT_EQ(held_points(s), wanted) << away << " " << step;
    }
  EXPECT_GT(wanted.size(), 20u);
}

TEST(Grasp, IsRefusedWhereItCannotBe) {
  const auto why = [](const Problem& p) { return refusal([&] { Simulation<Host>{p}; }); };
  const auto with = [&](const GraspOptions& grasp) { return why(cube_and_plate(grasp)); };
  EXPECT_NE(with({.from = {0.1}, .until = {0.1}})
                .find("grasp.until is 0.1 s; expected a time after 0.1 s"),
            std::string::npos);
  EXPECT_NE(with({.from = {0.1, 0.2}, .until = {0.3}}).find("grasp.from is 0.2 s"),
            std::string::npos);
  EXPECT_NE(with({.from = {}, .until = {0.3}}).find("grasp.until has 1 times"), std::string::npos);
  EXPECT_NE(with({.from = {-1}}).find("grasp.from.0"), std::string::npos);
  EXPECT_NE(with({.from = {}, .until = {}, .reach = -1}).find("grasp.reach"), std::string::npos);
  EXPECT_NE(with({.from = {}, .until = {}, .reach = 0, .stiffness = 0}).find("grasp.stiffness"),
            std::string::npos);
  Problem p = cube_and_plate(from_the_start);
  p.contact.obstacles[0].grasp->where = Box{{1, 1, 1}, {2, 2, 2}};
  EXPECT_NE(
      why(p).find("contact.obstacles.0.grasp.where: the box from [1, 1, 1] to [2, 2, 2] m selects "
                  "no point of the "
                  "surface, which reaches from [0, 0, 0] to [0.06, 0.06, 0.06] m at the start"),
      std::string::npos);
  p.contact.obstacles[0].grasp->where = GroupSelection{"top"};
  EXPECT_NE(why(p).find("contact.obstacles.0.grasp.where: a surface has no groups and regions"),
            std::string::npos);
  p.contact.obstacles[0].grasp.reset();
  Simulation<Host> s(p);
  EXPECT_EQ(refusal([&] { s.grasp(0); }),
            "obstacle plate cannot hold anything; expected contact.obstacles.0.grasp");
  EXPECT_TRUE(s.held().empty());
}

}  // namespace
