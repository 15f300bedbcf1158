// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/core/error.hpp>
#include <plica/drivers/methods/methods.hpp>
#include <plica/drivers/run/registry.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/generators.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// What every cycle must keep, walking the list of cycles.
namespace {

using namespace plica;
using namespace plica::test;

template <class B>
class CyclesOn : public testing::Test {};
TYPED_TEST_SUITE(CyclesOn, EachBackend);

template <class B>
std::vector<Point> state_after(const Problem& p, int steps) {
  Simulation<B> simulation(p);
  advance(simulation, steps);
  auto state = simulation.positions();
  const auto v = simulation.velocities();
  state.insert(state.end(), v.begin(), v.end());
  return state;
}

TYPED_TEST(CyclesOn, OneLevelIsTheSingleLevelSolverBitForBit) {
  for (const std::string& integrator : names(integrators())) {
    Problem p = small_cube("neo_hookean");
    p.gravity = {0, 0, -9.81};
    p.body.fixed = {left_face()};
    p.body.damping.mass = 2;
    p.body.initial.velocity = {0, 0.3, 0};
    p.integration.integrator = {integrator};
    p.integration.macro_step = 4e-4;
    p.integration.allow_unstable = true;
    p.integration.shift_to_coarsest = 0.5;
    p.integration.substeps = {2};
    const auto single = state_after<TypeParam>(p, 20);
    for (const std::string& cycle : sharing_cycles()) {
      p.integration.cycle = cycle;
      EXPECT_TRUE(same_bits(state_after<TypeParam>(p, 20), single)) << integrator << " " << cycle;
    }
  }
}

TYPED_TEST(CyclesOn, SingleIgnoresTheCoarseLevels) {
  Problem p = cube_levels(3, 4, "single");
  p.gravity = {0, 0, -9.81};
  p.integration.macro_step = 4e-4;
  const auto with = state_after<TypeParam>(p, 10);
  p.body.levels.resize(1);
  EXPECT_TRUE(same_bits(state_after<TypeParam>(p, 10), with));
}

// Without forces every level flies on at the same speed: no part of the motion is lost or counted
// twice. (Few steps: cycles that are unstable on their own multiply rounding errors.)
TYPED_TEST(CyclesOn, FreeFlightIsUniformMotion) {
  using Real = typename TypeParam::Real;
  for (const std::string& cycle : sharing_cycles())
    for (const char* distribution : {"equal", "critical", "inverse_elements"}) {
      Problem p = cube_levels(3, 4, cycle);
      p.body.initial.velocity = {1, -2, 0.5};
      p.integration.distribution = distribution;
      Simulation<TypeParam> simulation(p);
      advance(simulation, 12);
      const Point want = simulation.time() * p.body.initial.velocity;
      const auto u = displacements(simulation, p.body.levels[0]), v = simulation.velocities();
      const std::vector<Point> all(u.size(), want), speed(v.size(), p.body.initial.velocity);
      EXPECT_LE(largest_difference(u, all), round_off<Real>(2000, 0.1))
          << cycle << " " << distribution;
      EXPECT_LE(largest_difference(v, speed), round_off<Real>(20000))
          << cycle << " " << distribution;
    }
}

// Under gravity the levels act one after the other: one vertex that takes their steps in turn.
TYPED_TEST(CyclesOn, FreeFallIsTheExactSequenceOfSteps) {
  using Real = typename TypeParam::Real;
  for (const std::string& cycle : sharing_cycles()) {
    Problem p = cube_levels(2, 4, cycle);
    p.gravity = {0, 0, -9.81};
    p.body.initial.velocity = {0, 0, 1};
    p.integration.distribution = "custom", p.integration.macro_step = 6e-4;
    const bool single = cycle == "single";
    p.integration.shares = single ? std::vector<double>{1.0} : std::vector<double>{0.25, 0.75};
    p.integration.substeps = {1, 3};
    Simulation<TypeParam> simulation(p);
    advance(simulation, 60);
    double u = 0, v = 1;
    const auto take = [&](double h) { v += h * -9.81, u += h * v; };
    for (int n = 0; n < 60; ++n) {
      if (single) {
        take(6e-4);
        continue;
      }
      for (int s = 0; s < 3; ++s) take(0.75 * 6e-4 / 3);
      take(0.25 * 6e-4);
    }
    for (const Point& x : displacements(simulation, p.body.levels[0]))
      EXPECT_LE((x - Point(0, 0, u)).norm(), round_off<Real>(1000, 0.1)) << cycle;
    for (const Point& x : simulation.velocities())
      EXPECT_LE((x - Point(0, 0, v)).norm(), round_off<Real>(5000)) << cycle;
  }
}

// Barycentric rows sum to 1 whatever the meshes: a translation crosses levels that do not overlap
// fully.
TYPED_TEST(CyclesOn, TranslationIsExactOnLevelsThatOverlapInPart) {
  using Real = typename TypeParam::Real;
  for (const char* outside : {"clamp", "extrapolate"})
    for (const std::string& cycle : names(cycles())) {
      // hands masses down, which pile up here: what rounding stirs up grows
      const bool corrected = cycle == "fas";
      if ((corrected || cycle == "him") && outside == std::string("extrapolate")) continue;
      Problem p =
          body_of({jittered_box(decimetre, {4, 4, 4}), ball_mesh({0.05, 0.05, 0.05}, 0.05, 4)});
      p.integration.cycle = cycle, p.integration.outside = outside;
      p.body.initial.velocity = {0, 0, -3};
      Simulation<TypeParam> simulation(p);
      advance(simulation, corrected ? 5 : 50);
      for (const Point& u : displacements(simulation, p.body.levels[0]))
        EXPECT_LE((u - Point(0, 0, -3 * simulation.time())).norm(), round_off<Real>(2000, 0.3))
            << cycle << outside;
    }
}

// What is done with outside vertices is of no account where there are none.
TYPED_TEST(CyclesOn, OutsideRulesAgreeOnLevelsThatOverlapFully) {
  const auto after = [](const char* outside) {
    Problem p = cube_levels(2, 4, "rsv");
    p.body.initial.angular_velocity = {0, 0, 2};
    p.integration.outside = outside;
    return state_after<TypeParam>(p, 10);
  };
  const auto clamped = after("clamp");
  for (const char* outside : {"extrapolate", "keep"})
    EXPECT_LE(largest_difference(after(outside), clamped), round_off<typename TypeParam::Real>(1e4))
        << outside;
}

// Detail that a coarser mesh cannot have stays where its variation goes up, and is lost where its
// state does.
TYPED_TEST(CyclesOn, DetailStaysWhereVariationsGoUp) {
  for (const std::string& cycle : sharing_cycles()) {
    Problem p = cube_levels(2, 4, cycle);
    p.integration.macro_step = 1e-7, p.integration.switch_threshold = 1e6;
    Simulation<TypeParam> simulation(p);
    const auto detail = random_field(p.body.levels[0].vertices.size(), 1e-4, 3);
    simulation.set_state(detail, std::vector<Point>(detail.size(), Point::Zero()));
    for (int n = 0; n < 3; ++n) simulation.step();
    const double lost =
        largest_difference(displacements(simulation, p.body.levels[0]), detail) / 1e-4;
    if (cycle == "rs")
      EXPECT_GT(lost, 0.1);
    else
      EXPECT_LT(lost, 0.01) << cycle;
  }
}

// The restriction of a variation telescopes: with nothing fixed, `rv` is `rsv` that never switches.
TYPED_TEST(CyclesOn, SwitchingNeverIsVariationAndAlwaysIsState) {
  const auto after = [](const std::string& cycle, double threshold) {
    Problem p = cube_levels(2, 4, cycle);
    p.body.initial.angular_velocity = {0, 0, 2};
    p.integration.switch_threshold = threshold;
    return state_after<TypeParam>(p, 20);
  };
  EXPECT_TRUE(same_bits(after("rsv", 1e6), after("rv", 1)));
  EXPECT_LE(largest_difference(after("rsv", 1e-30), after("rs", 1)),
            round_off<typename TypeParam::Real>(1e4));
}

TYPED_TEST(CyclesOn, EveryOneHoldsALoadedBeam) {
  for (const std::string& cycle : names(cycles())) {
    Problem p =
        body_of({box_mesh(beam_box, {12, 4, 4}), box_mesh(beam_box, {8, 3, 3})}, "corotational");
    p.gravity = {0, 0, -9.81};
    p.body.damping.mass = 20;
    p.body.fixed = {left_face()};
    p.integration.cycle = cycle;
    Simulation<TypeParam> simulation(p);
    advance(simulation, 100);
    for (int level = 0; level < (integrates_coarse_levels(cycle) ? 2 : 1); ++level) {
      const TetMesh& mesh = p.body.levels[static_cast<std::size_t>(level)];
      const auto u = displacements(simulation, mesh, level);
      for (std::size_t a = 0; a < u.size(); ++a)
        if (mesh.vertices[a][0] == 0) {
          EXPECT_EQ(u[a].norm(), 0) << cycle;
        }
      EXPECT_GT(largest(u), 0.1) << cycle;
    }
    // what they hand up grows on a loaded body: by and by, and not unnoticed
    if (cycle == "rv" || cycle == "rsv_sv") {
      std::optional<Diagnosis> bad;
      for (int n = 0; n < 1500 && !bad; ++n) simulation.step(), bad = simulation.check();
      ASSERT_TRUE(bad) << cycle;
      EXPECT_TRUE(bad->kind == "energy" || bad->kind == "speed") << cycle << " " << bad->text();
    }
  }
}

// Every cycle on one to five levels, nested and not, with and without contact.

template <class B>
class CycleMatrix : public testing::Test {};
TYPED_TEST_SUITE(CycleMatrix, EachBackend);

/// Nested: the coarsest level is one cell, every finer one halves the edges. Otherwise 6, 5, 4 ...
/// cells, moved at random.
Problem cube(int levels, bool nested) {
  Problem p = cube_levels(levels, 6, "single");
  for (int i = 0; nested && i < levels; ++i) {
    const int cells = 1 << (levels - 1 - i);
    p.body.levels[static_cast<std::size_t>(i)] = box_mesh(decimetre, {cells, cells, cells});
  }
  return p;
}

/// A quarter of the finest level's critical step in all.
double small_step(Problem p) {
  p.integration.cycle = "single", p.integration.macro_step.reset();
  return 0.25 * Simulation<Host>(p).levels()[0].critical_step;
}

template <class Act>
void for_each_hierarchy(const Act& act) {
  for (const bool nested : {true, false})
    for (int levels = 1; levels <= 5; ++levels) {
      SCOPED_TRACE(std::string(nested ? "nested, " : "not nested, ") + std::to_string(levels) +
                   " levels");
      act(cube(levels, nested));
    }
}

TYPED_TEST(CycleMatrix, TranslatesExactly) {
  using Real = typename TypeParam::Real;
  for_each_hierarchy([](Problem p) {
    p.body.initial.velocity = {1, -2, 0.5};
    p.integration.macro_step = small_step(p);
    for (const std::string& cycle : names(cycles())) {
      p.integration.cycle = cycle;
      Simulation<TypeParam> simulation(p);
      const auto meshes = std::ranges::count_if(simulation.levels(),
                                                [](const LevelReport& l) { return l.tets > 0; });
      EXPECT_EQ(meshes, cycle == "single" ? 1 : std::ssize(p.body.levels));
      advance(simulation, 5);
      const Point want = simulation.time() * p.body.initial.velocity;
      for (const Point& u : displacements(simulation, p.body.levels[0]))
        EXPECT_LE((u - want).norm(), round_off<Real>(500, 0.1)) << cycle;
      for (const Point& v : simulation.velocities())
        EXPECT_LE((v - p.body.initial.velocity).norm(), round_off<Real>(2000, 2)) << cycle;
    }
  });
}

// A cube that turns lands on a floor, its lowest vertices a tenth of a millimetre deep in it.
TYPED_TEST(CycleMatrix, StaysSoundInContact) {
  for_each_hierarchy([](Problem p) {
    p.gravity = {0, 0, -9.81};
    p.body.initial.velocity = {0, 0, -0.2};
    p.body.initial.angular_velocity = {1, 0, 2};
    p.body.surface = boundary_surface(p.body.levels[0]).surface;
    p.contact.obstacles.push_back({PlaneOptions{{0, 0, 1e-4}, {0, 0, 1}}, 0.3, {}});
    p.integration.macro_step = small_step(p);
    std::vector<Point> single;
    for (const std::string& cycle : names(cycles())) {
      p.integration.cycle = cycle;
      Simulation<TypeParam> simulation(p);
      double touched = 0;
      for (int n = 0; n < 10; ++n)
        advance(simulation, 1), touched = std::max(touched, simulation.energies().contact);
      EXPECT_GT(touched, 0) << cycle;
      EXPECT_LT(largest(displacements(simulation, p.body.levels[0])), 0.5 * simulation.time())
          << cycle;
      if (cycle == "single") single = simulation.positions();
      EXPECT_TRUE(p.body.levels.size() > 1 || cycle == "him" ||
                  same_bits(simulation.positions(), single))
          << cycle;
    }
  });
}

// The corrected cycle: what its adjoint transfers conserve, and whose equilibrium it keeps.

template <class B>
class CorrectedCycle : public testing::Test {};
TYPED_TEST_SUITE(CorrectedCycle, EachBackend);

double mass_of(const Problem& p) {
  double volume = 0;
  for (const auto& t : p.body.levels[0].tets) {
    const auto x = [&](std::size_t k) {
      return p.body.levels[0].vertices[static_cast<std::size_t>(t[k])];
    };
    volume += tet_volume(x(0), x(1), x(2), x(3));
  }
  return volume * p.body.material.density;
}

Problem hanging(const std::string& cycle) {
  Problem p = body_of({jittered_box(beam_box, {12, 3, 3}), jittered_box(beam_box, {7, 2, 2})},
                      "corotational");
  p.body.material.young_modulus = 200e3;
  p.body.fixed = {left_face()};
  p.gravity = {0, 0, -9.81};
  p.integration.cycle = cycle;
  return p;
}

TYPED_TEST(CorrectedCycle, InheritsTheWholeMass) {
  Problem p = cube_levels(3, 6, "fas");
  const Simulation<TypeParam> simulation(p);
  for (const LevelReport& level : simulation.levels()) {
    EXPECT_NEAR(level.mass, mass_of(p), round_off<double>(100, mass_of(p)));
    EXPECT_EQ(level.massless, 0);
  }
}

// the second level is the finer one: most of its vertices find none of the first in their elements
TYPED_TEST(CorrectedCycle, GivesMassToVerticesThatInheritNone) {
  Problem p = body_of({jittered_box(decimetre, {2, 2, 2}), jittered_box(decimetre, {6, 6, 6})});
  p.integration.cycle = "fas";
  p.body.initial.velocity = {1, 2, 3};
  Simulation<TypeParam> simulation(p);
  EXPECT_GT(simulation.levels()[1].massless, 100);
  EXPECT_NEAR(simulation.levels()[1].mass, mass_of(p), round_off<double>(1000, mass_of(p)));
  advance(simulation, 20);
  for (const Point& v : simulation.velocities())
    EXPECT_LE((v - Point(1, 2, 3)).norm(), round_off<typename TypeParam::Real>(1e4, 4));
}

TYPED_TEST(CorrectedCycle, KeepsLinearMomentum) {
  Problem p = cube_levels(3, 6, "fas");
  Simulation<TypeParam> simulation(p);
  const auto n = p.body.levels[0].vertices.size();
  const auto kick = random_field(n, 0.1, 3);
  simulation.set_state(std::vector<Point>(n, Point::Zero()), kick);
  const auto momentum = [&](const std::vector<Point>& v) {
    Point sum = Point::Zero();
    for (const auto& t : p.body.levels[0].tets) {
      const auto x = [&](std::size_t k) {
        return p.body.levels[0].vertices[static_cast<std::size_t>(t[k])];
      };
      for (int a : t)
        sum += 250 * tet_volume(x(0), x(1), x(2), x(3)) * v[static_cast<std::size_t>(a)];
    }
    return sum;
  };
  const Point before = momentum(kick);
  for (int step = 0; step < 30; ++step) simulation.step();
  EXPECT_GT(largest(displacements(simulation, p.body.levels[0])), 1e-3);
  EXPECT_LE((momentum(simulation.velocities()) - before).norm(),
            round_off<typename TypeParam::Real>(300, mass_of(p) * 0.1));
}

TYPED_TEST(CorrectedCycle, KeepsTheFinestMeshsEquilibrium) {
  const Problem still = [] {
    Problem p = hanging("single");
    p.body.damping.mass = 12;
    return p;
  }();
  Simulation<TypeParam> settling(still);
  while (settling.time() < 4) settling.step();
  ASSERT_LE(largest(settling.velocities()), 3e-4);
  const auto u = displacements(settling, still.body.levels[0]);
  const double sag = largest(u);
  const auto moved_by = [&](const char* cycle) {
    const Problem p = hanging(cycle);
    Simulation<TypeParam> simulation(p);
    simulation.set_state(u, std::vector<Point>(u.size(), Point::Zero()));
    for (int step = 0; step < 20; ++step) simulation.step();
    return largest_difference(displacements(simulation, p.body.levels[0]), u) / sag;
  };
  EXPECT_LE(moved_by("fas"), 1e-5);
  EXPECT_GT(moved_by("rs"), 1e-2);  // the control: the coarse level pulls towards its own
}

TYPED_TEST(CorrectedCycle, NeedsWeightsThatHandMassDown) {
  Problem p = cube_levels(2, 4, "fas");
  p.integration.outside = "extrapolate";
  EXPECT_THROW(Simulation<TypeParam>{p}, InputError);
}

}  // namespace
