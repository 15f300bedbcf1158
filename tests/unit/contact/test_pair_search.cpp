// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <plica/drivers/contact/pair_search.hpp>
#include <plica/drivers/run/join_bodies.hpp>
#include <plica/drivers/study/level_probe.hpp>
#include <plica/kernels/contact/gap_of_edges.hpp>
#include <plica/kernels/contact/on_triangle.hpp>
#include <plica/kernels/vectors.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/generators.hpp>
#include <random>

#include "support/backends.hpp"
#include "support/bodies.hpp"

// The search for parts of surfaces that are near each other: it finds what a search through all
// pairs finds, and stays sound in states that are not.
namespace {

using namespace plica;
using namespace plica::test;

constexpr double nan = std::numeric_limits<double>::quiet_NaN(),
                 inf = std::numeric_limits<double>::infinity();

/// Two blocks on top of each other, with a small gap between them.
Problem stacked() {
  const auto block = [](double z) {
    Body body =
        body_of({box_mesh({{0, 0, z}, {0.1, 0.1, z + 0.1}}, {3, 3, 3})}, "neo_hookean").body;
    body.surface = boundary_surface(body.levels[0]).surface;
    return body;
  };
  Problem p;
  p.body = join_bodies({{"under", block(0)}, {"over", block(0.1005)}});
  return p;
}

/// A straight bar that may touch itself.
Problem bar() {
  Problem p = body_of({box_mesh({{0, 0, 0}, {0.6, 0.06, 0.06}}, {30, 3, 3})}, "neo_hookean");
  p.body.surface = boundary_surface(p.body.levels[0]).surface;
  p.contact.self = true;
  return p;
}

/// The search at given places of the surface's points.
struct Search {
  Problem problem;
  LevelProbe<Host> probe{problem};
  const ContactRecords<Host>& records = probe.at(0).response().records();
  PairSearch<Host> search{probe.at(0).contact()->limits(), records, probe.at(0).surface};
  BlockSums<Host> blocks{records.points};
  std::vector<Point> rest = problem.body.surface->vertices;

  /// Returns the triangle that each point may touch; -1: none.
  std::vector<int> partners(const std::vector<Point>& x) {
    const Host::Exec& exec = probe.built.hierarchy->exec();
    exec.fence();
    for (int p = 0; p < records.points; ++p)
      for (int k = 0; k < 3; ++k) records.places(p, k) = x[static_cast<std::size_t>(p)][k];
    search.find(exec, probe.at(0).surface, probe.at(0).state, records, true, blocks);
    exec.fence();
    const int* found = records.partner.data();
    return {found, found + records.points};
  }
};

/// The search through all pairs of a point and a triangle, and through all pairs of edges.
struct AllPairs {
  const ContactRecords<Host>& records;
  const std::vector<Point>& rest;
  PairLimits<double> limits;

  Vec3<double> x(int p) const { return vector_at<Host>(records.places, p); }
  int corner(int t, int c) const { return records.mesh.corner(3 * t + c); }
  int end(int e, int i) const { return records.mesh.edge(4 * e + i); }
  template <class At>
  Vec3<double> away(int p, int t, const At& at) const {
    const auto a = at(corner(t, 0)), b = at(corner(t, 1)), c = at(corner(t, 2));
    const auto w = nearest_on_triangle(at(p), a, b, c);
    return at(p) - (w[0] * a + w[1] * b + w[2] * c);
  }
  double distance(int p, int t) const {
    const auto d = away(p, t, [&](int q) { return x(q); });
    return std::sqrt(dot(d, d));
  }
  /// Returns true where a point and a triangle are of two bodies, or far apart or across a gap at
  /// rest.
  bool may_touch(int p, int t) const {
    if (records.body_of(p) != records.body_of(corner(t, 0))) return limits.between;
    const auto at = [&](int q) {
      const Point& r = rest[static_cast<std::size_t>(q)];
      return Vec3<double>{r[0], r[1], r[2]};
    };
    const auto d = away(p, t, at), a = at(corner(t, 0)),
               n = cross(at(corner(t, 1)) - a, at(corner(t, 2)) - a);
    const double length = std::sqrt(dot(d, d));
    return limits.self &&
           (length > limits.apart || dot(d, n) > 0.5 * length * std::sqrt(dot(n, n)));
  }
  /// Returns the distance of the nearest triangle within reach that a point may touch; infinity:
  /// there is none.
  double nearest(int p) const {
    double least = inf;
    for (int t = 0; t < records.mesh.triangles; ++t)
      if (may_touch(p, t)) least = std::min(least, distance(p, t));
    return least < limits.reach ? least : inf;
  }
  SurfaceEdge<double> edge(int e) const {
    return {x(end(e, 0)), x(end(e, 1)), x(end(e, 2)), x(end(e, 3))};
  }
  bool may_touch_edge(int e, int f) const {
    for (int t = 0; t < records.mesh.triangles; ++t)
      for (int c = 0; c < 3; ++c)
        if (records.mesh.side(3 * t + c) == f && may_touch(end(e, 0), t) && may_touch(end(e, 1), t))
          return true;
    return false;
  }
  /// Returns true where an edge that begins in p meets another with a higher number.
  bool crosses(int p) const {
    const int edges = static_cast<int>(records.mesh.edge.extent(0)) / 4;
    for (int e = records.mesh.first_edge(p); e < records.mesh.first_edge(p + 1); ++e)
      for (int f = e + 1; f < edges; ++f) {
        const SurfaceEdge<double> own = edge(e), other = edge(f);
        if (!may_be_steep(own) || !may_be_steep(other)) continue;
        const EdgeGap<double> gap = gap_of_edges(own, other, {});
        if (gap.meet && std::abs(gap.depth) < 0.5 * limits.reach && may_touch_edge(e, f))
          return true;
      }
    return false;
  }
};

/// What a search found, over all its states.
struct Found {
  int points = 0, edges = 0;
};

/// Expects the search to find at these places what all pairs have.
void expect_as_all_pairs(Search& s, const std::vector<Point>& x, Found& found) {
  const std::vector<int> partner = s.partners(x);
  const AllPairs all{s.records, s.rest, s.probe.at(0).contact()->limits()};
  for (int p = 0; p < s.records.points; ++p) {
    const double nearest = all.nearest(p);
    const int own = partner[static_cast<std::size_t>(p)];
    ASSERT_EQ(own >= 0, nearest < inf) << p << " " << nearest;
    if (own < 0) continue;
    ++found.points;
    ASSERT_TRUE(all.may_touch(p, own));
    ASSERT_NEAR(all.distance(p, own), nearest, 1e-12);
  }
  for (int p = 0; p < s.records.points; ++p) {
    const bool crosses = all.crosses(p);
    ASSERT_EQ(s.records.near(s.records.of_point(s.records.obstacles + 1, p)) > 0, crosses) << p;
    found.edges += crosses;
  }
}

/// Returns a vector whose coordinates are between -size and size.
Point random_point(std::mt19937& random, double size) {
  std::uniform_real_distribution<double> one(-size, size);
  const double x = one(random), y = one(random);
  return {x, y, one(random)};
}

// Two blocks whose faces are rough and turn over each other. In most steps lists stay; every fifth
// step everything moves further than they hold for.
TEST(PairSearch, FindsWhatAllPairsOfTwoBodiesHave) {
  Search s{stacked()};
  std::mt19937 random(1);
  std::vector<Point> rough(s.rest.size());
  Found found;
  for (int step = 0; step < 30; ++step) {
    std::vector<Point> x = s.rest;
    for (std::size_t p = 0; p < x.size(); ++p) {
      if (step % 5 == 0) rough[p] = random_point(random, 0.004);
      rough[p] += random_point(random, 0.0004);
      if (s.records.body_of(static_cast<int>(p)) == 1) {
        const double angle = 0.2 + 0.05 * (step / 5), u = x[p][0] - 0.05, v = x[p][1] - 0.05;
        x[p][0] = 0.05 + std::cos(angle) * u - std::sin(angle) * v;
        x[p][1] = 0.05 + std::sin(angle) * u + std::cos(angle) * v;
        x[p][2] += 0.0095;
      }
      x[p] += rough[p];
    }
    ASSERT_NO_FATAL_FAILURE(expect_as_all_pairs(s, x, found)) << step;
  }
  EXPECT_GT(found.points, 100);
}

/// Returns the place after a turn of 45 degrees about an axis through `centre`, which moves to
/// `to`.
Point on_edge(const Point& at, const Point& centre, const Point& axis, const Point& to) {
  return to + Eigen::AngleAxisd(M_PI / 4, axis) * (at - centre);
}

// Two blocks, each on an edge, so that a ridge lies across another one. The upper one slides
TEST(PairSearch, FindsWhatAllPairsOfCrossedRidgesHave) {
  Search s{stacked()};
  std::mt19937 random(3);
  Found found;
  const double high = 0.1 * std::sqrt(2.0);  // of a block on its edge
  for (int step = 0; step < 40; ++step) {
    const Point over(0.05 + 0.0011 * step, 0.03 + 0.0007 * step * (step % 7), high - 0.0005);
    std::vector<Point> x = s.rest;
    for (std::size_t p = 0; p < x.size(); ++p)
      x[p] = (s.records.body_of(static_cast<int>(p)) == 0
                  ? on_edge(x[p], {0.05, 0.05, 0.05}, Point::UnitY(), {0.05, 0.05, 0})
                  : on_edge(x[p], {0.05, 0.05, 0.1505}, Point::UnitX(), over)) +
             random_point(random, 0.0003);
    ASSERT_NO_FATAL_FAILURE(expect_as_all_pairs(s, x, found)) << step;
  }
  EXPECT_GT(found.edges, 20);
}

// A straight bar is bent until its ends are before each other, and twisted a little.
TEST(PairSearch, FindsWhatAllPairsOfABentBarHave) {
  Search s{bar()};
  std::mt19937 random(2);
  Found found;
  for (int step = 0; step < 16; ++step) {
    const double angle = 6.0 + 0.0125 * step, radius = 0.6 / angle;
    std::vector<Point> x = s.rest;
    for (Point& at : x) {
      const double turn = angle * at[0] / 0.6, r = radius - 0.03 + at[1];
      at = Point(r * std::sin(turn), r * std::cos(turn), at[2] + 0.004 * step / 16 * turn) +
           random_point(random, 0.0004);
    }
    ASSERT_NO_FATAL_FAILURE(expect_as_all_pairs(s, x, found)) << step;
  }
  EXPECT_GT(found.points, 50);
}

// Whatever the places are, partners are triangles of the surface; and once places are sound again,
// so are the partners.
TEST(PairSearch, SurvivesPlacesThatAreNotFinite) {
  Search s{stacked()};
  const std::vector<int> sound = s.partners(s.rest);
  std::vector<std::size_t> touching;
  for (std::size_t p = 0; p < sound.size(); ++p)
    if (sound[p] >= 0) touching.push_back(p);
  ASSERT_GE(touching.size(), 16u);
  const std::vector<std::vector<Point>> wild = {
      {Point::Constant(nan)},
      {Point::Constant(inf)},
      {Point::Constant(-inf)},
      {Point(0, inf, 0.1)},
      {Point(0.05, 0.05, nan)},
      {Point::Constant(1e300)},
      {Point::Constant(nan), Point::Constant(inf)},
      {Point::Constant(inf), Point::Constant(-inf), Point(1e160, -1e160, 0)},
      {Point(inf, 0, 0), Point(0, -1e300, 0), Point(0, 0, inf), Point(nan, 1e200, 0)}};
  for (std::size_t w = 0; w < wild.size(); ++w)
    for (const std::size_t every : {std::size_t{1}, std::size_t{3}, touching.size()}) {
      std::vector<Point> x = s.rest;
      for (std::size_t i = 0; i < touching.size(); i += every)
        x[touching[i]] = wild[w][i / every % wild[w].size()];
      for (std::size_t p = 0; every == 1 && p < x.size(); ++p) x[p] = wild[w][p % wild[w].size()];
      for (const int triangle : s.partners(x)) {
        EXPECT_GE(triangle, -1) << w << " " << every;
        EXPECT_LT(triangle, s.records.mesh.triangles) << w << " " << every;
      }
      EXPECT_EQ(s.partners(s.rest), sound) << w << " " << every;
    }
}

}  // namespace
