// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <numbers>
#include <plica/core/error.hpp>
#include <plica/drivers/solver/load_factor.hpp>
#include <plica/drivers/study/level_probe.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/generators.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// Dead loads: what they sum to, on every level, over time, under every integrator.
namespace {

using namespace plica;
using namespace plica::test;

const Selection right_face = Box{{0.1, -1, -1}, {0.1, 1, 1}};

Point sum(const std::vector<Point>& field) {
  Point total = Point::Zero();
  for (const Point& x : field) total += x;
  return total;
}

template <class B>
class Loads : public testing::Test {};
TYPED_TEST_SUITE(Loads, EachBackend);

TYPED_TEST(Loads, TractionTimesAreaAndTotalForceOnEveryLevel) {
  using Real = typename TypeParam::Real;
  Problem p = cube_levels(3, 4, "rs");
  p.body.loads = {{right_face, Traction{{10, -20, 5}}, {}},
                  {Box{{0, 0, 0}, {0.05, 1, 1}}, TotalForce{{0, 0, 0.7}}, {}},
                  {NearestSelection{{0, 0, 0}}, TotalForce{{0, 0.2, 0}}, {}}};
  LevelProbe<TypeParam> probe(p);
  for (int i = 0; i < 3; ++i) {
    const auto z = probe.zero(i);
    const auto f = probe.force(z, z, 0, i);
    EXPECT_LE((sum(f) - Point(0.1, -0.2 + 0.2, 0.05 + 0.7)).norm(), round_off<Real>(200)) << i;
    const TetMesh& mesh = p.body.levels[static_cast<std::size_t>(i)];
    for (std::size_t a = 0; a < f.size(); ++a)
      if (mesh.vertices[a][0] > 0.06 && mesh.vertices[a][0] < 0.099) {
        EXPECT_LE(f[a].norm(), round_off<Real>(10)) << i;
      }
  }
}

// Round meshes of different fineness have different areas; the load is level 0's.
TEST(Loads, OfCoarseLevelsAreScaledToTheFinest) {
  Problem p = body_of({ball_mesh({0, 0, 0}, 0.1, 10), ball_mesh({0, 0, 0}, 0.1, 4)});
  p.integration.cycle = "rs";
  p.body.loads = {{HalfSpaceSelection{{0, 0, 0}, {0, 0, -1}}, Traction{{0, 0, -100}}, {}}};
  LevelProbe<Host> probe(p);
  const auto z0 = probe.zero(0), z1 = probe.zero(1);
  const Point fine = sum(probe.force(z0, z0, 0, 0)), coarse = sum(probe.force(z1, z1, 0, 1));
  EXPECT_NEAR(fine[2], -100 * 2 * std::numbers::pi * 0.01, 0.1);
  EXPECT_LE((coarse - fine).norm(), 1e-12);
}

TYPED_TEST(Loads, AFreeBodyIsAcceleratedByForceOverMass) {
  for (const char* integrator : {"symplectic_euler", "euler", "rk4", "implicit_euler"}) {
    SCOPED_TRACE(integrator);
    Problem p = small_cube("corotational");
    p.body.loads = {{Box{{0, 0, 0}, {0.1, 0.1, 0.1}}, TotalForce{{2, 0, -1}}, {}}};
    p.integration.integrator = {integrator};
    p.integration.macro_step = 1e-3, p.integration.allow_unstable = true;
    Simulation<TypeParam> simulation(p);
    for (int n = 0; n < 100; ++n) simulation.step();
    const Point want = 0.1 * Point(2, 0, -1) / simulation.levels()[0].mass;  // 1 kg
    const bool implicit = std::string(integrator) == "implicit_euler";       // to the residual of its solves
    // by its masses: all vertices alike, so that the body does not even deform
    for (const Point& v : simulation.velocities())
      EXPECT_LE((v - want).norm(), implicit ? 1e-6 : round_off<typename TypeParam::Real>(3000)) << v.transpose();
    EXPECT_FALSE(simulation.check());
  }
}

TYPED_TEST(Loads, GiveTheirImpulseWhereverTheyAct) {
  for (const char* integrator : {"symplectic_euler", "rk4", "implicit_euler"}) {
    SCOPED_TRACE(integrator);
    Problem p = small_cube();
    p.body.loads = {{right_face, Traction{{0, 20, 0}}, RampCourse{0.02}}};
    p.integration.integrator = {integrator};
    p.integration.macro_step = 5e-4;
    p.integration.implicit.relative_residual = 1e-9;
    Simulation<TypeParam> simulation(p);
    advance(simulation, 80);
    LevelProbe<TypeParam> probe(p);
    const auto mass = probe.mass();
    const auto v = simulation.velocities();
    double momentum = 0;
    for (std::size_t a = 0; a < v.size(); ++a) momentum += mass[a] * v[a][1];
    EXPECT_NEAR(momentum, 0.2 * (0.01 + 0.02), 0.2 * 5e-4);  // half the ramp, then all of it; to the step's order
  }
}

TEST(Loads, FollowTheirCourse) {
  EXPECT_EQ(load_factor(ConstantCourse{}, 3), 1);
  EXPECT_EQ(load_factor(RampCourse{2}, 0), 0);
  EXPECT_NEAR(load_factor(RampCourse{2}, 1), 0.5, 1e-15);
  EXPECT_EQ(load_factor(RampCourse{2}, 2), 1);
  EXPECT_EQ(load_factor(RampCourse{2}, 5), 1);
  const PolygonCourse course{{{1, 2}, {2, -2}, {4, 0}}};
  EXPECT_EQ(load_factor(course, 0), 2);
  EXPECT_EQ(load_factor(course, 1.25), 1);
  EXPECT_EQ(load_factor(course, 2), -2);
  EXPECT_EQ(load_factor(course, 3), -1);
  EXPECT_EQ(load_factor(course, 9), 0);
  EXPECT_NEAR(load_factor(SineCourse{2, 0}, 0.125), 1, 1e-15);
  EXPECT_NEAR(load_factor(SineCourse{2, std::numbers::pi / 2}, 0.25), -1, 1e-15);
  Problem p = small_cube();
  p.body.loads = {{right_face, TotalForce{{3, 0, 0}}, course}};
  LevelProbe<Host> probe(p);
  const auto z = probe.zero();
  EXPECT_NEAR(sum(probe.force(z, z, 3))[0], -3, 1e-12);
}

template <class Change>
std::string refusal(const Change& change) {
  Problem p = small_cube();
  change(p.body);
  try {
    Simulation<Host> simulation(p);
  } catch (const InputError& e) {
    return e.what();
  }
  return "accepted";
}

TEST(Loads, WithoutEffectAreRefused) {
  const std::string held = refusal([](Body& b) {
    b.fixed = {right_face};
    b.loads = {{right_face, Traction{{1, 0, 0}}, {}}};
  });
  EXPECT_NE(held.find("body.loads.0: all 16 vertices it acts on, on level 0, are fixed or prescribed"),
            std::string::npos)
      << held;
  const std::string point = refusal([](Body& b) { b.loads = {{NearestSelection{}, Traction{{1, 0, 0}}, {}}}; });
  EXPECT_NE(point.find("no boundary triangle"), std::string::npos) << point;
}

}  // namespace
