// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <plica/core/error.hpp>
#include <plica/drivers/body/masses.hpp>
#include <plica/drivers/body/momenta.hpp>
#include <plica/drivers/run/join_bodies.hpp>
#include <plica/drivers/run/simulation.hpp>
#include <plica/drivers/run/validate.hpp>
#include <plica/drivers/study/sample_bodies.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/embedding.hpp>
#include <plica/meshes/files/mesh_files.hpp>
#include <plica/meshes/mesh_quality.hpp>
#include <plica/meshes/refinement.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/refusal.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// A refined part of an organ that follows an obstacle.
namespace {

using namespace plica;
using namespace plica::test;

TetMesh organ() { return read_mesh(PLICA_SOURCE_DIR "/meshes/data/liver_medium.msh"); }

constexpr double radius = 0.055;

/// An organ of 21 cm whose top is at z = 5 cm, and a sphere that moves; elements round it are fine.
Problem probed_organ(const Point& place, const Motion& motion, double size = 0.01) {
  Problem p = body_of({TetMesh(), organ()}, "neo_hookean");
  p.body.covers[0].refined = true;
  p.body.covers[0].follows = FollowOptions{"probe", radius};
  p.body.surface = boundary_surface(refined(p.body.levels[1])).surface;
  p.contact.obstacles = {{SphereOptions{place, size}, {}, motion}};
  p.contact.obstacles[0].name = "probe";
  return p;
}

/// A sphere that passes over the organ without touching it.
Problem passed_over(double speed) {
  return probed_organ({-0.06, 0, 0.075}, SteadyMotion(Point(speed, 0, 0)));
}

template <class B>
Momenta momenta(const Simulation<B>& s) {
  return momenta_of(lumped_masses(s.mesh(), {body_of({}).body.material.density}), s.positions(),
                    s.velocities());
}

/// Sets a smooth displacement of a few millimetres and a smooth velocity: the organ is stretched
/// and bent.
template <class B>
void bend(Simulation<B>& s, double speed) {
  std::vector<Point> u, v;
  for (const Point& x : s.mesh().vertices) {
    u.emplace_back(0.02 * x[0] + 2e-3 * std::sin(10 * x[1]), -0.01 * x[1],
                   3e-3 * std::sin(12 * x[0]));
    v.emplace_back(speed * std::cos(10 * x[2]), speed * std::sin(10 * x[0]), speed * 5 * x[0]);
  }
  s.set_state(u, v);
}

// --- Momentum ------------------------------------------------------------------------------------

TEST(Momenta, AreRestoredByARigidMotion) {
  const std::vector<Point> x = random_field(40, 0.1, 1), start = random_field(40, 2, 2);
  std::vector<double> mass(40);
  for (std::size_t i = 0; i < mass.size(); ++i) mass[i] = 0.1 + 0.01 * static_cast<double>(i);
  const Momenta given{{0.3, -0.2, 0.1}, {0.02, 0.05, -0.01}};
  std::vector<int> chosen(15);
  std::iota(chosen.begin(), chosen.end(), 10);
  std::vector<Point> v = start;
  restore_momenta(given, mass, x, chosen, v);
  const Momenta now = momenta_of(mass, x, v);
  EXPECT_LE((now.linear - given.linear).norm(), 1e-14);
  EXPECT_LE((now.angular - given.angular).norm(), 1e-15);
  for (const std::size_t i : {0u, 9u, 25u, 39u}) EXPECT_EQ(v[i], start[i]);
  // distances between vertices that have changed stay: their change is rigid
  for (std::size_t i = 11; i < 25; ++i)
    EXPECT_NEAR((v[i] - start[i] - v[10] + start[10]).dot(x[i] - x[10]), 0, 1e-14);
}

TEST(Momenta, OfVerticesOnALineKeepTheirLinearPart) {
  const std::vector<Point> x = {{0, 0, 0}, {1, 0, 0}, {3, 0, 0}};
  std::vector<Point> v(3, Point::Zero());
  restore_momenta({{1, 2, 3}, {5, 0, 0}}, {1, 1, 1}, x, {0, 1, 2}, v);
  EXPECT_LE((momenta_of({1, 1, 1}, x, v).linear - Point(1, 2, 3)).norm(), 1e-14);
  EXPECT_LE(largest(v), 10);
}

template <class B>
class FollowingPartOf : public testing::Test {};
TYPED_TEST_SUITE(FollowingPartOf, EachDoubleBackend);

// Explicit steps of a free body keep both momenta to rounding, and so do the moves of the part
TYPED_TEST(FollowingPartOf, KeepsMomentum) {
  for (const char* element : {"linear", "nodal"}) {
    SCOPED_TRACE(element);
    Problem p = passed_over(4);
    p.body.element = {element};
    p.integration.macro_step = 1e-4;
    p.body.initial.velocity = {0.1, 0.2, 0.3};
    p.body.initial.angular_velocity = {3, 2, 5};
    p.body.initial.stretch = {1.04, 0.97, 1};
    Simulation<TypeParam> s(p);
    const double mass = s.levels()[0].mass;
    const Momenta before = momenta(s);
    advance(s, 400);
    EXPECT_GE(s.followed().moves, 4);
    EXPECT_EQ(s.followed().moves, s.mesh_changes());
    EXPECT_GT(s.followed().seconds, 0);
    EXPECT_NEAR(s.levels()[0].mass, mass, 1e-12 * mass);
    const Momenta after = momenta(s);
    EXPECT_LE((after.linear - before.linear).norm(), 1e-12 * mass);
    EXPECT_LE((after.angular - before.angular).norm(), 1e-12 * mass * 0.1);
  }
}

// --- The part ------------------------------------------------------------------------------------

/// Expects the fine elements to be those round a place, where they are now.
template <class B>
void expect_fine_round(const Simulation<B>& s, const Point& place, double reach) {
  const double edge = mean_edge_length(organ());
  TetMesh now = s.mesh();
  now.vertices = s.positions();
  ASSERT_FALSE(now.piece.empty());
  int fine = 0;
  for (std::size_t t = 0; t < now.tets.size(); ++t) {
    const auto x = corners_of(now, static_cast<int>(t));
    const double distance = ((x[0] + x[1] + x[2] + x[3]) / 4 - place).norm();
    if (now.piece[t] == 0) {
      ++fine;
      EXPECT_LE(distance, 1.25 * reach + edge);  // the part stays until the place is 0.25 reach on
    } else {
      EXPECT_GE(distance, 0.6 * reach);
    }
  }
  EXPECT_GE(fine, 80);
}

TYPED_TEST(FollowingPartOf, IsRoundTheObstacle) {
  Problem p = passed_over(4);
  p.integration.macro_step = 1e-4;
  Simulation<TypeParam> s(p);
  expect_fine_round(s, s.obstacle_origin(0), radius);
  for (int i = 0; i < 8; ++i) {
    advance(s, 40);
    expect_fine_round(s, s.obstacle_origin(0), radius);
  }
}

// The organ flies by a tool that rests
TEST(FollowingPart, FollowsWhereTheBodyMoves) {
  Problem p = probed_organ({-0.03, 0, 0.075}, {});
  p.integration.macro_step = 1e-4;
  p.body.initial.velocity = {-2, 0, 0};
  Simulation<Host> s(p);
  advance(s, 400);
  EXPECT_GE(s.followed().moves, 2);
  expect_fine_round(s, Point(-0.03, 0, 0.075), radius);
}

// A rod that turns about its middle, outside the organ: its tip goes round
TEST(FollowingPart, FollowsAPointOfATool) {
  Problem p = probed_organ(Point::Zero(), {});
  ObstacleOptions& rod = p.contact.obstacles[0];
  const Point middle(0.03, 0, 0.3), tip(-0.03, 0, 0.08);
  rod.shape = CapsuleOptions{tip, 2 * middle - tip, 0.002};
  rod.turn = Turn{.axis = Point::UnitY(), .angle = SteadyTurn{-10}};
  p.body.covers[0].follows->at = tip;
  p.integration.macro_step = 1e-4;
  Simulation<Host> s(p);
  expect_fine_round(s, tip, radius);
  advance(s, 400);  // 0.4 rad
  const Point arm = tip - middle;
  const double c = std::cos(0.4), n = -std::sin(0.4);
  const Point now = middle + Point(c * arm[0] + n * arm[2], 0, c * arm[2] - n * arm[0]);
  EXPECT_GT((now - tip).norm(), 0.05);
  EXPECT_GE(s.followed().moves, 2);
  expect_fine_round(s, now, radius);
}

// Far away there is no part, and round all of the body there is nothing else
TEST(FollowingPart, MayBeNothingOrAllOfTheBody) {
  const std::size_t coarse = organ().tets.size();
  Problem p = probed_organ({0, 0, 5}, {});
  EXPECT_EQ(Simulation<Host>(p).mesh().tets.size(), coarse);
  p.body.covers[0].follows->radius = 10;
  EXPECT_EQ(Simulation<Host>(p).mesh().tets.size(), 8 * coarse);
}

TEST(FollowingPart, OfAToolThatRestsIsAPartThatStays) {
  Problem p = probed_organ({0, 0, 0.075}, {}), still = p;
  still.body.covers[0].follows.reset();
  still.body.covers[0].where = BallSelection{{0, 0, 0.075}, radius};
  for (Problem* each : {&p, &still}) each->integration.macro_step = 2e-4;
  Simulation<Host> s(p), other(still);
  bend(s, 0.05), bend(other, 0.05);
  advance(s, 50), advance(other, 50);
  EXPECT_EQ(s.followed().moves, 0);
  EXPECT_TRUE(same_bits(s.positions(), other.positions()));
}

// Elements keep their region where they are cut in eight, whatever their children's centroids are
TEST(FollowingPart, KeepsRegions) {
  Problem p = passed_over(4);
  p.body.regions["tumour"].where = BallSelection{{0, 0, 0.03}, 0.03};
  p.integration.macro_step = 1e-4;
  const auto volume = [](const TetMesh& mesh) {
    const auto found = std::ranges::find(mesh.region_names, "tumour");
    const auto number = static_cast<int>(found - mesh.region_names.begin());
    double sum = 0;
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
      const auto x = corners_of(mesh, static_cast<int>(t));
      if (mesh.region[t] == number) sum += mesh.part(t) * tet_volume(x[0], x[1], x[2], x[3]);
    }
    return sum;
  };
  Simulation<Host> s(p);
  const double before = volume(s.mesh());
  EXPECT_GT(before, 1e-6);
  advance(s, 300);
  EXPECT_GE(s.followed().moves, 2);
  EXPECT_NEAR(volume(s.mesh()), before, 1e-12 * before);
}

// --- Energy --------------------------------------------------------------------------------------

// A part that grows, as the tool comes down. The steps are so short that they change nothing
TEST(FollowingPart, KeepsEnergyAsItGrows) {
  for (const char* element : {"linear", "nodal"}) {
    SCOPED_TRACE(element);
    Problem p = probed_organ({0.01, 0, 0.1}, SteadyMotion(Point(0, 0, -16)), 0.001);
    p.body.element = {element};
    p.integration.macro_step = 1e-5;
    Simulation<Host> s(p);
    bend(s, 0.02);
    double energy = s.energies().total();
    std::size_t tets = s.mesh().tets.size();
    for (long n = 0, moves = 0; n < 290; ++n) {
      advance(s, 1);
      const double now = s.energies().total();
      if (s.followed().moves > moves) {
        EXPECT_NEAR(now, energy, 2e-3 * energy) << "move " << moves;
        EXPECT_GT(s.mesh().tets.size(), tets);
        tets = s.mesh().tets.size(), moves = s.followed().moves;
      }
      energy = now;
    }
    EXPECT_GE(s.followed().moves, 2);
  }
}

// --- Contact -------------------------------------------------------------------------------------

/// A sphere of 2 cm that is pressed into the organ by 8 mm, then drawn along it for 6 cm.
Problem drawn_along() {
  Problem p = probed_organ(
      {-0.02, 0, 0.0705},
      PathMotion{{{0, Point::Zero()}, {0.05, Point(0, 0, -0.008)}, {0.25, Point(0.06, 0, -0.009)}}},
      0.02);
  p.body.covers[0].follows->radius = 0.06;
  p.body.fixed = {Box{{-1, -1, -1}, {1, 1, -0.02}}};
  p.body.damping.mass = 30;
  p.body.element = {"nodal"};
  p.integration.macro_step = 2e-4;
  return p;
}

std::vector<Point> forces_of(const Problem& p, long& moves) {
  Simulation<Host> s(p);
  std::vector<Point> forces;
  for (int i = 0; i < 25; ++i) {
    advance(s, 50);
    if (s.time() > 0.06) forces.push_back(s.wrenches()[0].force);
  }
  moves = s.followed().moves;
  return forces;
}

// The force on the tool is that on a body that is fine everywhere
TEST(FollowingPart, HasTheForceOfTheWholeFineMesh) {
  const Problem p = drawn_along();
  Problem fine = p, coarse = p;
  fine.body.covers.clear(), coarse.body.covers.clear();
  fine.body.levels = {refined(p.body.levels[1])}, coarse.body.levels = {p.body.levels[1]};
  long moves = 0, none = 0;
  const std::vector<Point> truth = forces_of(fine, none), found = forces_of(p, moves),
                           rough = forces_of(coarse, none);
  EXPECT_EQ(none, 0);
  EXPECT_GE(moves, 2);
  double size = 0, error = 0, rough_error = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    size += truth[i].squaredNorm();
    error += (found[i] - truth[i]).squaredNorm();
    rough_error += (rough[i] - truth[i]).squaredNorm();
  }
  EXPECT_GT(std::sqrt(size / static_cast<double>(truth.size())), 0.1);  // N
  EXPECT_LT(std::sqrt(error / size), 0.08);
  EXPECT_LT(2 * std::sqrt(error), std::sqrt(rough_error));
}

// --- Saved states --------------------------------------------------------------------------------

// Before, between and after moves of the part: the same bits
TYPED_TEST(FollowingPartOf, GoesOnFromASavedState) {
  for (const auto& [cycle, integrator] : {std::pair{"single", "symplectic_euler"},
                                          {"single", "newmark"},
                                          {"him", "symplectic_euler"}})
    for (const int steps : {3, 17, 31}) {
      SCOPED_TRACE(std::string(cycle) + " " + integrator + " " + std::to_string(steps));
      Problem p = probed_organ({-0.03, 0, 0.058}, SteadyMotion(Point(5, 0, 0)));
      p.body.element = {"nodal"};
      p.body.fixed = {Box{{-1, -1, -1}, {-0.07, 1, 1}}};
      p.contact.obstacles[0].friction = 0.3;
      p.gravity = {0, 0, -9.81};
      p.integration.cycle = cycle;
      p.integration.integrator = {integrator};
      p.integration.macro_step = 2e-4;
      Simulation<TypeParam> whole(p), second(p);
      advance(whole, steps);
      const SavedState saved = whole.save();
      second.restore(saved);
      EXPECT_EQ(second.mesh().tets, whole.mesh().tets);
      EXPECT_EQ(second.followed().moves, whole.followed().moves);
      advance(whole, 30), advance(second, 30);
      EXPECT_GE(whole.followed().moves, 1);
      EXPECT_TRUE(same_bits(second.positions(), whole.positions()));
      EXPECT_TRUE(same_bits(second.surface_positions(), whole.surface_positions()));
      EXPECT_EQ(second.save().bytes, whole.save().bytes);
    }
}

// The part goes back with the state
TEST(FollowingPart, GoesBackToAnEarlierState) {
  Problem p = passed_over(8);
  p.integration.macro_step = 1e-4;
  Simulation<Host> s(p);
  bend(s, 0.05);
  const SavedState start = s.save();
  const auto tets = s.mesh().tets;
  advance(s, 100);
  EXPECT_GE(s.followed().moves, 1);
  const auto there = s.positions();
  s.restore(start);
  EXPECT_EQ(s.mesh().tets, tets);
  EXPECT_EQ(s.followed().moves, 0);
  advance(s, 100);
  EXPECT_TRUE(same_bits(s.positions(), there));
}

// --- Refusals ------------------------------------------------------------------------------------

TEST(FollowingPart, SaysWhatItCannotFollow) {
  const auto said = [](const std::function<void(Problem&)>& change) {
    Problem p = passed_over(1);
    change(p);
    return refusal([&] { validate(p); });
  };
  EXPECT_EQ(said([](Problem&) {}), "");
  EXPECT_EQ(said([](Problem& p) { p.body.covers[0].follows->obstacle = "prob"; }),
            "body.levels.0.refine.follows.obstacle: unknown obstacle 'prob'; did you mean 'probe'? "
            "(choices: probe)");
  EXPECT_EQ(said([](Problem& p) { p.contact.obstacles.clear(); }),
            "body.levels.0.refine.follows.obstacle: there is no obstacle 'probe'; expected one "
            "under contact.obstacles");
  EXPECT_EQ(said([](Problem& p) { p.body.covers[0].follows->radius = -1; }),
            "body.levels.0.refine.follows.radius is -1 m; expected a length (m) > 0");
  EXPECT_EQ(said([](Problem& p) {
              p.body.surface.reset();
            }).find("body.levels.0.refine.follows: body.surface: "),
            0u);
  EXPECT_EQ(said([](Problem& p) {
              p.integration.cycle = "rest";
            }).find("body.levels.0.refine.follows: integration.cycle is rest, which cannot"),
            0u);
  EXPECT_EQ(said([](Problem& p) {
              p.body.initial.position = Point(1, 2, 3);
            }).find("body.levels.0.refine.follows: body.initial.position: "),
            0u);
  EXPECT_EQ(said([](Problem& p) {
              p.body.material.prony = {{0.3, 5e-3}};
            }).find("body.levels.0.refine.follows: prony: "),
            0u);
  EXPECT_EQ(said([](Problem& p) {
              p.body.levels.insert(p.body.levels.begin(), TetMesh());
              p.body.covers[1] = p.body.covers[0];
              p.body.covers[0] = {BallSelection{{0, 0, 0.05}, 0.02}, true};
            }).find("body.levels.1.refine.follows: a part that follows an obstacle is the only"),
            0u);
  EXPECT_EQ(refusal([] {
              const Body one = passed_over(1).body;
              join_bodies({{"left", one}, {"right", one}});
            }).find("bodies.left.levels.0.refine.follows: "),
            0u);
}

}  // namespace
