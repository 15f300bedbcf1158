// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <plica/core/error.hpp>
#include <plica/core/time_functions.hpp>
#include <plica/drivers/body/selection.hpp>
#include <plica/drivers/run/join_bodies.hpp>
#include <plica/drivers/study/level_probe.hpp>
#include <plica/kernels/contact/contact_law.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/generators.hpp>
#include <set>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/refusal.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// Loads: what they sum to, on every level, over time, under every integrator.
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
    // to the residual of its solves
    const bool implicit = std::string(integrator) == "implicit_euler";
    // by its masses: all vertices alike, so that the body does not even deform
    for (const Point& v : simulation.velocities())
      EXPECT_LE((v - want).norm(), implicit ? 1e-6 : round_off<typename TypeParam::Real>(3000))
          << v.transpose();
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
    // half the ramp, then all of it; to the step's order
    EXPECT_NEAR(momentum, 0.2 * (0.01 + 0.02), 0.2 * 5e-4);
  }
}

// Twenty triangles of the right face around one that is none of them, and that has all of its
// vertices in common with them
std::vector<std::array<int, 3>> ring_of_triangles(const TetMesh& mesh) {
  std::vector<std::pair<double, std::array<int, 3>>> face;
  const auto at = [&](int v) { return mesh.vertices[static_cast<std::size_t>(v)]; };
  for (const auto& t : boundary_triangles(mesh)) {
    const Point middle = (at(t[0]) + at(t[1]) + at(t[2])) / 3;
    if (middle[0] > 0.0999)
      face.emplace_back((middle - Point(0.1, 0.051, 0.058)).norm(), std::array{t[2], t[1], t[0]});
  }
  std::ranges::sort(face);
  std::vector<std::array<int, 3>> ring;
  for (std::size_t i = 1; i <= 20; ++i) ring.push_back(face[i].second);
  return ring;
}

// 20 triangles of 1 / 32 of the face each; by their vertices more would be loaded
TEST(Loads, ActOnTheTrianglesOfAGroupAlone) {
  TetMesh mesh = box_mesh({{0, 0, 0}, {0.1, 0.1, 0.1}}, {4, 4, 4});
  mesh.triangle_sets["patch"] = ring_of_triangles(mesh);
  std::set<int> vertices;
  for (const auto& t : mesh.triangle_sets["patch"]) vertices.insert(t.begin(), t.end());
  for (const char* name : {"patch", "points"})
    mesh.vertex_sets[name] = {vertices.begin(), vertices.end()};
  EXPECT_GT(select_triangles(mesh, GroupSelection{"points"}, {"where", 0}).size(), 20u);
  Problem p = body_of({mesh});
  p.body.loads = {{GroupSelection{"patch"}, Traction{{10, -20, 5}}, {}}};
  const double area = 20 * 0.01 / 32;
  const auto resultant = [&] {
    LevelProbe<Host> probe(p);
    const auto z = probe.zero(0);
    return sum(probe.force(z, z, 0, 0));
  };
  EXPECT_LE((resultant() - area * Point(10, -20, 5)).norm(), 1e-14);
  p.body.loads = {{GroupSelection{"patch"}, FollowerPressure{40}, {}}};
  EXPECT_LE((resultant() - area * Point(-40, 0, 0)).norm(), 1e-14) << "into the body";

  // of two bodies in one
  const Body both = join_bodies({{"one", p.body}, {"two", p.body}});
  for (const auto& load : both.loads)
    EXPECT_EQ(select_triangles(both.levels[0], load.where, {"where", 0}).size(), 20u);
  // triangles inside the body are no boundary
  p.body.levels[0].triangle_sets["patch"] = {{0, 1, 31}};
  EXPECT_NE(
      refusal([&] { resultant(); }).find("body.loads.0: the group has 1 triangles on level 0"),
      std::string::npos);
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
std::string refusal_after(const Change& change) {
  Problem p = small_cube();
  change(p.body);
  return refusal([&] { Simulation<Host>{p}; });
}

TEST(Loads, WithoutEffectAreRefused) {
  const std::string held = refusal_after([](Body& b) {
    b.fixed = {right_face};
    b.loads = {{right_face, Traction{{1, 0, 0}}, {}}};
  });
  EXPECT_NE(
      held.find("body.loads.0: all 16 vertices it acts on, on level 0, are fixed or prescribed"),
      std::string::npos)
      << held;
  const std::string point = refusal_after([](Body& b) {
    b.loads = {{NearestSelection{}, Traction{{1, 0, 0}}, {}}};
  });
  EXPECT_NE(point.find("no boundary triangle"), std::string::npos) << point;
}

// A caller's forces, on every level at the state about to be integrated.

template <class B>
class CallersForces : public testing::Test {};
TYPED_TEST_SUITE(CallersForces, EachBackend);

template <class B>
struct Weight {
  Vectors<B> force;
  Scalars<B> mass;
  Vec3<typename B::Real> acceleration;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    for (int k = 0; k < 3; ++k) force(a, k) += mass(a) * acceleration[k];
  }
};

template <class B, class Kernel>
void enqueue(const typename B::Exec& exec, std::size_t n, const Kernel& kernel) {
  Kokkos::parallel_for("test::forces", Kokkos::RangePolicy<typename B::Exec>(exec, 0, n), kernel);
}

template <class B>
Scalars<B> masses(const Problem& p, int level) {
  const TetMesh& mesh = p.body.levels[static_cast<std::size_t>(level)];
  const Scalars<B> mass("mass", mesh.vertices.size());
  const auto host = Kokkos::create_mirror_view(mass);
  for (const auto& t : mesh.tets) {
    const auto x = [&](std::size_t k) { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
    for (int v : t)
      host(v) += static_cast<typename B::Real>(p.body.material.density *
                                               tet_volume(x(0), x(1), x(2), x(3)) / 4);
  }
  Kokkos::deep_copy(mass, host);
  return mass;
}

Problem hanging(const std::string& cycle, const std::string& integrator) {
  Problem p = cube_levels(3, 5, cycle);
  p.body.fixed = {left_face()};
  p.integration.integrator = {integrator};
  p.integration.distribution = "equal";
  p.integration.macro_step = 2e-3, p.integration.implicit.newton_tolerance = 1e-7;
  return p;
}

TYPED_TEST(CallersForces, LikeGravityDoAsGravityDoes) {
  for (const char* cycle : {"single", "rs", "rsv"})
    for (const char* integrator : {"symplectic_euler", "rk4", "implicit_euler"}) {
      Problem p = hanging(cycle, integrator);
      Simulation<TypeParam> alone(p);
      std::vector<Scalars<TypeParam>> mass;
      for (int level : {0, 1, 2}) mass.push_back(masses<TypeParam>(p, level));
      alone.set_external_forces([&](const ForceRequest<TypeParam>& r) {
        enqueue<TypeParam>(
            r.exec, r.force.extent(0),
            Weight<TypeParam>{r.force, mass[static_cast<std::size_t>(r.level)], {0, 0, -10}});
      });
      p.gravity = {0, 0, -10};
      Simulation<TypeParam> heavy(p);
      advance(alone, 10);
      advance(heavy, 10);
      const double sag = largest(displacements(heavy, p.body.levels[0]));
      EXPECT_GT(sag, 1e-4);
      // a conjugate-gradient solve ends at its tolerance, on whichever side of it
      EXPECT_LE(largest_difference(alone.positions(), heavy.positions()),
                round_off<typename TypeParam::Real>(400, 0.1) + 1e-5 * sag)
          << cycle << " " << integrator;
    }
}

TYPED_TEST(CallersForces, AreAskedForAtTheTimesThatLevelsGoThrough) {
  Problem p = hanging("rs", "symplectic_euler");
  p.integration.substeps = {2, 1, 3};
  p.integration.allow_unstable = true;
  Simulation<TypeParam> simulation(p);
  std::vector<std::pair<int, double>> asked;
  simulation.set_external_forces([&](const ForceRequest<TypeParam>& r) {
    asked.emplace_back(r.level, r.time);
    EXPECT_EQ(r.displacement.data(), simulation.displacement(r.level).data());
    EXPECT_EQ(r.rest.extent(0), p.body.levels[static_cast<std::size_t>(r.level)].vertices.size());
    EXPECT_EQ(r.stiffness.extent(0), 0);
  });
  simulation.step();
  const double t = 2e-3 / 3;
  const std::vector<std::pair<int, double>> expected = {{2, 0}, {2, t / 3}, {2, 2 * t / 3},
                                                        {1, t}, {0, 2 * t}, {0, 2 * t + t / 2}};
  ASSERT_EQ(asked.size(), expected.size());
  for (std::size_t i = 0; i < asked.size(); ++i) {
    EXPECT_EQ(asked[i].first, expected[i].first);
    EXPECT_NEAR(asked[i].second, expected[i].second, 1e-15);
  }
  simulation.set_external_forces({});
  simulation.step();
  EXPECT_EQ(asked.size(), expected.size());
}

/// The contact of an obstacle, made anew by a caller on the surface's points.
template <class B>
struct Floor {
  Vectors<B> x, v, force;
  typename B::Real stiffness, damping, height;
  KOKKOS_INLINE_FUNCTION void operator()(int p) const {
    using Real = typename B::Real;
    const Real depth = height - x(p, 2);
    force(p, 0) = force(p, 1) = 0;
    force(p, 2) = depth > 0 ? Kokkos::max(Real(0), stiffness * depth - damping * v(p, 2)) : Real(0);
  }
};

TYPED_TEST(CallersForces, OnTheSurfaceDoAsAnObstacleDoes) {
  using Real = typename TypeParam::Real;
  Problem p = cube_levels(2, 4, "rsv");
  p.gravity = {0, 0, -10};
  p.body.initial.velocity = {0, 0, -0.5};
  p.body.surface = boundary_surface(p.body.levels[0]).surface;
  p.integration.distribution = "equal";
  // so short that it does not matter whether contact is implicit in it
  p.integration.macro_step = 1e-4;
  p.contact.stiffness_scale = 1.0 / 64;
  const double height = -1e-3;
  Problem with_plane = p;
  with_plane.contact.obstacles = {{PlaneOptions{{0, 0, height}, {0, 0, 1}}, std::nullopt, {}}};
  Simulation<TypeParam> obstacle(with_plane);
  p.surface_forces = true;
  Simulation<TypeParam> own(p);
  const auto points = p.body.surface->vertices.size();
  const double area = surface_area(*p.body.surface) / static_cast<double>(points);
  const double edge = obstacle.levels()[0].mean_edge, k = 20e3 * area / edge;
  const double c = std::sqrt(k * 1000 * area * edge);
  const Vectors<TypeParam> x("x", points), v("v", points), f("f", points);
  std::set<int> levels;
  own.set_external_forces([&](const ForceRequest<TypeParam>& r) {
    r.read_surface_positions(x);
    r.read_surface_velocities(v);
    enqueue<TypeParam>(r.exec, points, Floor<TypeParam>{x, v, f, Real(k), Real(c), Real(height)});
    r.add_surface_forces(f);
    levels.insert(r.level);
  });
  advance(obstacle, 600);
  advance(own, 600);
  EXPECT_EQ(levels, (std::set<int>{0, 1}));
  EXPECT_GT(obstacle.energies().contact, 1e-2);
  // an obstacle is solved implicitly, the caller's own law is taken where the step starts: they
  // differ by its share of a step
  EXPECT_LE(largest_difference(own.positions(), obstacle.positions()),
            5e-5 + round_off<Real>(4000, 0.1));
}

/// Every vertex is tied to where it was at rest.
template <class B>
struct Tie {
  ForceRequest<B> r;
  typename B::Real k;
  bool into_the_solve;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    for (int i = 0; i < 3; ++i) {
      r.force(a, i) -=
          k * (r.displacement(a, i) + static_cast<typename B::Real>(r.ahead) * r.velocity(a, i));
      if (into_the_solve) r.stiffness(a, i) += k;
    }
  }
};

// a spring far stiffer than the step can follow: linearly implicit Euler damps it only if it knows
// it
TYPED_TEST(CallersForces, ThatAreStiffEnterTheImplicitSolve) {
  for (const bool into_the_solve : {true, false}) {
    Problem p = small_cube();
    p.integration.integrator = {"implicit_euler"};
    p.integration.macro_step = 10e-3, p.integration.implicit.newton_iterations = 1;
    p.body.initial.velocity = {0.01, 0, 0};
    Simulation<TypeParam> simulation(p);
    simulation.set_external_forces([&](const ForceRequest<TypeParam>& r) {
      enqueue<TypeParam>(r.exec, r.force.extent(0), Tie<TypeParam>{r, 1e4, into_the_solve});
    });
    for (int n = 0; n < 20; ++n) simulation.step();
    const double moved = largest(displacements(simulation, p.body.levels[0]));
    if (into_the_solve)
      EXPECT_LT(moved, 1e-12);
    else
      EXPECT_FALSE(moved <= 1);  // or it is not a number any more
  }
}

TYPED_TEST(CallersForces, OnASurfaceThatIsNotThereAreRefused) {
  Simulation<TypeParam> simulation(small_cube());
  const Vectors<TypeParam> f("f", 12);
  simulation.set_external_forces(
      [&](const ForceRequest<TypeParam>& r) { r.add_surface_forces(f); });
  EXPECT_THROW(simulation.step(), InputError);
}

}  // namespace
