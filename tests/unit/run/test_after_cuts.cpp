// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <plica/drivers/body/masses.hpp>
#include <plica/drivers/run/simulation.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/cut.hpp>
#include <plica/meshes/generators.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/refusal.hpp"
#include "support/simulate.hpp"

// What acts on a body that was cut, and steps that a cut makes unstable.
namespace {

using namespace plica;
using namespace plica::test;

const Box bar_box{{0, 0, 0}, {0.2, 0.1, 0.1}};
constexpr double middle = 0.1;  // a plane of the bar's mesh
constexpr double edge = 0.025;  // of its cells
const Box everything{{-1, -1, -1}, {1, 1, 1}};

Problem bar(const std::array<int, 3>& cells = {8, 4, 4}) {
  Problem p = body_of({box_mesh(bar_box, cells)}, "neo_hookean");
  p.integration.cycle = "single";
  p.integration.macro_step = 2e-4;
  return p;
}

/// The part z > bottom of a plane across the bar.
Blade plane_at(double x, double bottom = -1) {
  const Point a(x, -1, bottom), b(x, 1, bottom), c(x, 1, 1), d(x, -1, 1);
  return {{a, b, c}, {a, c, d}};
}

/// The bar's mesh after that cut.
TetMesh split(const TetMesh& mesh, const Blade& blade) {
  return open_faces(mesh, faces_across(mesh.tets, mesh.vertices, blade)).mesh;
}

template <class B>
Point momentum(const Simulation<B>& s) {
  const auto m = lumped_masses(s.mesh(), {body_of({}).body.material.density});
  const auto v = s.velocities();
  Point sum = Point::Zero();
  for (std::size_t a = 0; a < m.size(); ++a) sum += m[a] * v[a];
  return sum;
}

// A rod lies across the bar and the cut, between the points of the mesh. Its normal is across it
// everywhere, so that nothing is pushed along it: the rims stay where they are
TEST(AfterCuts, ARodAcrossTheRimsDoesNotPushThemApart) {
  Problem p = bar();
  p.body.surface = boundary_surface(p.body.levels[0]).surface;
  const double radius = 0.004, y = 1.5 * edge, z = 0.1 + radius - 0.001;
  p.contact.obstacles = {{CapsuleOptions{{-0.05, y, z}, {0.25, y, z}, radius}, {}, {}}};
  p.integration.macro_step = 1e-6;
  Simulation<Host> s(p);
  EXPECT_GT(s.cut(plane_at(middle, 0.04)).new_vertices, 0);
  s.step();
  double down = 0, along = 0;
  for (const Point& v : s.velocities())
    down = std::max(down, -v[2]), along = std::max(along, std::abs(v[0]));
  EXPECT_GT(down, 0);
  EXPECT_LE(along, 1e-9 * down);
}

// 10 N/m^2 on all of the bar's surface of 0.1 m^2, and on both sides of a cut of 0.01 m^2
TEST(AfterCuts, TractionsActOnTheSurfaceThatTheBodyHad) {
  for (const bool on_cuts : {false, true}) {
    Problem p = bar();
    p.body.loads = {{everything, Traction{{0, 0, 10}}, {}}};
    p.body.loads[0].on_cuts = on_cuts;
    Simulation<Host> s(p);
    EXPECT_EQ(s.cut(plane_at(middle)).pieces, 2);
    advance(s, 10);
    const double expected = 10 * (on_cuts ? 0.12 : 0.10) * s.time();
    EXPECT_NEAR(momentum(s)[2], expected, 1e-10 * expected) << on_cuts;
  }
}

// A named face inside the body is of both sides when it opens
TEST(AfterCuts, TractionsActOnNamedFacesThatOpen) {
  Problem p = bar();
  TetMesh& mesh = p.body.levels[0];
  const TetMesh open = split(mesh, plane_at(middle));
  const auto whole = boundary_triangles(mesh).size();
  for (const auto& tet : mesh.tets)
    for (std::size_t k = 0; k < 4; ++k) {
      std::array<int, 3> face{tet[(k + 1) % 4], tet[(k + 2) % 4], tet[(k + 3) % 4]};
      std::ranges::sort(face);
      const auto inside = [&](int v) {
        return std::abs(mesh.vertices[static_cast<std::size_t>(v)][0] - middle) < 1e-9;
      };
      auto& set = mesh.triangle_sets["wall"];
      if (std::ranges::all_of(face, inside) && std::ranges::count(set, face) == 0)
        set.push_back(face);
    }
  for (const auto& face : mesh.triangle_sets["wall"])
    mesh.vertex_sets["wall"].insert(mesh.vertex_sets["wall"].end(), face.begin(), face.end());
  auto& vertices = mesh.vertex_sets["wall"];
  std::ranges::sort(vertices);
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  EXPECT_EQ(boundary_triangles(open).size(), whole + 2 * mesh.triangle_sets["wall"].size());
  p.body.levels[0] = split(mesh, plane_at(middle));
  p.body.loads = {{GroupSelection{"wall"}, Traction{{0, 0, 10}}, {}}};
  Simulation<Host> s(p);
  advance(s, 10);
  const double expected = 10 * 0.02 * s.time();
  EXPECT_NEAR(momentum(s)[2], expected, 1e-10 * expected);
}

// Both sides of a vertex that splits stay in the grasp
TEST(AfterCuts, GraspsHoldBothSides) {
  Problem p = bar();
  p.body.surface = boundary_surface(p.body.levels[0]).surface;
  ObstacleOptions plate{BlockOptions{{0.1, 0.05, 0.1105}, {0.5, 0.5, 0.02}}, {}, {}};
  plate.grasp = GraspOptions{.from = {}, .until = {}, .reach = 1e-3};
  p.contact.obstacles = {plate};
  Simulation<Host> s(p);
  s.grasp(0);
  const std::size_t before = s.held()[0].points.size();
  s.cut(plane_at(middle, 0.06)), s.cut(plane_at(middle));
  const std::vector<int> held = s.held()[0].points;
  EXPECT_EQ(held.size(), before + 5);
  for (const int point : held)
    EXPECT_EQ(s.surface()->vertices[static_cast<std::size_t>(point)][2], 0.1) << "above alone";
  s.release(0);
  EXPECT_TRUE(s.held()[0].points.empty());
}

/// A blade over the bar that comes down through it within 4 ms.
CutOptions guillotine(double x) {
  CutOptions cut;
  cut.blade.segment = {Point(x, -0.05, 0.11), Point(x, 0.15, 0.11)};
  cut.blade.motion = PathMotion{{{0, Point::Zero()}, {4e-3, Point(0, 0, -0.13)}}};
  cut.to = 4e-3;
  return cut;
}

// A bar that flies past a blade, 0.3 edges in a step, is cut along a slope: once, and through
TEST(AfterCuts, BladesCutABodyThatMovesOnce) {
  constexpr double step = 2e-4, speed = 0.3 * edge / step, x = 0.19;
  Problem p = bar();
  p.body.initial.velocity = {speed, 0, 0};
  p.cuts = {guillotine(x)};
  Simulation<Host> s(p), at_rest(bar());
  advance(s, 20);
  // the way of the blade in the body; it is cut as it is at the start of each step
  const double high = x + speed * step, low = x - speed * (4e-3 - step);
  const Point a(high, -0.05, 0.11), b(high, 0.15, 0.11), c(low, 0.15, -0.02), d(low, -0.05, -0.02);
  const CutReport slope = at_rest.cut({{a, b, c}, {a, c, d}});
  ASSERT_EQ(slope.pieces, 2);
  EXPECT_EQ(s.cuts().pieces, 2);
  EXPECT_NEAR(s.cuts().opened_faces, slope.opened_faces, 0.1 * slope.opened_faces);
  EXPECT_NEAR(s.cuts().new_vertices, slope.new_vertices, 0.1 * slope.new_vertices);
}

// One level, whose stable step is shorter after the cut than the macro step: him goes on with
// explicit sub-steps, which keep momentum
TEST(AfterCuts, HimGoesOnWithShorterSteps) {
  const Blade blade = plane_at(0.02);  // through the outermost cells
  Problem whole = bar({4, 2, 2});
  whole.integration.cycle = "him", whole.integration.macro_step.reset();
  whole.body.initial.velocity = {0.1, 0.2, 0.3}, whole.body.initial.angular_velocity = {3, 2, 5};
  Problem open = whole;
  open.body.levels[0] = split(whole.body.levels[0], blade);
  const double longest = Simulation<Host>(whole).macro_step(),
               after = Simulation<Host>(open).macro_step();
  ASSERT_LT(after, 0.99 * longest);
  // an automatic step is half of the longest one that is stable
  whole.integration.macro_step = open.integration.macro_step = after + longest;
  EXPECT_NE(refusal([&] { Simulation<Host> refused(open); }).find("no inertia makes it stable"),
            std::string::npos);
  Simulation<Host> s(whole);
  advance(s, 5);
  EXPECT_EQ(s.counters().at("him_explicit_steps"), 0);
  s.cut(blade);
  const Point before = momentum(s);
  advance(s, 20);
  EXPECT_LE((momentum(s) - before).norm(), 1e-12 * before.norm());
  EXPECT_EQ(s.counters().at("him_explicit_steps"), 20);
  EXPECT_EQ(s.macro_step(), *whole.integration.macro_step);

  whole.integration.on_failure.halvings = 0;  // no shorter steps: the cut is refused
  Simulation<Host> strict(whole);
  EXPECT_EQ(refusal([&] { strict.cut(blade); }).find("cut: of the body after it, "), 0u);
  EXPECT_TRUE(strict.twins().empty());
}

// A step that is given, and that the body does not stand after the cut: the run ends in order
TEST(AfterCuts, ACutWithoutAStableStepIsDiagnosed) {
  Problem p = bar();
  p.integration.integrator = {"symplectic_euler"}, p.integration.substeps = {1};
  Problem open = p;
  open.body.levels[0] = split(p.body.levels[0], plane_at(0.11));
  const double longest = Simulation<Host>(p).levels()[0].critical_step,
               after = Simulation<Host>(open).levels()[0].critical_step;
  ASSERT_LT(after, longest);
  p.integration.macro_step = (after + longest) / 2;
  p.cuts = {guillotine(0.11)};
  Simulation<Host> s(p);
  std::optional<Diagnosis> bad;
  while (!bad && s.time() < 5e-3) bad = s.step_checked();
  ASSERT_TRUE(bad);
  EXPECT_EQ(bad->kind, "cut");
  EXPECT_NE(bad->reason.find("times its critical step"), std::string::npos) << bad->text();
  ASSERT_GE(bad->vertex, 0);
  EXPECT_NEAR(s.positions()[static_cast<std::size_t>(bad->vertex)][0], 0.11, edge);
  const double time = s.time();
  EXPECT_LT(time, 4e-3);
  s.return_to_last_good();
  EXPECT_EQ(s.time(), time);
}

}  // namespace
