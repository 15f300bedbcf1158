// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <plica/core/error.hpp>
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
#include "support/tolerance.hpp"

// Cuts of a body in motion.
namespace {

using namespace plica;
using namespace plica::test;

const Box bar_box{{0, 0, 0}, {0.2, 0.1, 0.1}};
constexpr double middle = 0.1;  // a plane of the bar's mesh

/// A bar of 8 x 4 x 4 cells, and a coarser level for cycles that use it.
Problem bar(const std::string& cycle = "single", const std::string& element = "linear") {
  Problem p = body_of({box_mesh(bar_box, {8, 4, 4}), box_mesh(bar_box, {4, 2, 2})}, "neo_hookean");
  p.body.element = {element};
  p.integration.cycle = cycle;
  p.integration.macro_step = 2e-4;
  return p;
}

/// The part z > bottom of a plane across the bar.
Blade plane_at(double x, double bottom = -1) {
  const Point a(x, -1, bottom), b(x, 1, bottom), c(x, 1, 1), d(x, -1, 1);
  return {{a, b, c}, {a, c, d}};
}

template <class B>
std::vector<double> masses(const Simulation<B>& s) {
  return lumped_masses(s.mesh(), {body_of({}).body.material.density});
}

/// Momentum, then angular momentum about the origin.
template <class B>
std::array<Point, 2> momenta(const Simulation<B>& s) {
  std::array<Point, 2> sum{Point::Zero(), Point::Zero()};
  const auto m = masses(s);
  const auto x = s.positions(), v = s.velocities();
  for (std::size_t a = 0; a < m.size(); ++a)
    sum[0] += m[a] * v[a], sum[1] += m[a] * x[a].cross(v[a]);
  return sum;
}

template <class B>
class CutBody : public testing::Test {};
TYPED_TEST_SUITE(CutBody, EachBackend);

TYPED_TEST(CutBody, KeepsMassAndMomentum) {
  using Real = typename TypeParam::Real;
  for (const char* cycle : {"single", "him"})
    for (const char* element : {"linear", "nodal"}) {
      SCOPED_TRACE(std::string(cycle) + " " + element);
      Problem p = bar(cycle, element);
      p.body.initial.velocity = {0.1, 0.2, 0.3};
      p.body.initial.angular_velocity = {3, 2, 5};
      Simulation<TypeParam> s(p);
      advance(s, 10);
      const double mass = s.levels()[0].mass, time = s.time();
      const auto before = momenta(s);
      const auto x = s.positions(), v = s.velocities();
      const CutReport report = s.cut(plane_at(middle, 0.04));
      EXPECT_GT(report.opened_faces, 0);
      EXPECT_EQ(report.new_vertices, static_cast<int>(s.twins().size()));
      EXPECT_GT(report.new_vertices, 0);
      EXPECT_EQ(report.pieces, 1);
      EXPECT_EQ(s.time(), time);
      EXPECT_EQ(s.macro_steps(), 10);
      EXPECT_NEAR(s.levels()[0].mass, mass, 1e-13 * mass);
      const auto after = momenta(s);
      for (std::size_t k = 0; k < 2; ++k) EXPECT_LE((after[k] - before[k]).norm(), 1e-13 * mass);
      const auto x_now = s.positions(), v_now = s.velocities();
      ASSERT_EQ(x_now.size(), x.size() + s.twins().size());
      for (std::size_t a = 0; a < x_now.size(); ++a) {
        const std::size_t was =
            a < x.size() ? a : static_cast<std::size_t>(s.twins()[a - x.size()]);
        EXPECT_EQ(x_now[a], x[was]);
        EXPECT_EQ(v_now[a], v[was]);
      }
      advance(s, 10);
      const auto later = momenta(s);
      if (cycle == std::string("single")) {
        EXPECT_LE((later[0] - before[0]).norm(), round_off<Real>(1e3, before[0].norm()))
            << "the body moves on freely";
      }
    }
}

// The half that nothing holds has no stress yet: each of its vertices falls as a point does
TYPED_TEST(CutBody, InTwoLetsAHalfFallFreely) {
  using Real = typename TypeParam::Real;
  for (const char* element : {"linear", "nodal"}) {
    Problem p = bar("single", element);
    p.body.fixed = {left_face()};
    p.gravity = {0, 0, -9.81};
    Simulation<TypeParam> s(p);
    const CutReport report = s.cut(plane_at(middle));
    EXPECT_EQ(report.opened_faces, 32);
    EXPECT_EQ(report.new_vertices, 25);
    EXPECT_EQ(report.pieces, 2);
    advance(s, 50);
    std::vector<char> falls(s.mesh().vertices.size(), 0);
    for (const auto& t : s.mesh().tets) {
      double x = 0;
      for (const int v : t) x += s.mesh().vertices[static_cast<std::size_t>(v)][0] / 4;
      for (const int v : t) falls[static_cast<std::size_t>(v)] = x > middle ? 1 : 0;
    }
    const Point expected = 50 * s.macro_step() * p.gravity;
    const auto v = s.velocities();
    int count = 0;
    for (std::size_t a = 0; a < v.size(); ++a) {
      if (falls[a] == 0) continue;
      EXPECT_LE((v[a] - expected).norm(), round_off<Real>(1e4, expected.norm()));
      ++count;
    }
    EXPECT_EQ(count, 5 * 25);
  }
}

// A simulation that is cut at the start is that of the mesh that is cut
TYPED_TEST(CutBody, IsThatOfTheMeshThatIsCut) {
  for (const char* integrator : {"symplectic_euler", "newmark", "bdf2"})
    for (const char* element : {"linear", "nodal"}) {
      SCOPED_TRACE(std::string(integrator) + " " + element);
      Problem p = bar("single", element);
      p.body.levels.pop_back();
      p.body.fixed = {left_face()};
      p.body.damping.mass = 1;
      p.gravity = {0, 0, -9.81};
      p.integration.integrator = {integrator};
      const Blade blade = plane_at(0.11, 0.04);
      Problem split = p;
      TetMesh& mesh = split.body.levels[0];
      mesh = open_faces(mesh, faces_across(mesh.tets, mesh.vertices, blade)).mesh;
      Simulation<TypeParam> s(p), made(split);
      EXPECT_GT(s.cut(blade).new_vertices, 0);
      EXPECT_EQ(s.levels()[0].critical_step, made.levels()[0].critical_step);
      advance(s, 8), advance(made, 8);
      EXPECT_TRUE(same_bits(s.positions(), made.positions()));
      EXPECT_TRUE(same_bits(s.velocities(), made.velocities()));
    }
}

TYPED_TEST(CutBody, ThatNothingMeetsStaysAsItIs) {
  Problem p = bar();
  p.body.fixed = {left_face()};
  p.gravity = {0, 0, -9.81};
  Simulation<TypeParam> s(p), whole(p);
  advance(s, 5), advance(whole, 5);
  const CutReport report = s.cut(plane_at(3));
  EXPECT_EQ(report.opened_faces, 0);
  EXPECT_EQ(report.new_vertices, 0);
  advance(s, 5), advance(whole, 5);
  EXPECT_TRUE(same_bits(s.positions(), whole.positions()));
  EXPECT_EQ(s.save().bytes, whole.save().bytes);
}

/// A blade over the bar that comes down and cuts it to `depth` within 4 ms.
CutOptions guillotine(double x, double depth) {
  CutOptions cut;
  cut.blade.segment = {Point(x, -0.05, 0.11), Point(x, 0.15, 0.11)};
  cut.blade.motion = PathMotion{{{0, Point::Zero()}, {4e-3, Point(0, 0, -depth - 0.01)}}};
  cut.to = 4e-3;
  return cut;
}

// While nothing moves, a blade opens step by step what it would at once
TYPED_TEST(CutBody, OpensWhatABladeSweeps) {
  Problem p = bar();
  p.cuts = {guillotine(middle, 0.12)};
  Simulation<TypeParam> s(p), at_once(bar());
  EXPECT_EQ(s.cuts().opened_faces, 0);
  advance(s, 10);
  EXPECT_GT(s.cuts().opened_faces, 0);
  EXPECT_EQ(s.cuts().pieces, 1);
  advance(s, 15);
  const CutReport whole = at_once.cut(plane_at(middle));
  EXPECT_EQ(s.cuts().opened_faces, whole.opened_faces);
  EXPECT_EQ(s.cuts().new_vertices, whole.new_vertices);
  EXPECT_EQ(s.cuts().pieces, 2);
  EXPECT_LE(largest(s.velocities()), 1e-6);
}

// Before, within and after the cut: the same bits
TYPED_TEST(CutBody, GoesOnFromASavedState) {
  for (const auto& [cycle, integrator] : {std::pair{"single", "symplectic_euler"},
                                          {"single", "newmark"},
                                          {"him", "symplectic_euler"}})
    for (const int steps : {3, 12, 23}) {
      SCOPED_TRACE(std::string(cycle) + " " + integrator + " " + std::to_string(steps));
      Problem p = bar(cycle, "nodal");
      p.body.fixed = {left_face()};
      p.body.material.prony = {{0.3, 5e-3}};
      p.body.surface = boundary_surface(p.body.levels[0]).surface;
      p.contact.obstacles = {{SphereOptions{{0.15, 0.05, 0.12}, 0.021}, 0.3, {}}};
      p.gravity = {0, 0, -9.81};
      p.integration.integrator = {integrator};
      p.cuts = {guillotine(0.11, 0.06)};
      Simulation<TypeParam> whole(p), second(p);
      advance(whole, steps);
      const SavedState saved = whole.save();
      second.restore(saved);
      EXPECT_EQ(second.cuts().opened_faces, whole.cuts().opened_faces);
      EXPECT_EQ(second.twins(), whole.twins());
      advance(whole, 12), advance(second, 12);
      EXPECT_GT(whole.twins().size(), 0u);
      EXPECT_TRUE(same_bits(second.positions(), whole.positions()));
      EXPECT_TRUE(same_bits(second.surface_positions(), whole.surface_positions()));
      EXPECT_EQ(second.save().bytes, whole.save().bytes);
    }
}

TEST(Cuts, AreNotTakenBackByAnEarlierState) {
  Simulation<Host> s(bar());
  const SavedState start = s.save();
  s.cut(plane_at(middle));
  EXPECT_EQ(refusal([&] { s.restore(start); }),
            "the saved state has other cuts than this simulation; expected a new simulation of the "
            "same problem");
}

// A body that is stretched evenly, and held at its faces, relaxes without moving; a cut changes
// neither its shape nor its stress
TEST(Cuts, LeaveStressesThatRelax) {
  for (const char* element : {"linear", "nodal"}) {
    Problem p = bar("single", element);
    p.body.material.prony = {{0.3, 1e-3}, {0.4, 0.05}};
    p.integration.macro_step = 1e-4;
    for (int k = 0; k < 3; ++k)
      for (const bool upper : {false, true}) {
        HalfSpaceSelection face;
        face.point = upper ? bar_box.max : bar_box.min;
        face.normal = (upper ? -1.0 : 1.0) * Point::Unit(k);
        p.body.fixed.emplace_back(Selection(face));
      }
    Simulation<Host> s(p);
    std::vector<Point> u = s.mesh().vertices;
    for (Point& each : u) each = Point(0.1 * each[0], 0.02 * each[0], -0.05 * each[2]);
    s.set_state(u, std::vector<Point>(u.size(), Point::Zero()));
    const double at_first = s.element_fields().von_mises[0];
    advance(s, 20);
    const auto before = s.element_fields().von_mises;
    EXPECT_LT(before[0], 0.9 * at_first) << "it has relaxed";
    EXPECT_GT(s.cut(plane_at(0.11, 0.04)).new_vertices, 0);
    const auto after = s.element_fields().von_mises;
    EXPECT_GE(after.size(), before.size());
    for (const double one : after) EXPECT_NEAR(one, before[0], 1e-9 * before[0]);
  }
}

// What a tool holds it still holds, and the surface has both sides of the cut
TEST(Cuts, AreFollowedByContact) {
  Problem p = bar();
  p.body.surface = boundary_surface(p.body.levels[0]).surface;
  ObstacleOptions plate{BlockOptions{{0.1, 0.05, 0.1105}, {0.5, 0.5, 0.02}}, {}, {}};
  plate.grasp = GraspOptions{.from = {}, .until = {}, .reach = 1e-3};
  p.contact.obstacles = {plate};
  Simulation<Host> s(p);
  s.grasp(0);
  const std::vector<int> held = s.held()[0].points;
  EXPECT_EQ(held.size(), 9u * 5u);
  const std::size_t points = s.surface()->vertices.size();
  const double area = surface_area(*s.surface());
  s.cut(plane_at(middle));
  const std::vector<int> both = s.held()[0].points;  // and the new sides of the line that split
  ASSERT_EQ(both.size(), held.size() + 5);
  EXPECT_TRUE(std::equal(held.begin(), held.end(), both.begin()));
  EXPECT_EQ(s.surface()->vertices.size(), points + 16 + 2 * 9);  // rim, and both insides
  EXPECT_NEAR(surface_area(*s.surface()), area + 2 * 0.01, 1e-12);
  SurfaceReport report;
  count_edges(*s.surface(), report);
  EXPECT_TRUE(report.closed());
  advance(s, 10);
  s.release(0);
  EXPECT_TRUE(s.held()[0].points.empty());
}

TEST(Cuts, AskTheCallerForForcesOfMoreVertices) {
  Simulation<Host> s(bar());
  std::size_t vertices = 0;
  s.set_external_forces(
      [&](const ForceRequest<Host>& request) { vertices = request.force.extent(0); });
  advance(s, 1);
  EXPECT_EQ(vertices, 9u * 25u);
  s.cut(plane_at(middle));
  advance(s, 1);
  EXPECT_EQ(vertices, 10u * 25u);
}

/// The deepest point of a beam's underside in equilibrium under its weight. Both ends are held.
double sag(const TetMesh& mesh) {
  Problem p = body_of({mesh}, "neo_hookean");
  p.body.material.young_modulus = 100e3, p.body.material.poisson_ratio = 0.45;
  p.body.element = {"nodal"};
  p.body.fixed = {left_face(), Box{{0.4, -1, -1}, {0.4, 1, 1}}};
  p.gravity = {0, 0, -9.81};
  p.integration = {};
  p.integration.cycle = "rest", p.integration.rest.tolerance = 1e-5;
  Simulation<Host> s(p);
  advance(s, 10);
  double deepest = 0;
  const auto x = s.positions();
  for (std::size_t a = 0; a < x.size(); ++a)
    if (mesh.vertices[a][2] == 0) deepest = std::max(deepest, -x[a][2]);
  return deepest;
}

// A cut of 60 % that leans by 20 degrees: along the mesh's faces, against a mesh that has the plane
TEST(Cuts, SagAsThePlaneDoes) {
  const double lean = std::tan(20 * 3.14159265358979323846 / 180);
  const auto at = [&](double y, double z) { return Point(0.2 + (z - 0.05) * lean, y, z); };
  const Blade blade = {{at(-0.01, 0.04), at(0.11, 0.04), at(0.11, 0.11)},
                       {at(-0.01, 0.04), at(0.11, 0.11), at(-0.01, 0.11)}};
  const TetMesh straight = box_mesh(beam_box, {24, 6, 6});
  TetMesh leaning = straight;
  for (Point& p : leaning.vertices) p[0] += (p[2] - 0.05) * lean * (1 - std::abs(p[0] - 0.2) / 0.2);
  const auto cut_by = [&](const TetMesh& mesh) {
    return open_faces(mesh, faces_across(mesh.tets, mesh.vertices, blade)).mesh;
  };
  const double along_faces = sag(cut_by(straight)), by_plane = sag(cut_by(leaning)),
               whole = sag(straight);
  EXPECT_GT(by_plane, 1.15 * whole);
  EXPECT_NEAR(along_faces, by_plane, 0.02 * by_plane);
}

TEST(Cuts, SayWhatCannotFollowThem) {
  const auto said = [](const Problem& p) {
    Simulation<Host> s(p);
    return refusal([&] { s.cut(plane_at(middle)); });
  };
  EXPECT_EQ(said(bar("rsv")),
            "cut: integration.cycle is rsv, whose levels cannot follow a cut; expected single or "
            "him");
  Problem p = bar();
  p.body.initial.position = Point(1, 2, 3);
  EXPECT_EQ(said(p),
            "cut: body.initial.position: a body that is cut stays where its mesh is; leave it out, "
            "and move the mesh");
  p = bar();
  p.body.surface = sphere_surface({0.1, 0.05, 0.05}, 0.04, 1);
  EXPECT_EQ(said(p),
            "cut: body.surface is not the boundary of level 0, whose faces would open; expected "
            "body.surface: {boundary: true}");
  p = bar();
  Simulation<Host> s(p);
  EXPECT_EQ(refusal([&] {
              s.cut({{Point(0, 0, NAN), Point(1, 0, 0), Point(0, 1, 0)}});
            }),
            "cut: expected triangles of finite numbers");
}

TEST(Cuts, OfAProblemAreChecked) {
  const auto said = [](const std::function<void(CutOptions&)>& change) {
    Problem p = bar();
    p.cuts = {guillotine(middle, 0.06)};
    change(p.cuts[0]);
    return refusal([&] { validate(p); });
  };
  EXPECT_EQ(said([](CutOptions& c) { c.blade.segment.pop_back(); }),
            "cuts.0.blade.segment has 1 point; expected two, its ends");
  EXPECT_EQ(said([](CutOptions& c) { c.blade.segment[1] = c.blade.segment[0]; }),
            "cuts.0.blade.segment has no length: both ends are [0.1, -0.05, 0.11] m; expected two "
            "places");
  EXPECT_EQ(said([](CutOptions& c) { c.from = c.to; }),
            "cuts.0.to is 0.004 s; expected a time after from, 0.004 s");
  Problem p = bar("fas");
  p.cuts = {guillotine(middle, 0.06)};
  EXPECT_EQ(refusal([&] { validate(p); }),
            "cuts: integration.cycle is fas, whose levels cannot follow a cut; expected single or "
            "him");
}

}  // namespace
