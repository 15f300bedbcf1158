// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/drivers/study/level_probe.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"

// Relaxation by Prony series: what it does to a body, and when it goes on. Known answers are in
// drivers/study/verify/viscosity.cpp.
namespace {

using namespace plica;
using namespace plica::test;

const std::vector<PronyTerm> terms = {{0.3, 1e-3}, {0.4, 0.05}};

Problem viscous(const std::string& cycle, const std::string& integrator,
                const std::string& element = "nodal") {
  Problem p = cube_levels(cycle == "single" ? 1 : 2, 4, cycle);
  p.body.material = complete({"neo_hookean", 20e3, 0.4, 1000});
  p.body.material.prony = terms;
  p.body.element = {element};
  p.body.fixed = {left_face()};
  p.body.initial.stretch = {1.1, 1, 0.95};
  p.gravity = {0, 0, -9.81};
  p.integration.integrator = {integrator};
  p.integration.macro_step = integrator == "newmark" ? 4e-3 : 2e-4;
  p.integration.allow_unstable = true;
  return p;
}

const std::pair<const char*, const char*> methods[] = {{"single", "symplectic_euler"},
                                                       {"single", "central_difference"},
                                                       {"single", "euler"},
                                                       {"single", "rk2"},
                                                       {"single", "rk4"},
                                                       {"single", "newmark"},
                                                       {"single", "bdf2"},
                                                       {"single", "generalized_alpha"},
                                                       {"rsv", "symplectic_euler"},
                                                       {"fas", "central_difference"},
                                                       {"him", "symplectic_euler"}};

template <class B>
class Viscosity_ : public testing::Test {};
TYPED_TEST_SUITE(Viscosity_, EachBackend);

// Saved and restored, and looked at in between or not: the same bits
TYPED_TEST(Viscosity_, GoesOnFromASavedState) {
  for (const auto& [cycle, integrator] : methods)
    for (const char* element : {"linear", "nodal"}) {
      SCOPED_TRACE(std::string(cycle) + " " + integrator + " " + element);
      const Problem problem = viscous(cycle, integrator, element);
      Simulation<TypeParam> whole(problem), second(problem);
      advance(whole, 3);
      const SavedState saved = whole.save();
      second.restore(saved);
      for (int n = 0; n < 4; ++n) {
        advance(whole, 1);
        whole.energies(), whole.element_fields();
      }
      advance(second, 4);
      EXPECT_EQ(whole.save().bytes, second.save().bytes);
    }
}

TYPED_TEST(Viscosity_, GoesBackWithTheState) {
  Simulation<TypeParam> simulation(viscous("single", "symplectic_euler"));
  advance(simulation, 7);
  const auto first = simulation.positions();
  simulation.return_to_last_good();
  EXPECT_EQ(simulation.time(), 0);
  advance(simulation, 7);
  EXPECT_EQ(first, simulation.positions());
  // the state that it has
  Simulation<TypeParam> other(viscous("single", "symplectic_euler"));
  advance(other, 3);
  other.set_state(displacements(other, viscous("single", "symplectic_euler").body.levels[0]),
                  other.velocities());
  advance(other, 4);
  for (std::size_t a = 0; a < first.size(); ++a)
    EXPECT_LE((other.positions()[a] - first[a]).norm(), 1e-7);
}

// Two halves that share no vertex: each relaxes by its own terms
TYPED_TEST(Viscosity_, OfARegionIsItsOwn) {
  for (const char* element : {"linear", "nodal"}) {
    SCOPED_TRACE(element);
    TetMesh mesh = box_mesh(decimetre, {2, 2, 1});
    const auto count = static_cast<int>(mesh.vertices.size());
    const std::size_t tets = mesh.tets.size();
    mesh.region_names = {"left", "right"}, mesh.region.assign(tets, 0);
    for (int v = 0; v < count; ++v)
      mesh.vertices.push_back(mesh.vertices[static_cast<std::size_t>(v)] + Point(1, 0, 0));
    for (std::size_t t = 0; t < tets; ++t) {
      mesh.tets.push_back(mesh.tets[t]), mesh.region.push_back(1);
      for (int& v : mesh.tets.back()) v += count;
    }
    Problem p = body_of({mesh}, "neo_hookean");
    p.body.element = {element};
    p.body.regions["right"].prony = terms;
    p.body.regions["left"].prony = {{0.5, 0.02}};
    const Box low{{-1, -1, -1}, {2, 1, 0.01}}, high{{-1, -1, 0.09}, {2, 1, 1}};
    p.body.fixed = {low};
    p.body.prescribed = {{high, PathMotion{{{0, Point(0.01, 0, 0.02)}}}}};
    p.integration.macro_step = 1e-2, p.integration.allow_unstable = true;
    Simulation<TypeParam> simulation(p);
    const auto start = simulation.element_fields().von_mises;
    advance(simulation, 5);
    const auto now = simulation.element_fields().von_mises;
    const double right = 1 - 0.3 * (1 - std::exp(-50)) - 0.4 * (1 - std::exp(-1)),
                 left = 1 - 0.5 * (1 - std::exp(-2.5));
    for (std::size_t t = 0; t < now.size(); ++t)
      EXPECT_NEAR(now[t] / start[t], t < now.size() / 2 ? left : right, 1e-5) << t;
    p.body.regions.erase("left");  // elastic
    Simulation<TypeParam> half(p);
    advance(half, 5);
    EXPECT_NEAR(half.element_fields().von_mises[0] / start[0], 1, 1e-5);
    EXPECT_NEAR(half.element_fields().von_mises.back() / start.back(), right, 1e-5);
  }
}

// A body that nothing holds back is as stiff as its series says: softer steps, longer oscillations
TYPED_TEST(Viscosity_, RelaxesTheStressThatIsReported) {
  for (const char* element : {"linear", "nodal"}) {
    // all vertices on two faces
    Problem p = body_of({box_mesh(decimetre, {2, 2, 1})}, "neo_hookean");
    p.body.element = {element}, p.body.material.prony = terms;
    const Box low{{-1, -1, -1}, {1, 1, 0.01}}, high{{-1, -1, 0.09}, {1, 1, 1}};
    p.body.fixed = {low};
    p.body.prescribed = {{high, PathMotion{{{0, Point(0.01, 0, 0.02)}}}}};
    p.integration.macro_step = 1e-2, p.integration.allow_unstable = true;
    Simulation<TypeParam> simulation(p);
    const double start = simulation.element_fields().von_mises[0];
    EXPECT_GT(start, 1000);
    for (int n = 1; n <= 20; ++n) {
      advance(simulation, 1);
      const double t = 1e-2 * n,
                   left = 1 - 0.3 * (1 - std::exp(-t / 1e-3)) - 0.4 * (1 - std::exp(-t / 0.05));
      EXPECT_NEAR(simulation.element_fields().von_mises[0] / start, left, 1e-5)
          << n << " " << element;
    }
  }
}

// Over a step from rest the tangent is the force's derivative
TEST(Viscosity, HasTheTangentOfAStep) {
  for (const char* element : {"linear", "nodal"}) {
    Problem p = viscous("single", "newmark", element);
    p.body.initial.stretch = {1, 1, 1}, p.gravity.setZero(), p.body.fixed.clear();
    LevelProbe<Host> probe(p);
    const std::size_t n = probe.vertices();
    const auto u = random_field(n, 2e-3, 1), d = random_field(n, 1e-6, 2), none = probe.zero();
    std::vector<Point> ahead = u, behind = u;
    for (std::size_t a = 0; a < n; ++a) ahead[a] += d[a], behind[a] -= d[a];
    for (const double t : {0.0, 1e-3, 1.0}) {
      const auto up = probe.force(ahead, none, t), down = probe.force(behind, none, t),
                 Kd = probe.stiffness(u, d);
      double error = 0, size = 0;
      for (std::size_t a = 0; a < n; ++a) {
        error = std::max(error, (0.5 * (up[a] - down[a]) + Kd[a]).norm());
        size = std::max(size, Kd[a].norm());
      }
      EXPECT_LE(error, 1e-5 * size) << element << " " << t;
    }
  }
}

TEST(Viscosity, LetsNewtonsMethodConverge) {
  Problem p = viscous("single", "newmark");
  Simulation<Host> simulation(p);
  advance(simulation, 10);
  EXPECT_EQ(simulation.counters().at("newton_misses"), 0);
  EXPECT_LT(simulation.counters().at("newton_iterations"), 80);
}

TEST(Viscosity, IsNotThereWhereNothingRelaxes) {
  const auto viscosity = [](const Problem& p) {
    for (const Part& part : Simulation<Host>(p).parts())
      if (part.name == "viscosity") return part;
    return Part{};
  };
  Problem p = viscous("single", "symplectic_euler");
  const Part in = viscosity(p);
  EXPECT_TRUE(in.in);
  EXPECT_GT(in.bytes, 125u * 18 * 8);
  p.body.material.prony.clear();
  const Part out = viscosity(p);
  EXPECT_FALSE(out.in);
  EXPECT_EQ(out.bytes, 0u);
}

}  // namespace
