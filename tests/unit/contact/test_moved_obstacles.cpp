// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <plica/core/error.hpp>
#include <plica/core/text.hpp>
#include <plica/drivers/run/validate.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/generators.hpp>
#include <plica/meshes/mesh_quality.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/refusal.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// Obstacles that a caller moves while the simulation runs.
namespace {

using namespace plica;
using namespace plica::test;

Problem touched() {
  Problem p = small_cube();
  p.body.surface = boundary_surface(p.body.levels[0]).surface;
  p.body.fixed = {left_face()};
  const std::vector<Point>& x = p.body.levels[0].vertices;
  const Point far = *std::ranges::max_element(x, {}, [](const Point& at) { return at.sum(); });
  p.contact.obstacles.push_back(
      {SphereOptions{far + Point(0.3, 0, 0) * far.norm(), 0.29 * far.norm()}, 0.2, {}, "tool"});
  return p;
}

Point to(int step) { return Point(-2e-3 * step, 1e-3 * std::sin(step), 0); }

TEST(MovedObstacles, GoAsByAPathOfTheSamePlaces) {
  constexpr int steps = 40;
  Problem by_path = touched();
  Simulation<Host> moved(touched());
  PathMotion path{{{0, Point::Zero()}}};
  for (int n = 1; n <= steps; ++n) path.knots.push_back({n * moved.macro_step(), to(n)});
  by_path.contact.obstacles[0].motion = path;
  Simulation<Host> told(by_path);
  ASSERT_EQ(told.macro_step(), moved.macro_step());
  double most = 0;
  for (int n = 1; n <= steps; ++n) {
    moved.move_obstacle(0, to(n));
    advance(moved, 1), advance(told, 1);
    EXPECT_LE((moved.obstacle_displacement(0) - to(n)).norm(), 1e-15);
    most = std::max(most, moved.wrenches()[0].force.norm());
  }
  EXPECT_GT(most, 0);
  const auto a = moved.positions(), b = told.positions();
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_LE((a[i] - b[i]).norm(), 1e-10) << i;
}

TEST(MovedObstacles, StayWhereTheyAreUntilTheyGetAMotion) {
  Simulation<Host> s(touched());
  s.move_obstacle(0, {0.1, 0.2, 0.3});
  advance(s, 3);
  EXPECT_EQ(s.obstacle_displacement(0), Point(0.1, 0.2, 0.3));
  s.set_obstacle_motion(0, SteadyMotion{Point(1, 0, 0)});
  EXPECT_EQ(s.obstacle_displacement(0), Point(s.time(), 0, 0));
}

TEST(MovedObstacles, AreInASavedState) {
  const auto go_on = [](Simulation<Host>& s) {
    for (int n = 11; n <= 20; ++n) s.move_obstacle(0, to(n)), advance(s, 1);
    return s.positions();
  };
  Simulation<Host> s(touched());
  for (int n = 1; n <= 10; ++n) s.move_obstacle(0, to(n)), advance(s, 1);
  const SavedState saved = s.save();
  const auto there = go_on(s);
  EXPECT_EQ(s.obstacle_displacement(0), to(20));
  s.restore(saved);
  EXPECT_EQ(s.obstacle_displacement(0), to(10));
  EXPECT_TRUE(same_bits(go_on(s), there));
  Simulation<Host> other(touched());
  other.restore(saved);
  EXPECT_EQ(other.obstacle_displacement(0), to(10));
  EXPECT_TRUE(same_bits(go_on(other), there));
}

TEST(MovedObstacles, AreInASavedStateByMotionsOfAllKinds) {
  const std::vector<Motion> motions = {SteadyMotion{Point(1, 2, 3)}, SineMotion{{1, 0, 2}, 3, 0.4},
                                       PathMotion{{{0, {0, 0, 0}}, {0.1, {0, 3, 0}}}}};
  std::vector<std::optional<Turn>> turns = {
      std::nullopt, Turn{{1, 1, 0}, Point(0.1, 0, 0), {0, 0.2, 0}, SteadyTurn{2}},
      Turn{{0, 0, 1}, {}, {0, 0, 0}, SineTurn{0.3, 4, 0.1}},
      Turn{{0, 1, 0}, Point(0, 1, 0), {0, 0, 0}, PathTurn{{{0, 0}, {0.1, 1.5}}}}};
  for (const Motion& motion : motions)
    for (const auto& turn : turns) {
      Simulation<Host> s(touched()), other(touched());
      s.set_obstacle_motion(0, motion), s.set_obstacle_turn(0, turn);
      other.restore(s.save());
      for (const double time : {0.0, 0.03, 0.2}) {
        s.set_time(time), other.set_time(time);
        EXPECT_EQ(s.obstacle_displacement(0), other.obstacle_displacement(0));
        EXPECT_EQ(s.obstacle_rotation(0), other.obstacle_rotation(0));
        EXPECT_EQ(s.obstacle_origin(0), other.obstacle_origin(0));
      }
    }
}

TEST(MovedObstacles, GoBackToTheProblemsMotionWithAStateOfIt) {
  Problem p = touched();
  p.contact.obstacles[0].motion = SteadyMotion{Point(-0.1, 0, 0)};
  Simulation<Host> s(p);
  const SavedState start = s.save();
  s.move_obstacle(0, to(5));
  advance(s, 3);
  s.restore(start);
  advance(s, 2);
  EXPECT_EQ(s.obstacle_displacement(0), Point(-0.1 * s.time(), 0, 0));
}

TEST(MovedObstacles, AreRefusedWhereThereIsNone) {
  Simulation<Host> s(touched());
  EXPECT_EQ(refusal([&] { s.move_obstacle(1, Point::Zero()); }),
            "there is no obstacle 1; the problem has 1, which count from 0");
  Simulation<Host> none(small_cube());
  EXPECT_EQ(refusal([&] { none.obstacle_displacement(0); }),
            "there is no obstacle 0; the problem has 0, which count from 0");
}

TEST(StartInObstacles, IsSaidOrRefused) {
  Problem p = small_cube();
  p.body.surface = boundary_surface(p.body.levels[0]).surface;
  const std::vector<Point>& vertices = p.body.levels[0].vertices;
  const Point top = *std::ranges::max_element(vertices, {}, [](const Point& x) { return x.sum(); });
  const auto starts_in = [&](double radius) {
    p.contact.obstacles = {{SphereOptions{top, radius}, {}, {}}};
    return starts_in_obstacles(p);
  };
  EXPECT_TRUE(starts_in(1e-6).empty());
  const double edge = mean_edge_length(p.body.levels[0]);
  const std::vector<std::string> found = starts_in(0.6 * edge);
  ASSERT_EQ(found.size(), 1);
  EXPECT_TRUE(found[0].starts_with("contact.obstacles.0: the body starts inside it, " +
                                   number(0.6 * edge, 3) + " m deep"))
      << found[0];
  EXPECT_EQ(refusal([&] { starts_in(100); }),
            "contact.obstacles.0 contains the whole body at the start; expected a body outside");
}

TEST(StartInObstacles, WithinTheBodyIsRefused) {
  Problem p = small_cube();
  p.body.surface = boundary_surface(p.body.levels[0]).surface;
  const Box box = bounding_box(p.body.levels[0].vertices);
  const Point middle = (box.min + box.max) / 2, size = box.max - box.min;
  const auto starts_at = [&](const Point& centre) {
    p.contact.obstacles = {{SphereOptions{centre, 0.1 * size.minCoeff()}, {}, {}}};
    return refusal([&] { starts_in_obstacles(p); });
  };
  EXPECT_EQ(starts_at(middle),
            "contact.obstacles.0 is inside the body at the start, where contact does not find it; "
            "expected it outside");
  EXPECT_EQ(starts_at(box.max + 0.2 * size), "");
  p.body.initial.position = box.max + 0.2 * size;
  EXPECT_NE(starts_at(box.max + 0.2 * size), "") << "where the body starts";
  EXPECT_EQ(starts_at(box.min), "");
}

/// A body that is its box, with that box's boundary as surface.
Problem within(const Box& box, const std::array<int, 3>& cells) {
  Problem p = body_of({box_mesh(box, cells)});
  p.body.surface = boundary_surface(p.body.levels[0]).surface;
  return p;
}

std::string refusal_of(Problem& p, const ShapeOptions& shape) {
  p.contact.obstacles = {{shape, {}, {}}};
  return refusal([&] { starts_in_obstacles(p); });
}

// Elements reach beyond the surface, as lattices do, or it beyond them: contact knows the surface
// alone.
TEST(StartInObstacles, TheSurfaceSaysWhatIsWithin) {
  Problem p = within(decimetre, {3, 3, 3});
  const Point middle(0.05, 0.05, 0.05), corner(0.012, 0.012, 0.012), above(0.05, 0.05, 0.107);
  const auto refused = [&](const Point& centre) {
    return refusal_of(p, SphereOptions{centre, 0.003}) != "";
  };
  EXPECT_TRUE(refused(middle) && refused(corner));
  EXPECT_FALSE(refused(above));
  p.body.surface = sphere_surface(middle, 0.04, 2);
  EXPECT_TRUE(refused(middle));
  EXPECT_FALSE(refused(corner)) << "in an element, outside the surface";
  p.body.surface = sphere_surface(middle, 0.07, 2);
  EXPECT_TRUE(refused(above)) << "in no element, inside the surface";
  p.body.surface->triangles.pop_back();
  EXPECT_TRUE(refused(middle) && refused(corner)) << "an open surface has no inside: elements say";
  EXPECT_FALSE(refused(above));
}

TEST(StartInObstacles, WhatLooksOutAtAnEndIsNotWithin) {
  Problem p = within(beam_box, {8, 2, 2});
  const Point middle(0.225, 0.05, 0.025), x = Point::UnitX();
  const auto refused = [&](const ShapeOptions& shape) { return refusal_of(p, shape) != ""; };
  constexpr double thin = 0.002;
  EXPECT_TRUE(refused(CapsuleOptions{middle - 0.1 * x, middle + 0.1 * x, thin}));
  EXPECT_FALSE(refused(CapsuleOptions{middle - 0.3 * x, middle + 0.3 * x, thin}))
      << "a needle through it";
  EXPECT_FALSE(refused(CapsuleOptions{middle - 0.1 * x, middle + 0.2 * x, thin}))
      << "one that sticks in it";
  EXPECT_TRUE(refused(CylinderOptions{middle - 0.1 * x, middle + 0.1 * x, thin}));
  EXPECT_FALSE(refused(ConeOptions{middle - 0.3 * x, middle + 0.3 * x, thin, 0}));
  EXPECT_TRUE(refused(BlockOptions{middle, {0.2, thin, thin}, Point::Zero()}));
  EXPECT_FALSE(refused(BlockOptions{middle, {0.5, thin, thin}, Point::Zero()}));
  EXPECT_FALSE(refused(BlockOptions{middle, {0.2, thin, thin}, {0, 0, 0.5 * std::numbers::pi}}));
  refusal_of(p, CapsuleOptions{middle - 0.1 * x, middle + 0.1 * x, thin});
  p.contact.obstacles[0].turn = Turn{.rotation = {0, 0, 0.5 * std::numbers::pi}};
  EXPECT_EQ(refusal([&] { starts_in_obstacles(p); }), "") << "turned, both ends look out";
}

TEST(StartInObstacles, AnAnchorThatHoldsTheBodyIsTaken) {
  Problem p = within({{0, 0, 0}, {0.1, 0.1, 0.004}}, {4, 4, 1});
  // the nearest points are 17 mm from it
  const SphereOptions anchor{{0.0125, 0.0125, 0.002}, 0.001};
  EXPECT_NE(refusal_of(p, anchor), "");
  const auto with_reach = [&](double reach) {
    p.contact.obstacles[0].grasp =
        GraspOptions{.from = {0}, .until = {}, .reach = reach, .stiffness = {}};
    return refusal([&] { starts_in_obstacles(p); });
  };
  EXPECT_EQ(with_reach(0.02), "");
  EXPECT_NE(with_reach(0.01), "") << "it would hold nothing";
}

TEST(MovedObstacles, AreDoubtedWhereTheyAreTooLight) {
  Problem p = small_cube();
  const double mass =
      1000 * 0.1 * 0.1 * 0.1 / static_cast<double>(p.body.levels[0].vertices.size());
  p.body.material.density = 1000;
  p.contact.obstacles = {{SphereOptions{{0, 0, 1}, 0.01}, {}, {}}};
  const auto said = [&](double factor) {
    p.contact.obstacles[0].mass = factor * mass;
    return std::ranges::count_if(problem_warnings(p), [](const std::string& s) {
      return s.find("0.mass") != std::string::npos;
    });
  };
  EXPECT_EQ(said(0.9), 1);
  EXPECT_EQ(said(1.1), 0);
  p.body.regions["heavy"].where = Box{{-1, -1, -1}, {1, 1, 1}};
  p.body.regions["heavy"].density = 3000;
  EXPECT_EQ(said(2.7), 1);
  EXPECT_EQ(said(3.3), 0);
}

}  // namespace
