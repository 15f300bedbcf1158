// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/core/error.hpp>
#include <plica/core/time_functions.hpp>
#include <plica/drivers/run/registry.hpp>
#include <plica/drivers/study/level_probe.hpp>
#include <plica/kernels/loads/boundary_conditions.hpp>
#include <plica/kernels/materials/material.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/gradients.hpp"
#include "support/refusal.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// Prescribed vertices are where their motion says, on every level at that level's own time.
namespace {

using namespace plica;
using namespace plica::test;

const Point speed{0.2, -0.1, 0.05};

Problem pulled(Problem p) {
  p.body.prescribed = {{left_face(), speed}};
  return p;
}

template <class B>
class Prescribed : public testing::Test {};
TYPED_TEST_SUITE(Prescribed, EachBackend);

template <class B>
void expect_there(const Simulation<B>& simulation, const Problem& p, int level, double time) {
  const TetMesh& mesh = p.body.levels[static_cast<std::size_t>(level)];
  const auto u = displacements(simulation, mesh, level), v = simulation.velocities(level);
  int found = 0;
  for (std::size_t a = 0; a < u.size(); ++a)
    if (mesh.vertices[a][0] == 0) {
      ++found;
      EXPECT_LE((u[a] - time * speed).norm(), round_off<typename B::Real>(50, 0.1))
          << "level " << level;
      EXPECT_LE((v[a] - speed).norm(), round_off<typename B::Real>(2)) << "level " << level;
    }
  EXPECT_GT(found, 3);
}

TYPED_TEST(Prescribed, IsExactForEveryIntegrator) {
  for (const std::string& integrator : names(integrators())) {
    SCOPED_TRACE(integrator);
    Problem p = pulled(small_cube());
    p.body.damping.mass = 10;
    p.integration.integrator = {integrator};
    p.integration.macro_step = 5e-4;
    p.integration.substeps = {3};
    p.integration.allow_unstable = true;
    Simulation<TypeParam> simulation(p);
    advance(simulation, 50);
    expect_there(simulation, p, 0, simulation.time());
  }
}

/// Lets three levels share macro steps, and looks at each at the time at which its share ends:
/// expect(simulation, problem, level, time).
template <class B, class Change, class Expect>
void expect_at_own_times(const Change& change, const Expect& expect) {
  constexpr double t = 4e-4;
  for (const std::string& cycle : sharing_cycles()) {
    if (cycle == "single") continue;
    SCOPED_TRACE(cycle);
    Problem p = change(cube_levels(3, 4, cycle));
    p.body.damping.mass = 50;
    p.integration.distribution = "custom", p.integration.shares = {0.2, 0.3, 0.5};
    p.integration.macro_step = t;
    Simulation<B> simulation(p);
    advance(simulation, 20);
    const double before = simulation.time() - t;
    expect(simulation, p, 2, before + 0.5 * t);
    expect(simulation, p, 1, before + 0.8 * t);
    expect(simulation, p, 0, simulation.time());
  }
}

TYPED_TEST(Prescribed, IsOnEveryLevelAtItsOwnTime) {
  expect_at_own_times<TypeParam>([](const Problem& p) { return pulled(p); },
                                 [](const auto&... where) { expect_there(where...); });
}

// A body that moves as one of its sides is led stays free of stress on all levels.
TYPED_TEST(Prescribed, LeadsABodyThatMovesAlong) {
  using Real = typename TypeParam::Real;
  for (const std::string& cycle : names(cycles())) {
    SCOPED_TRACE(cycle);
    const Point drift(0.2, -0.1, 0.3);
    Problem p = cube_levels(3, 4, cycle);
    p.body.prescribed = {{left_face(), SteadyMotion(drift)}};
    p.body.initial.velocity = drift;
    p.integration.macro_step = 4e-4;
    Simulation<TypeParam> simulation(p);
    advance(simulation, 20);
    for (const Point& u : displacements(simulation, p.body.levels[0]))
      EXPECT_LE((u - simulation.time() * drift).norm(), round_off<Real>(1000, 0.1));
  }
}

// A body whose one side is pulled follows, at first by elastic forces only.
TEST(Prescribed, PullsTheBodyAlong) {
  for (const char* integrator : {"symplectic_euler", "implicit_euler"}) {
    Problem p = pulled(small_cube());
    p.body.damping.mass = 20;
    p.integration.integrator = {integrator};
    p.integration.macro_step = 1e-3;
    p.integration.substeps = {0};
    Simulation<Host> simulation(p);
    advance(simulation, 1500);
    for (const Point& v : simulation.velocities())
      EXPECT_LE((v - speed).norm(), 1e-5) << integrator;
  }
}

/// Where the vertices with x = 0 should be, and how fast.
template <class B>
void expect_on_path(const Simulation<B>& simulation, const Problem& p, int level, double time) {
  std::vector<PathKnot> knots;
  const Path path = make_path(p.body.prescribed[0].motion, knots);
  const PathPoint at = path_at(path, knots.data(), time);
  const TetMesh& mesh = p.body.levels[static_cast<std::size_t>(level)];
  const auto u = displacements(simulation, mesh, level), v = simulation.velocities(level);
  for (std::size_t a = 0; a < u.size(); ++a)
    if (mesh.vertices[a][0] == 0)
      for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(u[a][k], at.displacement[k], round_off<typename B::Real>(4, 0.1))
            << "level " << level;
        EXPECT_NEAR(v[a][k], at.velocity[k], round_off<typename B::Real>(4)) << "level " << level;
      }
}

const SineMotion shake{{0.002, 0, -0.001}, 7, 0.3};
const PathMotion there_and_back{
    {{0.003, {0, 0, 0}}, {0.0203, {0.004, 0, 0.002}}, {0.033, {0, 0.001, 0}}}};

TYPED_TEST(Prescribed, FollowsItsPathUnderEveryIntegrator) {
  for (const Motion& motion : {Motion(shake), Motion(there_and_back)})
    for (const std::string& integrator : names(integrators())) {
      SCOPED_TRACE(integrator);
      Problem p = small_cube();
      p.body.prescribed = {{left_face(), motion}};
      p.body.damping.mass = 10;
      p.integration.integrator = {integrator};
      p.integration.macro_step = 5e-4;
      p.integration.substeps = {3};
      p.integration.allow_unstable = true;
      Simulation<TypeParam> simulation(p);
      for (int n = 0; n < 80; ++n) {
        advance(simulation, 1);
        if (n % 13 == 0 || n == 79) expect_on_path(simulation, p, 0, simulation.time());
      }
    }
}

TYPED_TEST(Prescribed, IsOnItsPathOnEveryLevelAfterTransfers) {
  const auto led = [](Problem p) {
    p.body.prescribed = {{left_face(), shake}};
    return p;
  };
  expect_at_own_times<TypeParam>(led, [](const auto&... where) { expect_on_path(where...); });
}

TYPED_TEST(Prescribed, TenThousandStepsLeaveNoDrift) {
  Problem p = body_of({box_mesh(decimetre, {1, 1, 1})});
  p.body.prescribed = {{left_face(), SineMotion{{0.001, 0, 0}, 2, 0}}};
  p.body.damping.mass = 10;
  p.integration.macro_step = 1e-3;
  Simulation<TypeParam> simulation(p);
  for (int n = 0; n < 10000; ++n) simulation.step();
  EXPECT_FALSE(simulation.check());
  EXPECT_DOUBLE_EQ(simulation.time(), 10.0);  // twenty periods: back at rest's place
  const auto u = displacements(simulation, p.body.levels[0]);
  for (std::size_t a = 0; a < u.size(); ++a)
    if (p.body.levels[0].vertices[a][0] == 0) {
      EXPECT_LE(u[a].norm(), round_off<typename TypeParam::Real>(1, 0.1));
    }
}

// A path that begins elsewhere begins there, on every level.
TEST(Prescribed, StartsWhereItsPathDoes) {
  Problem p = cube_levels(2, 3, "rs");
  p.body.prescribed = {{left_face(), PathMotion{{{0, {-0.003, 0, 0}}, {1, {0, 0, 0}}}}}};
  const Simulation<Host> simulation(p);
  for (int level : {0, 1}) expect_on_path(simulation, p, level, 0);
}

std::string refusal_of(const Problem& p) {
  return refusal([&] { Simulation<Host>{p}; });
}

TEST(Prescribed, AVertexHasOneMotion) {
  Problem p = pulled(small_cube());
  p.body.fixed = {left_face()};
  EXPECT_NE(refusal_of(p).find(
                "body.fixed.0: vertex 0 of level 0 is prescribed by body.prescribed.0 too"),
            std::string::npos)
      << refusal_of(p);
  p.body.fixed.clear();
  p.body.prescribed.push_back({Box{{0, 0, 0}, {1, 0, 1}}, Point(1, 0, 0)});
  EXPECT_NE(refusal_of(p).find(
                "body.prescribed.1: vertex 0 of level 0 is prescribed by body.prescribed.0 too"),
            std::string::npos)
      << refusal_of(p);
}

// Regions of a mesh with constants of their own.

Problem two_halves() {
  Problem p =
      body_of({with_regions(box_mesh(decimetre, {4, 4, 4}), 0.05, "stiff", "soft")}, "linear");
  p.body.regions["stiff"].young_modulus = 2e6;
  p.body.regions["stiff"].poisson_ratio = 0.1;
  return p;
}

template <class B>
class Regions : public testing::Test {};
TYPED_TEST_SUITE(Regions, EachBackend);

TYPED_TEST(Regions, HaveTheirOwnStress) {
  using Real = typename TypeParam::Real;
  const Problem p = two_halves();
  LevelProbe<TypeParam> probe(p);
  const double strain = 0.01, volume = 0.5e-3;
  std::vector<Point> u;
  for (const Point& x : p.body.levels[0].vertices) u.push_back({strain * x[0], 0, 0});
  const auto energy = [&](double E, double nu) {
    const auto c = lame_constants(E, nu);
    return (0.5 * c.lambda + c.mu) * strain * strain * volume;
  };
  const double want = energy(2e6, 0.1) + energy(20e3, 0.35);
  EXPECT_NEAR(probe.elastic_energy(u), want, round_off<Real>(5e3, want));
}

TYPED_TEST(Regions, PatchesDoNotSpanThem) {
  const Problem p = two_halves();
  LevelProbe<TypeParam> probe(p);
  const auto& patches = probe.at(0).model.patches;
  const auto host = [](const auto& view) {
    return Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), view);
  };
  const auto first = host(patches.first_pack), element = host(patches.element);
  std::vector<int> seen(p.body.levels[0].tets.size(), 0);
  for (int patch = 0; patch < patches.count; ++patch) {
    int region = -1;
    for (int slot = first(patch) * TypeParam::lanes; slot < first(patch + 1) * TypeParam::lanes;
         ++slot) {
      if (element(slot) < 0) continue;
      const auto e = static_cast<std::size_t>(element(slot));
      ++seen[e];
      if (region < 0) region = p.body.levels[0].region[e];
      EXPECT_EQ(region, p.body.levels[0].region[e]);
    }
  }
  for (int count : seen) EXPECT_EQ(count, 1);
}

// In series under one load each half stretches by its own modulus.
TEST(Regions, SoftHalfTakesTheStretch) {
  Problem p =
      body_of({with_regions(box_mesh(beam_box, {8, 2, 2}), 0.2, "stiff", "soft")}, "linear");
  p.body.material.poisson_ratio = 0;
  p.body.regions["stiff"].young_modulus = 80e3;
  p.body.fixed = {left_face()};
  p.body.prescribed = {{Box{{0.4, 0, 0}, {0.4, 0.1, 0.1}}, Point(0.01, 0, 0)}};
  p.body.damping.mass = 5;
  p.integration.integrator = {"implicit_euler"};
  p.integration.macro_step = 0.1;
  Simulation<Host> simulation(p);
  advance(simulation, 10);  // pulled slowly to 10 mm within 1 s
  const auto u = displacements(simulation, p.body.levels[0]);
  double middle = 0;
  int count = 0;
  for (std::size_t a = 0; a < u.size(); ++a)
    if (std::abs(p.body.levels[0].vertices[a][0] - 0.2) < 1e-9) middle += u[a][0], ++count;
  EXPECT_NEAR(middle / count, 0.01 * 0.2, 2e-5);  // 1 : 4
}

TEST(Regions, GroupsSelectVertices) {
  Problem p = two_halves();
  p.body.levels[0].vertex_sets["corner"] = {0, 1, 7};
  p.body.fixed = {RegionSelection{"soft"}, GroupSelection{"corner"}};
  LevelProbe<Host> probe(p);
  const auto inverse = probe.inverse_mass();
  const auto& mesh = p.body.levels[0];
  for (std::size_t a = 0; a < inverse.size(); ++a) {
    const bool fixed = mesh.vertices[a][0] > 0.05 - 1e-9 || a == 0 || a == 1 || a == 7;
    if (std::abs(mesh.vertices[a][0] - 0.05) > 1e-9) {
      EXPECT_EQ(inverse[a] == 0, fixed) << a;
    }
  }
  p.body.fixed = {GroupSelection{"sofd"}};
  const auto again = [&] { LevelProbe<Host>{p}; };
  EXPECT_NE(refusal(again).find("did you mean 'soft'?"), std::string::npos) << refusal(again);
  p.body.fixed = {Box{{1, 1, 1}, {2, 2, 2}}};
  EXPECT_NE(refusal(again).find("selects no vertex on level 0"), std::string::npos)
      << refusal(again);
}

}  // namespace
