// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <numbers>
#include <plica/drivers/study/level_probe.hpp>
#include <plica/drivers/study/sample_bodies.hpp>
#include <plica/drivers/study/sample_gradients.hpp>
#include <plica/meshes/generators.hpp>
#include <plica/meshes/organs.hpp>
#include <random>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/refusal.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// Loads that give the volume of a cavity, by the pressure of a fluid in it.
namespace {

using namespace plica;
using namespace plica::test;

constexpr double K = 30e3, hole = 0.04;  // of the fluid [Pa]; the edge of the cavity [m]
const Selection walls = Box{{0.04, 0.04, 0.04}, {0.08, 0.08, 0.08}};

/// A cube of 12 cm with a hole in its middle.
TetMesh hollow_cube() {
  TetMesh mesh = box_mesh({{0, 0, 0}, {0.12, 0.12, 0.12}}, {3, 3, 3});
  std::erase_if(mesh.tets, [&](const auto& t) {
    Point centre = Point::Zero();
    for (const int v : t) centre += mesh.vertices[static_cast<std::size_t>(v)] / 4;
    return (centre - Point(0.06, 0.06, 0.06)).cwiseAbs().maxCoeff() < 0.02;
  });
  return mesh;
}

Problem balloon(double ratio, double bulk_modulus = K) {
  Problem p = body_of({hollow_cube()}, "neo_hookean");
  p.body.loads = {{walls, EnclosedVolume{ratio, bulk_modulus}, RampCourse{0.2}}};
  return p;
}

template <class B>
class Cavities : public testing::Test {};
TYPED_TEST_SUITE(Cavities, EachBackend);

// In any homogeneous deformation F the cavity has det F times its volume, wherever it went: the
// forces are those of that pressure
TYPED_TEST(Cavities, HaveThePressureOfTheirFluid) {
  using Real = typename TypeParam::Real;
  Problem p = balloon(1.5);
  p.body.initial.position = Point(0.3, 0.2, 0.1);
  LevelProbe<TypeParam> fluid(p);
  std::mt19937 random(5);
  const Eigen::Matrix3d F = random_rotation(random) * Point(1.2, 0.7, 0.9).asDiagonal();
  const double pressure = K * (1.25 - F.determinant());  // at half of the ramp
  p.body.loads = {{walls, FollowerPressure{pressure}, {}}};
  LevelProbe<TypeParam> given(p);
  const auto u = affine_field(p.body.levels[0], F, Point(0.02, 0, 0));
  const auto f = fluid.force(u, fluid.zero(), 0.1), same = given.force(u, given.zero());
  for (std::size_t a = 0; a < f.size(); ++a)
    EXPECT_LE((f[a] - same[a]).norm(), round_off<Real>(2e3, K * hole * hole)) << a;
}

TYPED_TEST(Cavities, SayVolumeAndPressure) {
  using Real = typename TypeParam::Real;
  Problem p = balloon(1.3);
  p.body.damping.mass = 100;
  Simulation<TypeParam> simulation(p);
  const CavityState rest = simulation.cavities().at(0);
  EXPECT_NEAR(rest.volume, hole * hole * hole, round_off<Real>(10, rest.volume));
  EXPECT_NEAR(rest.pressure, 0, round_off<Real>(100, K));
  while (simulation.time() < 0.4) advance(simulation, 1);
  const CavityState full = simulation.cavities().at(0);
  EXPECT_NEAR(full.pressure, K * (1.3 - full.volume / rest.volume), round_off<Real>(100, K));
  EXPECT_GT(full.volume, 1.1 * rest.volume);
  // the same balance as under that pressure
  p.body.loads = {{walls, FollowerPressure{full.pressure}, RampCourse{0.2}}};
  Simulation<TypeParam> given(p);
  while (given.time() < 0.4) advance(given, 1);
  const auto a = simulation.positions(), b = given.positions();
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_LE((a[i] - b[i]).norm(), 1e-4) << i;
}

// The fluid shortens the step: much stiffer than the body, it rules the step, which is sharp then
TEST(Cavity, BoundsTheStep) {
  Problem p = balloon(1.01, 100 * K);
  const double limit = Simulation<Host>(p).levels()[0].critical_step;
  p.body.loads = {{walls, FollowerPressure{1}, {}}};
  EXPECT_LT(limit, 0.5 * Simulation<Host>(p).levels()[0].critical_step);
  const auto holds = [&](double part) {
    Problem steps = balloon(1.01, 100 * K);
    steps.integration.macro_step = part * limit, steps.integration.substeps = {1};
    steps.integration.allow_unstable = true;
    Simulation<Host> simulation(steps);
    for (int n = 0; n < 2000; ++n)
      if (simulation.step_checked()) return false;
    return true;
  };
  EXPECT_TRUE(holds(0.95));
  EXPECT_FALSE(holds(1.3));
}

// The stiffness of the fluid is in the product, too
TEST(Cavity, StiffnessIsTheDerivativeOfItsForces) {
  Problem p = balloon(1.5);
  LevelProbe<Host> with(p);
  p.body.loads.clear();
  LevelProbe<Host> without(p);
  const auto u = random_field(with.vertices(), 3e-3, 7), e = random_field(with.vertices(), 1, 8);
  const auto force = [&](double ahead) {
    auto x = u;
    for (std::size_t a = 0; a < x.size(); ++a) x[a] += ahead * e[a];
    return minus(with.force(x, with.zero(), 0.1), without.force(x, with.zero(), 0.1));
  };
  constexpr double h = 1e-6;
  const auto down = force(-h), up = force(h);
  with.force(u, with.zero(), 0.1);
  const auto all = with.tangent(u, e), elastic = without.stiffness(u, e);
  double size = 0;
  for (const Point& f : minus(all, elastic)) size = std::max(size, f.norm());
  for (std::size_t a = 0; a < u.size(); ++a)
    EXPECT_LE((all[a] - elastic[a] - (down[a] - up[a]) / (2 * h)).norm(), 1e-6 * size) << a;
}

// Newton's method descends the energy of a load on a closed surface: its change is the work that
// the load's forces do, with a sign.
TEST(Cavity, EnergyChangesByTheWorkOfItsPressure) {
  Problem p = balloon(1.5);
  Problem alone = p;
  alone.body.loads.clear();
  LevelProbe<Host> without(alone);
  for (const bool fluid : {true, false}) {
    p.body.loads[0].load = EnclosedVolume{1.5, K};
    if (!fluid) p.body.loads[0].load = FollowerPressure{4e3};
    LevelProbe<Host> with(p);
    const auto u = random_field(with.vertices(), 3e-3, 7), e = random_field(with.vertices(), 1, 8);
    const auto energy = [&](double ahead) {
      for (std::size_t a = 0; a < u.size(); ++a)
        for (int k = 0; k < 3; ++k) with.at(0).state.u(a, k) = u[a][k] + ahead * e[a][k];
      return with.at(0).term_energy(0.1);
    };
    const auto f = minus(with.force(u, with.zero(), 0.1), without.force(u, without.zero(), 0.1));
    double work = 0;
    for (std::size_t a = 0; a < u.size(); ++a) work += f[a].dot(e[a]);
    EXPECT_GT(std::abs(work), 1e-2);
    constexpr double h = 1e-6;
    EXPECT_NEAR((energy(-h) - energy(h)) / (2 * h), work, 1e-5 * std::abs(work));
  }
}

// A fluid that is much stiffer than the wall, in steps far above those that are stable explicitly
TEST(Cavity, IsFilledInImplicitSteps) {
  Problem p = balloon(1.3, 1e4 * K);
  p.body.damping.mass = 100;
  EXPECT_LT(Simulation<Host>(p).levels()[0].critical_step, 0.02 / 200);
  p.integration.integrator = {"implicit_euler"}, p.integration.macro_step = 0.02;
  for (const int newton : {1, 20})
    for (const char* matrix : {"assembled", "free"}) {
      p.integration.implicit.newton_iterations = newton, p.integration.implicit.matrix = matrix;
      Simulation<Host> simulation(p);
      advance(simulation, 50);
      const CavityState full = simulation.cavities().at(0);
      EXPECT_NEAR(full.volume, 1.3 * hole * hole * hole, 1e-3 * full.volume) << matrix << newton;
      EXPECT_NEAR(full.pressure, 1e4 * K * (1.3 - full.volume / (hole * hole * hole)),
                  1e-6 * full.pressure);
      if (newton > 1) {
        EXPECT_EQ(simulation.counters().at("newton_misses"), 0);
      }
    }
}

// A fluid much stiffer than its thin wall: linearised at the start of a step, before the wall gives
// way, its pressure takes more stiffness away than the wall has. Linearly implicit steps come to
// the same rest as explicit ones
TEST(Cavity, IsFilledInLinearlyImplicitSteps) {
  Tube tube;
  tube.radius = 0.004, tube.wall = 0.001, tube.length = 0.03, tube.bend = 0;
  tube.around = 12, tube.across = 1, tube.along = 6;
  Problem p = body_of({tube_mesh(tube)}, "neo_hookean");
  p.body.fixed = {GroupSelection{"inlet"}, GroupSelection{"outlet"}};
  p.body.loads = {{GroupSelection{"lumen"}, EnclosedVolume{1.4, 300 * K}, RampCourse{0.2}}};
  p.body.damping.mass = 100;
  const auto filled = [&] {
    Simulation<Host> simulation(p);
    while (simulation.time() < 0.4 && !simulation.step_checked()) {
    }
    return simulation.cavities().at(0);
  };
  const CavityState truth = filled();
  p.integration.integrator = {"implicit_euler"}, p.integration.macro_step = 0.005;
  p.integration.implicit.newton_iterations = 1;
  const CavityState full = filled();
  EXPECT_NEAR(full.volume, truth.volume, 1e-6 * truth.volume);
  EXPECT_NEAR(full.pressure, truth.pressure, 1e-3 * truth.pressure);
  p.integration.implicit.tangent = "exact";  // there is no other to fall back on
  EXPECT_GT(std::abs(filled().pressure - truth.pressure), truth.pressure);
}

// A piece of pipe is a cavity once its ends are held, of the volume of its twelve-sided lumen
TEST(Cavity, OfAPipeHasRimsThatAreFixed) {
  Tube tube;
  tube.radius = 0.01, tube.wall = 0.004, tube.length = 0.1, tube.bend = 0;
  tube.around = 12, tube.across = 1, tube.along = 5;
  Problem p = body_of({tube_mesh(tube)}, "neo_hookean");
  p.body.loads = {{GroupSelection{"lumen"}, EnclosedVolume{1.2, K}, {}}};
  EXPECT_NE(
      refusal([&] {
        Simulation<Host>{p};
      }).find("body.loads.0.enclosed_volume: its triangles on level 0 have a rim, and vertex"),
      std::string::npos);
  p.body.fixed = {GroupSelection{"inlet"}, GroupSelection{"outlet"}};
  const double area = 6 * std::sin(std::numbers::pi / 6) * 1e-4;
  EXPECT_NEAR(Simulation<Host>(p).cavities().at(0).volume, 0.1 * area, 1e-15);
}

TEST(Cavity, IsRefusedWhereThereIsNone) {
  const auto refused = [](const auto& change) {
    Problem p = balloon(1.2);
    change(p);
    return refusal([&] { Simulation<Host>{p}; });
  };
  EXPECT_NE(refused([](Problem& p) {
              p.body.loads[0].where = Box{{-1, -1, -1}, {1, 1, 1}};
            })
                .find("body.loads.0.enclosed_volume: the volume on the outer side of its triangles "
                      "on level 0 is -0.0016"),
            std::string::npos);
  EXPECT_NE(refused([](Problem& p) { p.integration.integrator = {"v_cycle_euler"}; })
                .find("integration.integrator is v_cycle_euler, whose matrix has no room for "
                      "body.loads.0.enclosed_volume"),
            std::string::npos);
  EXPECT_NE(refused([](Problem& p) {
              p.integration.integrator = {"newmark"}, p.integration.implicit.solver = "direct";
            })
                .find("integration.implicit.solver is direct, whose matrix has no room for "
                      "body.loads.0.enclosed_volume"),
            std::string::npos);
  EXPECT_NE(
      refused([](Problem& p) { p.integration.cycle = "him"; }).find("integration.cycle is him"),
      std::string::npos);
  EXPECT_NE(refused([](Problem& p) {
              std::get<EnclosedVolume>(p.body.loads[0].load).ratio = 0;
            }).find("body.loads.0.enclosed_volume.ratio"),
            std::string::npos);
  Problem automatic = balloon(1.2);
  automatic.integration.cycle = "auto";
  EXPECT_NO_THROW(validate(automatic)) << "which chooses single";
}

}  // namespace
