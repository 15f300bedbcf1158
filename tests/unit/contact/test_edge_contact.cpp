// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <plica/drivers/body/masses.hpp>
#include <plica/drivers/run/join_bodies.hpp>
#include <plica/kernels/contact/gap_of_edges.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/generators.hpp>
#include <plica/meshes/mesh_quality.hpp>
#include <random>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// Edges that cross edges, where no point of one body is near the other's surface.
namespace {

using namespace plica;
using namespace plica::test;

// --- Geometry of two edges ---

using Tet = std::array<Point, 4>;
constexpr std::array<std::array<int, 4>, 6> edges_of_tet{
    {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {1, 2, 0, 3}, {1, 3, 2, 0}, {2, 3, 0, 1}}};

Tet random_tet(std::mt19937& random, const Point& centre) {
  std::uniform_real_distribution<double> any(-1, 1);
  Tet t;
  do {
    for (Point& x : t) x = centre + Point(any(random), any(random), any(random));
  } while (std::abs(tet_volume(t[0], t[1], t[2], t[3])) < 0.05);
  return t;
}

SurfaceEdge<double> edge_of(const Tet& t, std::size_t i) {
  const auto x = [&](std::size_t k) {
    return vec3<double>(t[static_cast<std::size_t>(edges_of_tet[i][k])]);
  };
  return {x(0), x(1), x(2), x(3)};
}

/// How far the first reaches into the second along an axis out of the second.
double overlap(const Tet& first, const Tet& second, const Point& axis) {
  double low = 1e9, high = -1e9;
  for (const Point& x : first) low = std::min(low, axis.dot(x));
  for (const Point& x : second) high = std::max(high, axis.dot(x));
  return high - low;
}

// What two edges of tetrahedra have as their depth is how far these overlap along the normal. And
// where the way by which they are separated soonest is across two edges, these meet, with that
// depth: then it is the tetrahedra's own.
TEST(EdgeContact, DepthIsTheOverlapAlongTheNormal) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> away(-1.2, 1.2);
  int meetings = 0, by_edges = 0;
  for (int n = 0; n < 20000; ++n) {
    const Tet a = random_tet(random, {0, 0, 0}),
              b = random_tet(random, {away(random), away(random), away(random)});
    double least = 1e9, of_edges = 1e9, found = 1e9, sharpest = 0, steepest = 0;
    const auto ask = [&](Point axis, bool edges) {
      const double sine = axis.norm();
      if (sine < 1e-9) return;
      axis /= sine;
      for (const Point& way : {axis, Point(-axis)}) {
        const double depth = overlap(a, b, way);
        least = std::min(least, depth);
        if (edges && depth < of_edges) of_edges = depth, sharpest = sine;
      }
    };
    for (const Tet* t : {&a, &b})
      for (std::size_t i = 0; i < 4; ++i)
        ask(((*t)[(i + 1) % 4] - (*t)[i]).cross((*t)[(i + 2) % 4] - (*t)[i]), false);
    for (std::size_t i = 0; i < 6; ++i)
      for (std::size_t j = 0; j < 6; ++j) {
        const auto e = edge_of(a, i), f = edge_of(b, j);
        const auto point = [](const Vec3<double>& x) { return Point(x[0], x[1], x[2]); };
        const double before = of_edges;
        ask(point(e.end - e.begin).normalized().cross(point(f.end - f.begin).normalized()), true);
        const Vec3<double> axis = cross(e.end - e.begin, f.end - f.begin);
        const Vec3<double> up =
            (dot(axis, f.left - f.begin) < 0 ? 1 : -1) / std::sqrt(dot(axis, axis)) * axis;
        if (of_edges < before) steepest = std::min(steepness(f, up), steepness(e, -1.0 * up));
        const EdgeGap<double> gap = gap_of_edges(e, f, {});
        if (!gap.meet) continue;
        ++meetings;
        const Point normal = point(gap.normal);
        EXPECT_NEAR(normal.norm(), 1, 1e-12);
        EXPECT_NEAR(gap.depth, overlap(a, b, normal), 1e-9);
        const Point own = point(e.begin) + gap.own * point(e.end - e.begin),
                    other = point(f.begin) + gap.other * point(f.end - f.begin);
        EXPECT_LE((other - own - gap.depth * normal).norm(), 1e-9);
        found = std::min(found, gap.depth);
      }
    if (of_edges < least + 1e-12 && of_edges > 0 && sharpest > 0.1 && steepest > 0.1) {
      ++by_edges;
      EXPECT_NEAR(found, of_edges, 1e-9) << n;
    }
  }
  EXPECT_GE(meetings, 10000);
  EXPECT_GE(by_edges, 200);
}

TEST(EdgeContact, MeetWhereTheyComeThroughEachOther) {
  const SurfaceEdge<double> f{{-1, 0, 0}, {1, 0, 0}, {0, 1, -1}, {0, -1, -1}};
  const auto e = [](double x, double z) {
    return SurfaceEdge<double>{{x, -1, z}, {x, 1, z}, {x + 1, 0, z + 1}, {x - 1, 0, z + 1}};
  };
  EXPECT_TRUE(gap_of_edges(e(0.5, 0.1), f, {}).meet);
  EXPECT_FALSE(gap_of_edges(e(1.5, 3), f, {}).meet);
  // above x = 0.5 as it comes down to f
  const EdgeGap<double> gap = gap_of_edges(e(1.5, 3), f, {-2, 0, -6});
  ASSERT_TRUE(gap.meet);
  EXPECT_NEAR(gap.depth, -3, 1e-12);
  EXPECT_NEAR(gap.other, 0.75, 1e-12);
  EXPECT_FALSE(gap_of_edges(e(1.5, 3), f, {-2, 0, -2}).meet);
}

TEST(EdgeContact, DistanceOfSegmentsIsTheLeastOfManyPlaces) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int n = 0; n < 300; ++n) {
    std::array<Vec3<double>, 4> x;
    for (auto& p : x) p = {any(random), any(random), any(random)};
    if (n % 3 == 0) x[3] = x[2] + x[1] - x[0];  // parallel
    double least = 1e9;
    for (int i = 0; i <= 200; ++i) {
      const Vec3<double> p = x[0] + i / 200.0 * (x[1] - x[0]), along = x[3] - x[2];
      const double t = std::clamp(dot(p - x[2], along) / dot(along, along), 0.0, 1.0);
      const Vec3<double> d = p - x[2] - t * along;
      least = std::min(least, dot(d, d));
    }
    const double found = squared_distance_of_segments(x[0], x[1], x[2], x[3]);
    EXPECT_LE(found, least + 1e-12);
    EXPECT_GE(std::sqrt(found), std::sqrt(least) - 0.01);
  }
}

// --- Bodies ---

constexpr double ridge = 0.02 / std::numbers::sqrt2;  // of a bar: half its diagonal

/// A bar of 6 cm along x or y that stands on an edge, in three cells: the middle of its ridge is
/// the middle of an edge.
Body bar(std::size_t along, double height, double speed, double young_modulus = 20e3) {
  TetMesh mesh = box_mesh({{-0.03, -0.01, -0.01}, {0.03, 0.01, 0.01}}, {3, 1, 1});
  for (Point& x : mesh.vertices) {
    const double across = (x[1] - x[2]) / std::numbers::sqrt2,
                 up = (x[1] + x[2]) / std::numbers::sqrt2 + height;
    x = along == 0 ? Point(x[0], across, up) : Point(-across, x[0], up);
  }
  Body body = body_of({std::move(mesh)}, "corotational").body;
  body.surface = boundary_surface(body.levels[0]).surface;
  body.initial.velocity = {0, 0, speed};
  body.material.young_modulus = young_modulus;
  return body;
}

/// Two bars across each other, the upper one comes down.
Problem crossing(double speed, const std::string& integrator = "symplectic_euler") {
  Problem p;
  p.body = join_bodies(
      {{"under", bar(0, -ridge - 5e-4, speed / 2)}, {"over", bar(1, ridge + 5e-4, -speed / 2)}});
  p.integration.integrator = {integrator};
  return p;
}

/// How far the lower edge of the upper bar is below the upper edge of the lower one, in the middle.
double depth_in_the_middle(const Problem& p, const Simulation<Host>& s) {
  const auto x = s.positions();
  double lower = 0, upper = 0;
  for (std::size_t a = 0; a < x.size(); ++a) {
    const Point& rest = p.body.levels[0].vertices[a];
    const bool over = a >= x.size() / 2;
    if (std::abs(rest[over ? 1 : 0]) < 0.011 && std::abs(rest[2]) < 1e-3)
      (over ? upper : lower) += x[a][2] / 2;
  }
  return lower - upper;
}

struct Momenta {
  Point linear = Point::Zero(), angular = Point::Zero();
};

Momenta momenta_of(const Problem& p, const Simulation<Host>& s) {
  const std::vector<double> mass =
      lumped_masses(p.body.levels[0], region_densities(p.body, p.body.levels[0]));
  Momenta sum;
  const auto x = s.positions(), v = s.velocities();
  for (std::size_t a = 0; a < mass.size(); ++a)
    sum.linear += mass[a] * v[a], sum.angular += mass[a] * x[a].cross(v[a]);
  return sum;
}

// They meet where no point is, and fly apart; the ridges are nowhere deep in each other.
TEST(EdgeContact, TurnsCrossingBarsBack) {
  for (const std::string integrator : {"symplectic_euler", "rk4", "implicit_euler", "him"}) {
    Problem p = crossing(1, integrator == "him" ? "symplectic_euler" : integrator);
    if (integrator == "him") p.integration.cycle = "him", p.integration.macro_step = 2e-4;
    if (integrator == "implicit_euler") p.integration.macro_step = 5e-4;
    Simulation<Host> s(p);
    const Momenta before = momenta_of(p, s);
    const double energy = s.energies().total(), size = 0.25 * s.levels()[0].mass;
    double deepest = -1;
    while (s.time() < 0.04) {
      advance(s, 1);
      deepest = std::max(deepest, depth_in_the_middle(p, s));
    }
    EXPECT_LE(deepest, 0.1 * 0.02) << integrator;
    EXPECT_GE(deepest, 0) << integrator;
    EXPECT_LE(depth_in_the_middle(p, s), -1e-3) << integrator;
    EXPECT_LE(s.energies().total(), 1.005 * energy) << integrator;
    const Momenta after = momenta_of(p, s);
    // as far as its systems are solved
    const double kept = integrator == "implicit_euler" ? 1e-3 : 1e-12;
    EXPECT_LE((after.linear - before.linear).norm(), kept * size) << integrator;
  }
}

// A step that would take one bar through the other ends before that.
TEST(EdgeContact, HoldsWhatMovesThroughInOneStep) {
  for (const double sideways : {0.0, 3.0}) {
    Body over = bar(1, ridge + 0.01, -40);
    over.initial.velocity = {sideways, 0, -40};
    Problem p;
    p.body = join_bodies({{"under", bar(0, -ridge - 0.01, 0)}, {"over", over}});
    Simulation<Host> s(p);
    ASSERT_GE(40 * s.macro_step(), 0.03) << sideways;
    s.step();
    EXPECT_LE(depth_in_the_middle(p, s), 0.3 * 0.02) << sideways;
    EXPECT_GE(depth_in_the_middle(p, s), -0.015) << sideways;
  }
}

// Bars that lie on each other by faces and points have no more force for their edges.
TEST(EdgeContact, AddsNothingWhereFacesLieOnEachOther) {
  Problem p;
  const auto block = [](const Point& at, std::array<int, 3> cells) {
    Body body = body_of({box_mesh({at, at + Point(0.04, 0.04, 0.02)}, cells)}, "corotational").body;
    body.surface = boundary_surface(body.levels[0]).surface;
    body.damping.mass = 60;
    return body;
  };
  p.body = join_bodies(
      {{"lower", block({0, 0, 0}, {4, 4, 2})}, {"upper", block({0.003, 0.005, 0.02}, {3, 3, 2})}});
  p.gravity = {0, 0, -9.81};
  p.contact.obstacles.push_back({PlaneOptions{}, 0.5, {}, "floor"});
  Simulation<Host> s(p);
  while (s.time() < 0.3) advance(s, 20);
  EXPECT_NEAR(s.wrenches()[2].force[2], 9.81 * 1000 * 0.04 * 0.04 * 0.02,
              1e-2 * 9.81 * 1000 * 0.04 * 0.04 * 0.02);
  EXPECT_LE(s.energies().kinetic, 1e-7);  // without friction it slides slowly
}

#if defined(KOKKOS_ENABLE_OPENMP)
TEST(EdgeContact, GivesTheSameBitsForOneThreadAndTwo) {
  if (Kokkos::OpenMP().concurrency() < 2) GTEST_SKIP() << "one thread";
  Problem p = crossing(1);
  p.contact.friction = 0.3, p.contact.self = true;
  const auto result = [&](int threads) {
    Simulation<Backend<double, Kokkos::OpenMP>> s(p, Kokkos::OpenMP(threads));
    while (s.time() < 0.03) advance(s, 1);
    return s.positions();
  };
  EXPECT_TRUE(same_bits(result(1), result(2)));
}
#endif

}  // namespace
