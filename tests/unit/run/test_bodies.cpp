// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <plica/core/error.hpp>
#include <plica/drivers/body/masses.hpp>
#include <plica/drivers/run/join_bodies.hpp>
#include <plica/drivers/run/registry.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/generators.hpp>
#include <plica/meshes/mesh_quality.hpp>
#include <plica/meshes/signed_distance.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/refusal.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"
#include "support/watch.hpp"

// Several bodies in one simulation, and surfaces that touch each other or themselves.
namespace {

using namespace plica;
using namespace plica::test;

Body block(const Point& at, const Point& size, std::array<int, 3> cells) {
  Body body = body_of({box_mesh({at, at + size}, cells)}, "neo_hookean").body;
  body.surface = boundary_surface(body.levels[0]).surface;
  return body;
}

Body ball(const Point& centre, double radius, int cells, const Point& velocity, int levels = 1) {
  std::vector<TetMesh> meshes;
  for (int i = 0; i < levels; ++i) meshes.push_back(ball_mesh(centre, radius, cells - i));
  Body body = body_of(std::move(meshes), "neo_hookean").body;
  body.surface = boundary_surface(body.levels[0]).surface;
  body.initial.velocity = velocity;
  return body;
}

/// Two balls that fly at each other, not quite along the line between their centres.
Problem collision(int levels = 1, const std::string& cycle = "single") {
  Problem p;
  p.body = join_bodies({{"left", ball({-0.0505, 0, 0}, 0.05, 6, {0.5, 0, 0}, levels)},
                        {"right", ball({0.0505, 0.01, 0}, 0.05, 6, {-0.5, 0, 0}, levels)}});
  p.integration.cycle = cycle;
  return p;
}

struct Momenta {
  Point linear = Point::Zero(), angular = Point::Zero();
};

Momenta momenta(const Simulation<Host>& s, const std::vector<double>& mass) {
  Momenta all;
  const auto x = s.positions(), v = s.velocities();
  for (std::size_t a = 0; a < mass.size(); ++a) {
    all.linear += mass[a] * v[a];
    all.angular += mass[a] * x[a].cross(v[a]);
  }
  return all;
}

std::vector<double> masses_of(const Problem& p) {
  return lumped_masses(p.body.levels[0], region_densities(p.body, p.body.levels[0]));
}

/// How deep a point of one body is in the other, at most [m].
double deepest(const Problem& p, const Simulation<Host>& s) {
  const std::vector<Point> x = s.surface_positions();
  double depth = 0;
  std::size_t first = 0;
  for (const BodyPart& part : p.body.parts) {
    const auto points = static_cast<std::size_t>(part.points);
    TriangleSurface one;
    for (std::size_t i = 0; i < points; ++i) one.vertices.push_back(x[first + i]);
    for (const auto& t : p.body.surface->triangles)
      if (static_cast<std::size_t>(t[0]) >= first &&
          static_cast<std::size_t>(t[0]) < first + points) {
        one.triangles.push_back(t);
        for (int& v : one.triangles.back()) v -= static_cast<int>(first);
      }
    const SignedDistance distance(one);
    for (std::size_t i = 0; i < x.size(); ++i)
      if (i < first || i >= first + points) depth = std::max(depth, -distance(x[i]));
    first += points;
  }
  return depth;
}

// --- Joined ---

TEST(Bodies, SelectInThemselvesAndKeepTheirMaterials) {
  Body soft = block({0, 0, 0}, {0.1, 0.1, 0.1}, {2, 2, 2}),
       hard = block({0.2, 0, 0}, {0.1, 0.1, 0.1}, {2, 2, 2});
  // the bottom of hard, too, were it asked
  soft.fixed = {HalfSpaceSelection{{0, 0, 0}, {0, 0, 1}}};
  soft.regions["top"].where = Box{{0, 0, 0.05}, {1, 1, 1}};
  soft.regions["top"].density = 500;
  hard.material.young_modulus = 80e3, hard.damping.mass = 3;
  hard.initial.position = Point(0.35, 0.05, 0.05), hard.initial.angular_velocity = Point(0, 0, 2);
  Problem p;
  p.body = join_bodies({{"soft", soft}, {"hard", hard}});
  EXPECT_EQ(p.body.levels[0].vertices.size(), 54u);
  EXPECT_EQ(p.body.levels[0].vertex_sets.at("soft/fixed.0").size(), 9u);
  EXPECT_EQ(p.body.regions.at("hard").young_modulus, 80e3);
  EXPECT_EQ(p.body.regions.at("soft/top").density, 500);
  EXPECT_EQ(p.body.regions.at("soft/top").young_modulus, 20e3);
  const Simulation<Host> s(p);
  EXPECT_NEAR(s.levels()[0].mass, 0.75 + 1, round_off<double>(100));
  const auto v = s.velocities(), x = s.positions();
  EXPECT_EQ(largest({v.begin(), v.begin() + 27}), 0);
  for (std::size_t a = 27; a < 54; ++a)
    EXPECT_LE((v[a] - Point(0, 0, 2).cross(x[a] - Point(0.35, 0.05, 0.05))).norm(),
              round_off<double>(10));
}

// A mesh whose elements all have regions of their own, of which the body says nothing.
TEST(Bodies, KeepTheRegionsOfTheirMeshes) {
  Body body = block({0, 0, 0}, {0.1, 0.1, 0.1}, {2, 2, 2});
  body.levels[0].region_names = {"left", "right"};
  for (std::size_t e = 0; e < body.levels[0].tets.size(); ++e)
    body.levels[0].region.push_back(e % 2 == 0 ? 0 : 1);
  body.regions["right"].density = 500;
  Problem p;
  p.body = join_bodies({{"a", body}});
  EXPECT_EQ(p.body.regions.at("a/left").density, 1000);
  EXPECT_EQ(p.body.regions.at("a/right").density, 500);
  EXPECT_NEAR(Simulation<Host>(p).levels()[0].mass, 0.75, round_off<double>(100));
}

TEST(Bodies, MoveAsEachWouldAlone) {
  Body one = block({0, 0, 0}, {0.1, 0.1, 0.1}, {3, 3, 3}),
       other = block({0, 0, 0.3}, {0.1, 0.1, 0.1}, {2, 3, 3});
  one.fixed = {HalfSpaceSelection{{0, 0, 0}, {0, 0, 1}}};
  other.initial.angular_velocity = {3, 0, 5};
  Problem both, single;
  both.body = join_bodies({{"one", one}, {"other", other}});
  both.gravity = {0, 0, -9.81}, both.integration.macro_step = 5e-4;
  single = both;
  single.body = one;
  Simulation<Host> together(both), alone(single);
  advance(together, 100), advance(alone, 100);
  const std::size_t n = one.levels[0].vertices.size();
  auto x = together.positions();
  x.resize(n);
  EXPECT_LE(largest_difference(x, alone.positions()), round_off<double>(1e3, 0.1));
}

TEST(Bodies, RefuseWhatASimulationHasOnce) {
  const Body a = block({0, 0, 0}, {0.1, 0.1, 0.1}, {2, 2, 2});
  Body b = a;
  b.material.model = "corotational";
  EXPECT_NE(refusal([&] {
              join_bodies({{"a", a}, {"b", b}});
            }).find("bodies.b.material.model is corotational"),
            std::string::npos);
  EXPECT_NE(refusal([&] {
              join_bodies({{"a", a}, {"a", a}});
            }).find("two bodies"),
            std::string::npos);
  b = a, b.initial.random = 1;
  EXPECT_NE(refusal([&] {
              join_bodies({{"a", a}, {"b", b}});
            }).find("bodies.b.initial.random"),
            std::string::npos);
  b = a, b.fixed = {Box{{5, 5, 5}, {6, 6, 6}}};
  EXPECT_NE(refusal([&] {
              join_bodies({{"a", a}, {"b", b}});
            }).find("bodies.b.fixed.0"),
            std::string::npos);
}

TEST(Bodies, SayWhereTheyOverlap) {
  Problem p;
  p.body = join_bodies({{"under", block({0, 0, 0}, {0.1, 0.1, 0.1}, {2, 2, 2})},
                        {"over", block({0.02, 0.02, 0.09}, {0.05, 0.05, 0.05}, {2, 2, 2})}});
  const std::string said = refusal([&] { Simulation<Host> s(p); });
  EXPECT_NE(said.find("bodies.over overlaps bodies.under"), std::string::npos) << said;
  EXPECT_NE(said.find("0.01 m inside"), std::string::npos) << said;
  p.contact.bodies = false;
  EXPECT_EQ(refusal([&] { Simulation<Host> s(p); }), "");
  const Body one = block({0, 0, 0}, {0.1, 0.1, 0.1}, {2, 2, 2});
  p = {}, p.body = join_bodies({{"one", one}, {"same", one}});
  EXPECT_NE(refusal([&] { Simulation<Host> s(p); }).find("bodies.same overlaps bodies.one"),
            std::string::npos);
}

TEST(Bodies, RefuseWhatCannotTouch) {
  Problem p = collision();
  p.body.surface->triangles.pop_back();
  EXPECT_NE(refusal([&] { Simulation<Host> s(p); }).find("no inside"), std::string::npos);
  p = collision();
  p.contact.obstacles.push_back({PlaneOptions{{0, 0, -1}, {0, 0, 1}}, {}, {}, "left"});
  EXPECT_NE(refusal([&] { Simulation<Host> s(p); }).find("that of a body"), std::string::npos);
}

// --- Known answers ---

// Momenta to rounding whatever the integrator; no energy is gained; what flew at each other flies
// apart.
TEST(Bodies, CollideWithTheMomentaTheyHad) {
  for (const std::string integrator : {"symplectic_euler", "central_difference", "rk4"}) {
    Problem p = collision();
    p.integration.integrator = {integrator};
    Simulation<Host> s(p);
    const std::vector<double> mass = masses_of(p);
    const Momenta before = momenta(s, mass);
    const double energy = s.energies().total(), size = 0.5 * s.levels()[0].mass;
    double most = 0, depth = 0;
    while (s.time() < 0.12) {
      advance(s, 20);
      most = std::max(most, s.energies().total());
      depth = std::max(depth, deepest(p, s));
      const Momenta now = momenta(s, mass);
      EXPECT_LE((now.linear - before.linear).norm(), round_off<double>(2000, size)) << integrator;
      const double turned = (now.angular - before.angular).norm();
      EXPECT_TRUE(integrator == "rk4" || turned <= round_off<double>(2000, 0.1 * size))
          << integrator << " " << turned;
    }
    EXPECT_LE(most, 1.02 * energy) << integrator;
    EXPECT_LE(depth, 0.05 * mean_edge_length(p.body.levels[0])) << integrator;
    const auto v = s.velocities();
    Point left = Point::Zero();
    for (std::size_t a = 0; a < v.size() / 2; ++a) left += mass[a] * v[a];
    EXPECT_LE(left[0], -0.2 * size / 2) << integrator;  // it came with 0.5
  }
}

// In rest, the lower one carries the upper one's weight, and the floor both.
TEST(Bodies, StandOnEachOther) {
  Problem p;
  Body lower = block({0, 0, 0}, {0.1, 0.1, 0.05}, {5, 5, 3}),
       upper = block({0.013, 0.017, 0.05}, {0.06, 0.06, 0.06}, {4, 4, 4});
  lower.damping.mass = upper.damping.mass = 60;
  p.body = join_bodies({{"lower", lower}, {"upper", upper}});
  p.gravity = {0, 0, -9.81};
  p.contact.obstacles.push_back({PlaneOptions{}, 0.5, {}, "floor"});
  p.contact.friction = 0.5;
  Simulation<Host> s(p);
  while (s.time() < 0.5) advance(s, 20);
  const double weight = 9.81 * 1000 * 0.06 * 0.06 * 0.06,
               all = weight + 9.81 * 1000 * 0.1 * 0.1 * 0.05;
  const auto w = s.wrenches();
  ASSERT_EQ(w.size(), 3u);
  EXPECT_EQ(w[2].obstacle, "upper");
  EXPECT_NEAR(w[0].force[2], all, 0.01 * all);
  EXPECT_NEAR(w[2].force[2], weight, 0.01 * weight);
  EXPECT_LE((w[1].force + w[2].force).norm(), round_off<double>(1e3, weight));
  EXPECT_LE(deepest(p, s), 0.02 * mean_edge_length(p.body.levels[0]));
}

TEST(Bodies, TouchInEveryCycle) {
  for (const std::string& cycle : names(cycles())) {
    Problem p = collision(2, cycle);
    if (cycle == "him") p.integration.macro_step = 1e-3;
    Simulation<Host> s(p);
    const double energy = s.energies().total();
    while (s.time() < 0.06 && !testing::Test::HasFailure()) advance(s, 5);
    EXPECT_LE(s.energies().total(), 1.1 * energy) << cycle;
    EXPECT_LE(deepest(p, s), 0.2 * mean_edge_length(p.body.levels[0])) << cycle;
  }
}

// --- Folds ---

/// A strip bent to a U whose legs, 1 mm apart, stand along z.
Problem fold() {
  TetMesh mesh = box_mesh({{0, 0, 0}, {1, 1, 1}}, {24, 3, 2});
  constexpr double inner = 0.5e-3, thick = 4e-3, leg = 0.03;
  const double arc = std::numbers::pi * (inner + thick / 2), length = 2 * leg + arc;
  for (Point& x : mesh.vertices) {
    const double s = x[0] * length, r = inner + (1 - x[2]) * thick, y = 0.01 * x[1];
    if (s < leg)
      x = {-r, y, leg - s};
    else if (s > leg + arc)
      x = {r, y, s - leg - arc};
    else
      x = {-r * std::cos((s - leg) / arc * std::numbers::pi), y,
           -r * std::sin((s - leg) / arc * std::numbers::pi)};
  }
  for (auto& t : mesh.tets)
    if (tet_volume(mesh.vertices[static_cast<std::size_t>(t[0])],
                   mesh.vertices[static_cast<std::size_t>(t[1])],
                   mesh.vertices[static_cast<std::size_t>(t[2])],
                   mesh.vertices[static_cast<std::size_t>(t[3])]) < 0)
      std::swap(t[2], t[3]);
  Problem p = body_of({mesh}, "neo_hookean");
  p.body.surface = boundary_surface(p.body.levels[0]).surface;
  p.contact.self = true;
  return p;
}

TEST(SelfContact, LeavesAFoldAtRestAlone) {
  Simulation<Host> s(fold());
  advance(s, 200);
  EXPECT_LE(largest(s.velocities()), 1e-9);
}

// The legs are thrown at each other: they meet, and do not pass through each other.
TEST(SelfContact, KeepsAFoldApart) {
  for (const bool on : {true, false}) {
    Problem p = fold();
    p.contact.self = on;
    p.body.initial.parts = {{Box{{-1, -1, 0.01}, {0, 1, 1}}, {0.2, 0, 0}},
                            {Box{{0, -1, 0.01}, {1, 1, 1}}, {-0.2, 0, 0}}};
    Simulation<Host> s(p);
    double least = 1;
    const auto rest = p.body.levels[0].vertices;
    while (s.time() < 0.02) {
      advance(s, 5);
      const auto x = s.positions();
      double left = -1, right = 1;  // of the legs' inner faces, near their ends
      for (std::size_t a = 0; a < x.size(); ++a) {
        if (rest[a][2] < 0.02 || std::abs(std::abs(rest[a][0]) - 0.5e-3) > 1e-6) continue;
        if (rest[a][0] < 0) left = std::max(left, x[a][0]);
        if (rest[a][0] > 0) right = std::min(right, x[a][0]);
      }
      least = std::min(least, right - left);
    }
    if (on)
      EXPECT_GE(least, -0.1 * mean_edge_length(p.body.levels[0]));
    else
      EXPECT_LE(least, -0.5 * mean_edge_length(p.body.levels[0]));  // or this shows nothing
  }
}

// --- How it is computed ---

#if defined(KOKKOS_ENABLE_OPENMP)
TEST(Bodies, GiveTheSameBitsForOneThreadAndTwo) {
  if (Kokkos::OpenMP().concurrency() < 2) GTEST_SKIP() << "one thread";
  for (const std::string cycle : {"single", "rsv", "him"}) {
    Problem p = collision(2, cycle);
    if (cycle == "him") p.integration.macro_step = 1e-3;
    p.contact.friction = 0.3, p.contact.self = true;
    const auto result = [&](int threads) {
      Simulation<Backend<double, Kokkos::OpenMP>> s(p, Kokkos::OpenMP(threads));
      bool touched = false;
      for (int n = 0; n < 60; ++n) {
        advance(s, 1);
        touched = touched || s.wrenches()[0].force.norm() > 0;
      }
      EXPECT_TRUE(touched) << cycle;
      return s.positions();
    };
    EXPECT_TRUE(same_bits(result(1), result(2))) << cycle;
  }
}
#endif

TEST(SelfContact, IsLeftOutWhereNothingAsksForIt) {
  Problem p = fold();
  p.contact.self = false;
  const Watch watch;
  Simulation<Host> s(p);
  advance(s, 2);
  EXPECT_EQ(watch.about({"pairs", "contact"}), std::vector<std::string>{});
}

}  // namespace
