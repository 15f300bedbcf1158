// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <plica/drivers/run/join_bodies.hpp>
#include <plica/drivers/study/level_probe.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/generators.hpp>
#include <plica/meshes/mesh_quality.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// Stiffnesses of contact: of two layers, of friction, and what few sweeps reach of them.
namespace {

using namespace plica;
using namespace plica::test;

constexpr double g = 9.81;

Body with_skin(TetMesh mesh, double young) {
  Body body = body_of({std::move(mesh)}, "neo_hookean").body;
  body.material.young_modulus = young;
  body.surface = boundary_surface(body.levels[0]).surface;
  return body;
}

/// Area of a surface for each of its points [m^2].
double area_per_point(const TriangleSurface& surface) {
  double sum = 0;
  for (const auto& t : surface.triangles) {
    const auto x = [&](std::size_t c) { return surface.vertices[static_cast<std::size_t>(t[c])]; };
    sum += 0.5 * (x(1) - x(0)).cross(x(2) - x(0)).norm();
  }
  return sum / static_cast<double>(surface.vertices.size());
}

/// Adds the middles of all edges to a surface: every triangle becomes four.
TriangleSurface split(const TriangleSurface& of) {
  TriangleSurface finer;
  finer.vertices = of.vertices;
  std::map<std::pair<int, int>, int> middles;
  const auto middle = [&](int a, int b) {
    const auto [found, added] =
        middles.try_emplace(std::minmax(a, b), static_cast<int>(finer.vertices.size()));
    if (added)
      finer.vertices.push_back(
          (of.vertices[static_cast<std::size_t>(a)] + of.vertices[static_cast<std::size_t>(b)]) /
          2);
    return found->second;
  };
  for (const auto& t : of.triangles) {
    const int ab = middle(t[0], t[1]), bc = middle(t[1], t[2]), ca = middle(t[2], t[0]);
    for (const std::array<int, 3>& part :
         {std::array<int, 3>{t[0], ab, ca}, {ab, t[1], bc}, {ca, bc, t[2]}, {ab, bc, ca}})
      finer.triangles.push_back(part);
  }
  return finer;
}

// A small hard block a little inside a large soft one. Points of either that are in the other, 16
// and 4, each push with k = 64 a / (l1/E1 + l2/E2), a the smaller area of a point.
TEST(ContactConstants, LayersOfTwoBodiesAreInSeries) {
  constexpr double depth = 1e-4, hard = 2e5, soft = 2e4;
  const Body above = with_skin(
                 box_mesh({{0.07, 0.07, -depth}, {0.13, 0.13, 0.06 - depth}}, {3, 3, 3}), hard),
             below = with_skin(box_mesh({{0, 0, -0.09}, {0.18, 0.18, 0}}, {6, 6, 3}), soft);
  Problem p;
  p.body = join_bodies({{"above", above}, {"below", below}});
  LevelProbe<Host> probe(p);
  const auto force = probe.force(probe.zero());
  Point on_above = Point::Zero(), on_all = Point::Zero();
  for (std::size_t a = 0; a < force.size(); ++a) {
    if (a < above.levels[0].vertices.size()) on_above += force[a];
    on_all += force[a];
  }
  const double area = std::min(area_per_point(*above.surface), area_per_point(*below.surface)),
               k = 64 * area /
                   (mean_edge_length(above.levels[0]) / hard +
                    mean_edge_length(below.levels[0]) / soft);
  EXPECT_NEAR(on_above[2], 20 * k * depth, 1e-9 * k * depth);
  EXPECT_LE(on_all.norm(), 1e-12 * k * depth);
}

/// A block on a slope of `angle`.
Problem on_a_slope(TetMesh mesh, double angle) {
  Problem p;
  p.body = with_skin(std::move(mesh), 5e4);
  p.body.damping.mass = 20;
  p.gravity = g * Point(std::sin(angle), 0, -std::cos(angle));
  p.contact.obstacles = {{PlaneOptions{}, 0.6, {}}};
  return p;
}

// Where what rests on a plane is tilted a little, it moves by its weight along the plane over the
// stiffness of all its points, kt = k times friction_stiffness_scale.
TEST(ContactConstants, FrictionGivesByItsOwnStiffness) {
  constexpr double tilt = 0.03;
  for (const auto& [integrator, step] :
       {std::pair{"symplectic_euler", 0.0}, {"implicit_euler", 2e-3}})
    for (const double scale : {0.25, 4.0}) {
      SCOPED_TRACE(integrator + std::string(" ") + std::to_string(scale));
      Problem p = on_a_slope(jittered_box({{0, 0, 0}, {0.1, 0.1, 0.05}}, {4, 4, 2}), 0);
      p.contact.friction_stiffness_scale = scale;
      p.contact.obstacles[0].friction = 5;  // no point slips
      p.integration.integrator = {integrator};
      p.integration.implicit.relative_residual = 1e-10;
      if (step > 0) p.integration.macro_step = step;
      const double k = LevelProbe<Host>(p).at(0).contact()->stiffness();
      Simulation<Host> s(p);
      const auto places = [&] {
        double sum = 0;
        const auto x = s.positions();
        for (std::size_t a = 0; a < x.size(); ++a)
          if (p.body.levels[0].vertices[a][2] < 1e-9) sum += x[a][0];
        return sum;
      };
      while (s.time() < 1) advance(s, 1);
      const double before = places(), weight = g * s.levels()[0].mass;
      s.set_gravity(g * Point(std::sin(tilt), 0, -std::cos(tilt)));
      while (s.time() < 2) advance(s, 1);
      const double wanted = std::sin(tilt) * weight;
      EXPECT_NEAR((places() - before) * scale * k, wanted, 0.01 * wanted);
    }
}

// Twelve surface points to a vertex at the bottom, more than the sweeps of a step can tell apart:
// what they lack of the force the stretch makes up for, and the block stays.
TEST(ContactConstants, ManyPointsToAVertexStick) {
  for (const bool him : {false, true}) {
    SCOPED_TRACE(him);
    Problem p =
        on_a_slope(with_slivers(jittered_box({{0, 0, 0}, {0.1, 0.1, 0.05}}, {4, 4, 2})), 0.15);
    p.body.surface = split(split(*p.body.surface));
    if (him) p.integration.cycle = "him";
    Simulation<Host> s(p);
    while (s.time() < 2) advance(s, 1);
    const double weight = g * s.levels()[0].mass;
    EXPECT_LT(largest(s.velocities()), 1e-6);
    EXPECT_NEAR(s.wrenches()[0].force[0], -std::sin(0.15) * weight, 1e-3 * weight);
    EXPECT_NEAR(s.wrenches()[0].force[2], std::cos(0.15) * weight, 1e-3 * weight);
  }
}

// A plate presses a cushion down, by a twentieth of its height. The four sweeps of `him` are a
// softer contact than the law, by which the force at rest is less than that of explicit steps.
TEST(ContactConstants, HimBearsNearlyTheForceOfTheLaw) {
  const auto force = [](const std::string& cycle) {
    Problem p = on_a_slope(with_slivers(jittered_box({{0, 0, 0}, {0.1, 0.1, 0.05}}, {6, 6, 3})), 0);
    p.gravity = Point::Zero();
    p.body.fixed = {HalfSpaceSelection{{0, 0, 1e-6}, {0, 0, 1}}};
    p.contact.obstacles = {{PlaneOptions{{0, 0, 0.051}, {0, 0, -1}}, 0.3, {}}};
    p.contact.obstacles[0].motion =
        PathMotion{{{0, {0, 0, 0}}, {0.3, {0, 0, -0.001 - 0.05 * 0.05}}}};
    p.integration.cycle = cycle;
    Simulation<Host> s(p);
    while (s.time() < 1.5) advance(s, 1);
    EXPECT_LT(largest(s.velocities()), 1e-4) << cycle;
    return s.wrenches()[0].force[2];
  };
  const double by_law = force("single"), by_him = force("him");
  EXPECT_LT(by_law, 0);
  EXPECT_GE(by_him / by_law, 0.97);
  EXPECT_LE(by_him / by_law, 1.001);
}

// A tip that goes through more than half of a thin plate is pushed back to where it came from, by
// the whole depth, though the other face is nearer.
TEST(ContactConstants, PointsLeaveByTheFaceTheyCameBy) {
  constexpr double thickness = 4e-3, depth = 3e-3;
  TetMesh tip;
  tip.vertices = {
      {0.01, 0, 0.041}, {-0.005, 0.0087, 0.041}, {-0.005, -0.0087, 0.041}, {0, 0, 1e-3}};
  tip.tets = {{0, 2, 1, 3}};
  for (Point& x : tip.vertices) x += Point(0.003, 0.002, 0);  // above the middle of a face
  Body above = with_skin(std::move(tip), 2e4),
       below = with_skin(box_mesh({{-0.05, -0.05, -thickness}, {0.05, 0.05, 0}}, {5, 5, 1}), 2e4);
  above.prescribed = {{HalfSpaceSelection{{0, 0, 0}, {0, 0, -1}},
                       PathMotion{{{0, {0, 0, 0}}, {0.1, {0, 0, -1e-3 - depth}}}}}};
  below.fixed = {HalfSpaceSelection{{0, 0, 1}, {0, 0, 1}}};
  Problem p;
  p.body = join_bodies({{"above", above}, {"below", below}});
  p.integration.macro_step = 2e-4;
  Simulation<Host> s(p);
  double least = 0;
  while (s.time() < 0.15) {
    s.step();
    least = std::min(least, s.wrenches()[0].force[2]);
  }
  const double area = std::min(area_per_point(*above.surface), area_per_point(*below.surface)),
               k = 64 * area * 2e4 /
                   (mean_edge_length(above.levels[0]) + mean_edge_length(below.levels[0]));
  EXPECT_GE(least, -1e-9);
  EXPECT_NEAR(s.wrenches()[0].force[2], k * depth, 0.01 * k * depth);
}

}  // namespace
