// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <plica/drivers/body/supports.hpp>
#include <plica/meshes/generators.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/refusal.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// Vertices that are held along some directions and slide across them.
namespace {

using namespace plica;
using namespace plica::test;

FixedVertices sliding_along(const Selection& where, const Point& normal) {
  FixedVertices fixed(where);
  fixed.slide = normal;
  return fixed;
}

FixedVertices held_along(const Selection& where, const std::vector<std::string>& axes) {
  FixedVertices fixed(where);
  fixed.along = axes;
  return fixed;
}

Selection lowest(int axis) { return HalfSpaceSelection{Point::Zero(), Point::Unit(axis)}; }

// --- A block that is pressed between three rollers -----------------------------------------------

constexpr double young = 20e3, poisson = 0.3, press = 200;  // [Pa], 1, [Pa]

/// A block of linear material, turned in space, that is pressed from above. Three of its faces
/// slide in their planes, so that its stress is uniaxial and every mesh has its displacements
/// exactly.
struct PressedBlock {
  Eigen::Matrix3d turn;
  Problem problem;

  explicit PressedBlock(double angle, int levels = 1, int cells = 3)
      : turn(Eigen::AngleAxisd(angle, Point(1, 2, 3).normalized()).toRotationMatrix()) {
    std::vector<TetMesh> meshes;
    for (int i = 0; i < levels; ++i) {
      const int n = cells >> i;
      meshes.push_back(jittered_box(decimetre, {n, n, n}));
      for (Point& x : meshes.back().vertices) x = turn * x;
    }
    problem = body_of(std::move(meshes), "linear");
    problem.body.material.young_modulus = young, problem.body.material.poisson_ratio = poisson;
    for (int k = 0; k < 3; ++k) {
      // the same by a direction and by the surface's own
      const Point normal = turn.col(k);
      problem.body.fixed.push_back(
          sliding_along(HalfSpaceSelection{Point::Zero(), normal},
                        k == 1 ? Point(Point::Zero()) : Point(3 * normal)));
    }
    const Point up = turn.col(2);
    problem.body.loads = {{HalfSpaceSelection{0.1 * up, -up}, Traction{-press * up}, {}}};
  }

  Point displacement(const Point& x) const {
    const double strain = press / young;
    return turn * Point(poisson * strain, poisson * strain, -strain).asDiagonal() *
           turn.transpose() * x;
  }
  double largest_error(const std::vector<Point>& u) const {
    const auto& X = problem.body.levels[0].vertices;
    double most = 0;
    for (std::size_t a = 0; a < u.size(); ++a)
      most = std::max(most, (u[a] - displacement(X[a])).norm());
    return most / (0.1 * press / young);
  }
  void expect_solved(const Simulation<Host>& s, double tolerance) const {
    EXPECT_LE(largest_error(displacements(s, problem.body.levels[0])), tolerance);
    const auto held = s.reactions();
    ASSERT_EQ(held.size(), 3u);
    const double whole = press * 0.01;  // [N]
    EXPECT_LE((held[2].force - whole * turn.col(2)).norm(), tolerance * whole) << held[2].set;
    for (int k = 0; k < 2; ++k)
      EXPECT_LE(held[static_cast<std::size_t>(k)].force.norm(), tolerance * whole) << k;
  }
};

/// Steps so long that inertia has no part in them.
void step_to_rest(Problem& p, const std::string& integrator = "implicit_euler") {
  p.integration.integrator = {integrator};
  p.integration.macro_step = 1e4;
  p.integration.implicit.relative_residual = 1e-11;
  p.integration.implicit.newton_tolerance = 1e-10;
}

TEST(Sliding, EveryLinearSolverPressesABlock) {
  struct Kind {
    const char *element, *solver, *preconditioner, *matrix;
  };
  const Kind kinds[] = {{"linear", "direct", "auto", "auto"},
                        {"linear", "conjugate_gradients", "block_jacobi", "assembled"},
                        {"linear", "conjugate_gradients", "block_jacobi", "free"},
                        {"linear", "conjugate_gradients", "chebyshev", "assembled"},
                        {"linear", "conjugate_gradients", "multigrid", "assembled"},
                        {"linear", "conjugate_gradients", "multigrid", "free"},
                        {"nodal", "conjugate_gradients", "block_jacobi", "free"},
                        {"nodal", "conjugate_gradients", "multigrid", "free"}};
  for (const auto& [element, solver, preconditioner, matrix] : kinds)
    for (const double angle : {0.0, 0.7}) {
      SCOPED_TRACE(std::string(element) + ", " + solver + ", " + preconditioner + ", " + matrix);
      PressedBlock block(angle, 2, 4);
      Problem& p = block.problem;
      p.body.element = {element};
      step_to_rest(p);
      p.integration.implicit.solver = solver;
      p.integration.implicit.preconditioner = preconditioner;
      p.integration.implicit.matrix = matrix;
      Simulation<Host> s(p);
      advance(s, 3);
      block.expect_solved(s, 1e-6);
    }
}

TEST(Sliding, ImplicitIntegratorsPressABlock) {
  for (const char* integrator : {"implicit_euler", "bdf2", "sdirk2"}) {
    SCOPED_TRACE(integrator);
    PressedBlock block(0.7);
    step_to_rest(block.problem, integrator);
    Simulation<Host> s(block.problem);
    advance(s, 6);
    block.expect_solved(s, 1e-6);
  }
}

// All motion decays by exp(-30 t) in the time t [s].
TEST(Sliding, ExplicitIntegratorsPressABlock) {
  for (const char* integrator : {"symplectic_euler", "central_difference", "rk4"}) {
    SCOPED_TRACE(integrator);
    PressedBlock block(0.7);
    block.problem.integration.integrator = {integrator};
    block.problem.body.damping.mass = 60;
    Simulation<Host> s(block.problem);
    advance(s, static_cast<int>(0.7 / s.macro_step()));
    block.expect_solved(s, 1e-6);
  }
}

// --- Where sliding vertices go -------------------------------------------------------------------

template <class B>
class Slides : public testing::Test {};
TYPED_TEST_SUITE(Slides, EachBackend);

template <class B>
void expect_in_plane(const Simulation<B>& s, const Problem& p, int level, const Point& normal) {
  using Real = typename B::Real;
  const TetMesh& mesh = p.body.levels[static_cast<std::size_t>(level)];
  const auto u = displacements(s, mesh, level), v = s.velocities(level);
  double moved = 0;
  for (std::size_t a = 0; a < u.size(); ++a) {
    if (mesh.vertices[a][0] != 0) continue;
    EXPECT_LE(std::abs(u[a].dot(normal)), round_off<Real>(10, 0.1)) << "level " << level;
    EXPECT_LE(std::abs(v[a].dot(normal)), round_off<Real>(10, 1)) << "level " << level;
    moved = std::max(moved, u[a].norm());
  }
  EXPECT_GT(moved, 1e-6) << "level " << level;
}

TYPED_TEST(Slides, StayInTheirPlaneWithEveryIntegrator) {
  const Point normal = Point(1, 2, -1).normalized();
  for (const std::string& integrator : names(integrators())) {
    SCOPED_TRACE(integrator);
    Problem p = small_cube();
    p.body.fixed = {sliding_along(left_face(), normal)};
    p.body.initial.velocity = {0.3, 0.1, 0.2};
    p.gravity = {1, 2, -9};
    p.body.damping.mass = 3;
    p.integration.integrator = {integrator};
    p.integration.macro_step = 5e-4;
    p.integration.substeps = {2};
    p.integration.allow_unstable = true;
    Simulation<TypeParam> s(p);
    advance(s, 30);
    expect_in_plane(s, p, 0, normal);
  }
}

TYPED_TEST(Slides, StayInTheirPlaneOnEveryLevel) {
  const Point normal = Point(1, 1, 0).normalized();
  for (const std::string& cycle : sharing_cycles()) {
    SCOPED_TRACE(cycle);
    Problem p = cube_levels(3, 4, cycle);
    p.body.fixed = {sliding_along(left_face(), normal)};
    p.gravity = {0, 3, -9};
    p.integration.macro_step = 4e-4;
    Simulation<TypeParam> s(p);
    advance(s, 30);
    for (int level = 0; level < (cycle == "single" ? 1 : 3); ++level)
      expect_in_plane(s, p, level, normal);
  }
}

// --- Planes of symmetry --------------------------------------------------------------------------

/// A block from x = `from` to 0.1, fixed below, that falls to its sides. Its cells are mirrored at
/// x = 0.
Problem standing_block(double from, int cells) {
  const bool whole = from < 0;
  TetMesh mesh = grid_mesh({cells, 3, 3}, {whole, false, false}, [=](const Point& s) {
    return Point(from + (0.1 - from) * s[0], 0.1 * s[1], 0.1 * s[2]);
  });
  Problem p = body_of({std::move(mesh)}, "neo_hookean");
  p.body.fixed = {lowest(2)};
  if (!whole) p.body.fixed.push_back(held_along(Box{{0, -1, -1}, {0, 1, 1}}, {"x"}));
  p.gravity = {0, 3, -9.81};
  p.integration.macro_step = 5e-4;
  return p;
}

TEST(Sliding, HalfABodyMovesAsTheWholeDoes) {
  for (const char* integrator : {"symplectic_euler", "implicit_euler"}) {
    SCOPED_TRACE(integrator);
    Problem whole = standing_block(-0.1, 6), half = standing_block(0, 3);
    for (Problem* p : {&whole, &half}) {
      p->integration.integrator = {integrator};
      if (p->integration.integrator[0] == "implicit_euler") p->integration.macro_step = 0.01;
      p->integration.implicit.relative_residual = 1e-11;
      p->integration.implicit.newton_tolerance = 1e-11;
    }
    Simulation<Host> a(whole), b(half);
    advance(a, 60), advance(b, 60);
    const auto u = displacements(a, whole.body.levels[0]),
               w = displacements(b, half.body.levels[0]);
    const double size = largest_length(w);
    EXPECT_GT(size, 1e-3);
    for (std::size_t i = 0; i < w.size(); ++i) {
      const std::size_t same = vertex_at(whole.body.levels[0], half.body.levels[0].vertices[i]);
      EXPECT_LE((u[same] - w[i]).norm(), 1e-7 * size) << i;
    }
    const Point below = a.reactions()[0].force, half_below = b.reactions()[0].force;
    EXPECT_NEAR(below[2], 2 * half_below[2], 1e-6 * below.norm());
    EXPECT_NEAR(below[0], 0, 1e-6 * below.norm());
    EXPECT_GT(b.reactions()[1].force.norm(), 1e-4 * below.norm());
  }
}

// --- What is said --------------------------------------------------------------------------------

std::string said(const Problem& p) {
  return refusal([&] { Simulation<Host>{p}; });
}

TEST(Supports, ClashesAreRefused) {
  Problem p = small_cube();
  p.body.fixed = {held_along(left_face(), {"x"})};
  p.integration.cycle = "him";
  EXPECT_NE(said(p).find("cycle is him, but body.fixed.0 holds"), std::string::npos) << said(p);
  p.integration.cycle = "single";
  EXPECT_EQ(said(p), "");

  p.body.prescribed = {{left_face(), Point(0, 1, 0)}};
  EXPECT_EQ(said(p), "");
  p.body.prescribed[0].motion = SteadyMotion(Point(1e-3, 1, 0));
  EXPECT_NE(said(p).find("body.fixed.0: vertex 0 of level 0 is held along [1, 0, 0], and "
                         "body.prescribed.0 moves it along that"),
            std::string::npos)
      << said(p);
  p.body.prescribed[0].rotate = Turn{.axis = Point::UnitX(), .angle = SteadyTurn{1}};
  EXPECT_EQ(said(p), "");
  p.body.prescribed[0].rotate->axis = {1, 1, 0};
  EXPECT_NE(said(p).find("is held along"), std::string::npos) << said(p);

  p.body.prescribed.clear();
  p.body.fixed[0].along = {"w"};
  EXPECT_NE(said(p).find("body.fixed.0.along.0: unknown axis 'w'"), std::string::npos) << said(p);
  p.body.fixed[0].along = {"y"}, p.body.fixed[0].slide = Point(1, 0, 0);
  EXPECT_EQ(said(p), "body.fixed.0 has along and slide; expected one of them, or neither");

  p.body.fixed = {sliding_along(Box{{0, 0, 0}, {1, 1, 1}}, Point::Zero())};
  EXPECT_NE(said(p).find("body.fixed.0.slide is normal, but vertex"), std::string::npos) << said(p);
}

TEST(Supports, DirectionsAddUp) {
  const TetMesh mesh = box_mesh(decimetre, {2, 2, 2});
  Body body;
  body.levels = {mesh};
  body.fixed = {held_along(lowest(0), {"x"}), held_along(lowest(1), {"y", "x"}),
                held_along(lowest(2), {"z"})};
  const Supports found = find_supports(body, mesh, 0);
  const std::vector<SlidingVertex>& sliding = found.sliding;
  for (std::size_t a = 0; a < mesh.vertices.size(); ++a) {
    const Point& x = mesh.vertices[a];
    const int held = (x[0] == 0 || x[1] == 0) + (x[1] == 0) + (x[2] == 0);
    EXPECT_EQ(found.constrained[a], held == 3) << a;
    const auto at = std::ranges::find(sliding, static_cast<int>(a), &SlidingVertex::vertex);
    ASSERT_EQ(at != sliding.end(), held == 1 || held == 2) << a;
    if (at == sliding.end()) continue;
    EXPECT_EQ(at->normals[1].isZero(0), held == 1) << a;
    EXPECT_NEAR(at->normals[0].dot(at->normals[1]), 0, 1e-15);
  }
  // at the edge x = y = 0 the first entry has the force along x, the second that along y
  const auto share = [&](std::size_t set, int vertex) -> Eigen::Matrix3d {
    const HeldSet& of = found.sets[set];
    const auto at = std::ranges::find(of.vertex, vertex) - of.vertex.begin();
    return of.share.at(static_cast<std::size_t>(at));
  };
  const int edge = static_cast<int>(vertex_at(mesh, {0, 0, 0.05}));
  EXPECT_EQ(share(0, edge), Eigen::Matrix3d(Point(1, 0, 0).asDiagonal()));
  EXPECT_EQ(share(1, edge), Eigen::Matrix3d(Point(0, 1, 0).asDiagonal()));
}

// Between directions that are not at right angles the force is divided so that the parts add up.
TEST(Supports, SkewDirectionsShareAForce) {
  const TetMesh mesh = box_mesh(decimetre, {1, 1, 1});
  const Point a(1, 0, 0), b = Point(1, 1, 0).normalized();
  Body body;
  body.levels = {mesh};
  body.fixed = {sliding_along(lowest(0), a), sliding_along(lowest(0), b)};
  const Supports found = find_supports(body, mesh, 0);
  const Point force = 3 * a - 2 * b;
  EXPECT_LE((found.sets[0].share[0] * force - 3 * a).norm(), 1e-14);
  EXPECT_LE((found.sets[1].share[0] * force + 2 * b).norm(), 1e-14);
}

TEST(Supports, AreNamed) {
  Body body;
  body.fixed = {left_face(), lowest(1)};
  body.prescribed = {{lowest(2), Point(1, 0, 0)}};
  EXPECT_EQ(held_names(body), (std::vector<std::string>{"fixed_0", "fixed_1", "prescribed_0"}));
  body.fixed = {GroupSelection{"left/fixed.1"}};
  body.parts.emplace_back().name = "left";
  EXPECT_EQ(held_names(body).front(), "left.fixed_1");
}

}  // namespace
