// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <plica/drivers/body/masses.hpp>
#include <plica/drivers/run/join_bodies.hpp>
#include <plica/kernels/contact/gap.hpp>
#include <plica/kernels/contact/on_triangle.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/generators.hpp>
#include <plica/meshes/mesh_quality.hpp>
#include <random>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// Nothing passes through anything because it is fast, however far it moves in a step.
namespace {

using namespace plica;
using namespace plica::test;

Body thrown(TetMesh mesh, const Point& velocity, double young_modulus = 20e3) {
  Body body = body_of({std::move(mesh)}, "corotational").body;
  body.surface = boundary_surface(body.levels[0]).surface;
  body.initial.velocity = velocity;
  body.material.young_modulus = young_modulus;
  return body;
}

TetMesh box_at(const Point& at, const Point& size, std::array<int, 3> cells) {
  return box_mesh({at, at + size}, cells);
}

Problem meeting(const Body& first, const Body& second) {
  Problem p;
  p.body = join_bodies({{"first", first}, {"second", second}});
  p.integration.integrator = {"symplectic_euler"};
  return p;
}

/// Momentum, and angular momentum about the origin.
std::pair<Point, Point> momenta_of(const Problem& p, const Simulation<Host>& s) {
  const std::vector<double> mass =
      lumped_masses(p.body.levels[0], region_densities(p.body, p.body.levels[0]));
  std::pair<Point, Point> sum{Point::Zero(), Point::Zero()};
  const auto x = s.positions(), v = s.velocities();
  for (std::size_t a = 0; a < mass.size(); ++a)
    sum.first += mass[a] * v[a], sum.second += mass[a] * x[a].cross(v[a]);
  return sum;
}

// In a step the upper one moves by six edges, and is over the lower one askew: its lower face comes
// to rest on the other's upper face.
TEST(FastContact, HoldsTheSurfaceOfWhatMovesByManyEdgesInAStep) {
  for (const double sideways : {0.0, 30.0}) {
    const Body above = thrown(box_at({0.013, 0.017, 0.005}, {0.04, 0.04, 0.04}, {4, 4, 4}),
                              {sideways, 0, -100}),
               below =
                   thrown(box_at({-0.03, -0.03, -0.05}, {0.15, 0.12, 0.05}, {10, 8, 4}), {0, 0, 0});
    const Problem p = meeting(above, below);
    Simulation<Host> s(p);
    const auto before = momenta_of(p, s);
    const double edge = mean_edge_length(p.body.levels[0]);
    ASSERT_GE(100 * s.macro_step(), 4 * edge);
    s.step();
    const auto x = s.positions();
    const std::vector<Point>& rest = p.body.levels[0].vertices;
    double lowest = 1, highest = -1;
    for (std::size_t a = 0; a < x.size(); ++a) {
      if (a < above.levels[0].vertices.size() && rest[a][2] < 0.006)
        lowest = std::min(lowest, x[a][2]);
      if (a >= above.levels[0].vertices.size() && rest[a][2] > -1e-6 && x[a][0] > 0.02 &&
          x[a][0] < 0.05 && x[a][1] > 0.02 && x[a][1] < 0.05)
        highest = std::max(highest, x[a][2]);
    }
    EXPECT_GE(lowest, highest - 0.3 * edge);
    const auto after = momenta_of(p, s);
    EXPECT_LE((after.first - before.first).norm(), round_off<double>(2000, before.first.norm()));
    EXPECT_LE((after.second - before.second).norm(),
              round_off<double>(2000, before.first.norm() * 0.1));
  }
}

// What passes by, however near and fast, is not touched.
TEST(FastContact, LetsAFastBodyPassBeside) {
  const Body one = thrown(box_at({0, 0, 0.02}, {0.03, 0.03, 0.03}, {3, 3, 3}), {0, 0, -100}),
             other = thrown(box_at({0.038, 0, -0.03}, {0.03, 0.03, 0.03}, {3, 3, 3}), {0, 0, 0});
  const Problem p = meeting(one, other);
  Simulation<Host> s(p);
  ASSERT_GE(100 * s.macro_step(), 0.03);
  for (int n = 0; n < 4; ++n) s.step();
  const auto v = s.velocities();
  for (std::size_t a = 0; a < v.size(); ++a)
    EXPECT_LE((v[a] - Point(0, 0, a < v.size() / 2 ? -100 : 0)).norm(), 1e-9);
}

// A stiff ball against a sheet a sixth of an edge thick, at 100 m/s: the sheet goes with it.
TEST(FastContact, DoesNotPassThroughASheet) {
  const Body ball = thrown(ball_mesh({0.003, 0.002, 0}, 0.02, 6), {0, 0, -100}, 3e6),
             sheet = thrown(box_at({-0.05, -0.05, -0.024}, {0.1, 0.1, 0.001}, {16, 16, 1}),
                            {0, 0, 0}, 3e6);
  const Problem p = meeting(ball, sheet);
  Simulation<Host> s(p);
  const auto before = momenta_of(p, s);
  const std::size_t n = ball.levels[0].vertices.size();
  while (s.time() < 4e-4) {
    advance(s, 1);
    const auto x = s.positions();
    const auto lower = [](const Point& a, const Point& b) { return a[2] < b[2]; };
    const double of_ball =
                     (*std::min_element(x.begin(), x.begin() + static_cast<long>(n), lower))[2],
                 of_sheet =
                     (*std::min_element(x.begin() + static_cast<long>(n), x.end(), lower))[2];
    ASSERT_GE(of_ball, of_sheet) << s.time();
  }
  const auto after = momenta_of(p, s);
  EXPECT_LE((after.first - before.first).norm(), round_off<double>(5000, before.first.norm()));
  EXPECT_LE((after.second - before.second).norm(),
            round_off<double>(5000, before.first.norm() * 0.1));
}

// A row of vertices falls on a needle that is a hundredth as thick as their step is long; those
// beside it fall on.
TEST(FastContact, HoldsFastPointsAtANeedle) {
  Problem p;
  p.body = thrown(box_at({-0.02, -0.02, 0.011}, {0.04, 0.04, 0.02}, {4, 4, 2}), {0, 0, -100});
  p.contact.obstacles.push_back(
      {CapsuleOptions{{-0.1, 0, 0}, {0.1, 0, 0}, 0.4e-3}, {}, {}, "needle"});
  p.integration.integrator = {"symplectic_euler"};
  Simulation<Host> s(p);
  ASSERT_GE(100 * s.macro_step(), 0.04);
  s.step();
  const auto x = s.positions();
  const std::vector<Point>& rest = p.body.levels[0].vertices;
  for (std::size_t a = 0; a < x.size(); ++a) {
    if (rest[a][2] > 0.012) continue;
    if (std::abs(rest[a][1]) < 1e-6)
      EXPECT_GE(x[a][2], -0.1 * 100 * s.macro_step()) << a;
    else
      EXPECT_NEAR(x[a][2], 0.011 - 100 * s.macro_step(), 1e-6) << a;
  }
}

// --- Against independent evaluations of random configurations ---

using Random = std::mt19937_64;

Point somewhere(Random& random) {
  std::uniform_real_distribution<double> in(-1, 1);
  return {in(random), in(random), in(random)};
}

double to_segment(const Point& p, const Point& a, const Point& b) {
  const double along = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (p - a - along * (b - a)).norm();
}

/// By the plane where the foot is within the three edges, else by the edges.
double to_triangle(const Point& p, const Point& a, const Point& b, const Point& c) {
  const Point n = (b - a).cross(c - a).normalized(), foot = p - n.dot(p - a) * n;
  const auto left = [&](const Point& u, const Point& v) {
    return n.dot((v - u).cross(foot - u)) >= 0;
  };
  if (left(a, b) && left(b, c) && left(c, a)) return std::abs(n.dot(p - a));
  return std::min({to_segment(p, a, b), to_segment(p, b, c), to_segment(p, c, a)});
}

TEST(FastContact, NearestPlacesAreNearest) {
  Random random(1);
  for (int n = 0; n < 300000; ++n) {
    const double flat = n % 3 == 0 ? 1e-3 : 1;  // needles among them
    const Point p = somewhere(random), a = somewhere(random), b = somewhere(random),
                c = n % 3 == 1 ? Point(a + 1e-3 * somewhere(random))
                               : Point(a + flat * somewhere(random));
    const Vec3<double> w =
        nearest_on_triangle(vec3<double>(p), vec3<double>(a), vec3<double>(b), vec3<double>(c));
    EXPECT_NEAR(w[0] + w[1] + w[2], 1, 1e-12);
    EXPECT_GE(std::min({w[0], w[1], w[2]}), -1e-12);
    ASSERT_NEAR((p - w[0] * a - w[1] * b - w[2] * c).norm(), to_triangle(p, a, b, c), 1e-9) << n;
  }
}

// By volumes of tetrahedra: the path's ends on both sides, and each edge passed on the same side.
TEST(FastContact, CrossingsAreCrossings) {
  Random random(2);
  const auto volume = [](const Point& a, const Point& b, const Point& c, const Point& d) {
    return (b - a).cross(c - a).dot(d - a);
  };
  int crossings = 0;
  for (int n = 0; n < 300000; ++n) {
    const Point p = somewhere(random), path = 2 * somewhere(random), a = somewhere(random),
                b = somewhere(random), c = somewhere(random), q = p + path;
    const bool through = volume(a, b, c, p) > 0 && volume(a, b, c, q) < 0;
    const double sides[] = {volume(p, q, a, b), volume(p, q, b, c), volume(p, q, c, a)},
                 all = sides[0] + sides[1] + sides[2],
                 least = std::min({sides[0] / all, sides[1] / all, sides[2] / all});
    const double when = time_of_crossing(vec3<double>(p), vec3<double>(path), vec3<double>(a),
                                         vec3<double>(b), vec3<double>(c));
    if (least >= 1e-9) {
      ASSERT_EQ(through, when <= 1) << n;
    }
    if (least < -0.0626) {  // beside it, by more than a sixteenth
      ASSERT_GT(when, 1) << n;
    }
    crossings += when <= 1;
  }
  EXPECT_GT(crossings, 1000);
}

// A path meets a capsule where the distance along it first gets to 0, and nothing where it never
// does.
TEST(FastContact, PathsMeetWhatTheyLeadThrough) {
  Random random(3);
  int meetings = 0;
  for (int n = 0; n < 20000; ++n) {
    const CapsuleOptions options{somewhere(random), somewhere(random), 0.05};
    const auto shape = Capsule::shape<double>(options);
    const Point x = 1.5 * somewhere(random), path = 3 * somewhere(random);
    const double reach = 0.05;
    if (shape(vec3<double>(x)).distance < reach) continue;
    double least = 1;
    const double length = (options.to - options.from).norm();
    for (int k = 0; k <= 1000; ++k) {
      const Point at = x + k / 1000.0 * path;
      least = std::min(least, to_segment(at, options.from, options.to) - options.radius);
    }
    const Gap<double> gap = gap_along(shape, vec3<double>(x), vec3<double>(path), reach);
    const Point normal(gap.normal[0], gap.normal[1], gap.normal[2]);
    if (path.norm() < reach || length < 0.01) continue;
    if (least > 0.01 && least < 1) {
      EXPECT_GT(gap.distance + normal.dot(path), 0) << n;
    } else if (least < -0.01) {
      EXPECT_LT(gap.distance + normal.dot(path), 0) << n;
      const Point stop = x - gap.distance / normal.dot(path) * path;
      ASSERT_NEAR(to_segment(stop, options.from, options.to), options.radius, 2e-3) << n;
      ++meetings;
    }
  }
  EXPECT_GT(meetings, 100);
}

}  // namespace
