// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <plica/core/error.hpp>
#include <plica/drivers/body/masses.hpp>
#include <plica/drivers/run/obstacles_inside.hpp>
#include <plica/kernels/contact/on_triangle.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/generators.hpp>
#include <random>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/refusal.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// Tools that fit between the points of a surface touch it all the same.
namespace {

using namespace plica;
using namespace plica::test;

Vec3<double> vec(const Point& p) { return {p[0], p[1], p[2]}; }

// --- Where a triangle is deepest ---

// Nowhere else on a triangle is it deeper, for solids of any place and direction: against a fine
// grid.
TEST(DeepestOnTriangle, IsNowhereElse) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(-1, 1);
  const auto point = [&] { return Point(any(random), any(random), any(random)); };
  for (int n = 0; n < 300; ++n) {
    const Vec3<double> a = vec(point()), b = vec(point()), c = vec(point());
    const auto compare = [&](const auto& shape) {
      const auto at = [&](double s, double q) {
        return shape(a + s * ((b - a) + q * (c - b))).distance;
      };
      double least = 1e9;
      for (int i = 0; i <= 60; ++i)
        for (int j = 0; j <= 60; ++j) least = std::min(least, at(i / 60.0, j / 60.0));
      const Vec3<double> w = deepest_on_triangle(shape, a, b, c, 2.0);
      EXPECT_NEAR(w[0] + w[1] + w[2], 1, 1e-12);
      EXPECT_LT(shape(w[0] * a + w[1] * b + w[2] * c).distance, least + 0.005) << n;
    };
    compare(Sphere::shape<double>({point(), 0.1}));
    compare(Capsule::shape<double>({point(), point(), 0.05}));
    compare(Block::shape<double>({point(), Point(0.2, 0.5, 1), point()}));
    compare(Cylinder::shape<double>({point(), point(), 0.1}));
  }
}

// --- Tools ---

constexpr double edge = 0.01, top = 0.04;

/// A block on the table, its boundary as surface.
Problem block() {
  Problem p = body_of({box_mesh({{0, 0, 0}, {0.08, 0.08, top}}, {8, 8, 4})}, "neo_hookean");
  p.body.fixed = {HalfSpaceSelection{{0, 0, 0}, {0, 0, 1}}};
  p.body.damping.mass = 80;
  p.body.surface = boundary_surface(p.body.levels[0]).surface;
  return p;
}

/// A tool that stands on the block's top at the start, then goes down.
ObstacleOptions lowered(const ShapeOptions& shape, double way, double time) {
  return {shape, {}, PathMotion{{{0, {0, 0, 0}}, {time, {0, 0, -way}}}}};
}

ShapeOptions needle(const Point& tip, double radius) {
  const Point low = tip + Point(0, 0, radius);
  return CapsuleOptions{low, low + Point(0, 0, 0.1), radius};
}

/// Three places of one triangle of the top: in its middle, in the middle of its longest edge, on a
/// point.
const Point in_face(0.04 + edge / 3, 0.04 + edge / 3, top),
    on_edge(0.04 + edge / 2, 0.04 + edge / 2, top), on_point(0.04, 0.04, top);

Point pushed(Problem p, const ObstacleOptions& tool, double time,
             const std::string& rule = "auto") {
  p.contact.obstacles = {tool};
  p.contact.whole_surface = rule;
  Simulation<Host> simulation(p);
  advance(simulation, static_cast<int>(time / simulation.macro_step()));
  return simulation.wrenches()[0].force;
}

// A needle of a tenth of an edge comes down by half an edge where no point is. It must be stopped:
// the block pushes it as it would on a point, where the block is a little stiffer or softer, and
// not as without.
TEST(ThinTools, DoNotPassBetweenPoints) {
  const Point want = pushed(block(), lowered(needle(on_point, 0.1 * edge), 0.5 * edge, 0.05), 0.1);
  for (const Point& place : {in_face, on_edge}) {
    const auto tool = lowered(needle(place, 0.1 * edge), 0.5 * edge, 0.05);
    EXPECT_EQ(pushed(block(), tool, 0.1, "never").norm(), 0);
    const Point by = pushed(block(), tool, 0.1);
    EXPECT_LT(by[2], 0.7 * want[2]) << place.transpose();
    EXPECT_GT(by[2], 3 * want[2]) << place.transpose();
  }
}

// A ball of one and a half edges, pressed in by an edge by implicit steps of many critical ones:
// the force comes to rest, at the same value by any step, and is near that of explicit steps.
TEST(ThinTools, PushSteadilyInLongSteps) {
  Problem p = block();
  p.body.material.poisson_ratio = 0.45;
  p.contact.obstacles = {
      lowered(SphereOptions{in_face + Point(0, 0, 1.5 * edge), 1.5 * edge}, edge, 0.1)};
  p.contact.stiffness_scale = 2;
  const double want = pushed(p, p.contact.obstacles[0], 0.4).norm();
  std::vector<double> at_rest;
  const std::vector<std::pair<std::string, double>> cases{{"implicit_euler", 0.004},
                                                          {"implicit_euler", 0.01},
                                                          {"implicit_euler", 0.016},
                                                          {"bdf2", 0.01}};
  for (const auto& [integrator, step] : cases) {
    p.integration.integrator = {integrator}, p.integration.macro_step = step;
    Simulation<Host> s(p);
    advance(s, static_cast<int>(0.3 / step));
    double least = 1e9, most = 0;
    for (int n = 0; n < 10; ++n) {
      advance(s, 1);
      const double now = s.wrenches()[0].force.norm();
      least = std::min(least, now), most = std::max(most, now);
    }
    EXPECT_LT(most, 1.05 * least) << integrator << " " << step;
    at_rest.push_back(most);
    EXPECT_GT(most, 0.7 * want) << integrator << " " << step;
    EXPECT_LT(most, 1.05 * want) << integrator << " " << step;
  }
  EXPECT_NEAR(at_rest.back(), at_rest.front(), 0.02 * at_rest.front());
}

// Sweeps leave contact softer the longer the step. A step that ends early keeps to a whole one's
// forces: what is at rest in whole steps is not pushed out.
TEST(ThinTools, PushNoHarderInAStepThatEndsEarly) {
  Problem p = block();
  p.body.element = {"nodal"};
  p.body.material.poisson_ratio = 0.45;
  p.contact.obstacles = {
      lowered(SphereOptions{in_face + Point(0, 0, 1.5 * edge), 1.5 * edge}, edge, 0.1)};
  p.contact.stiffness_scale = 10;
  Simulation<Host> s(p);
  const auto fastest = [&] {
    double most = 0;
    for (const Point& v : s.velocities()) most = std::max(most, v.norm());
    return most;
  };
  while (s.time() < 0.3) s.step();
  double whole = 0;
  for (int n = 0; n < 20; ++n) s.step(), whole = std::max(whole, fastest());
  for (const double part : {0.5, 0.1, 0.01}) {
    s.end_at(s.time() + part * s.macro_step());
    for (int n = 0; n < 4; ++n) {
      s.step();
      EXPECT_LT(fastest(), 1.5 * whole) << part << " " << n;
      s.end_at(std::numeric_limits<double>::infinity());
    }
  }
}

/// Two levels of a block, and a needle that comes down on it.
Problem pierced() {
  Problem p = block();
  p.body.levels.push_back(box_mesh({{0, 0, 0}, {0.08, 0.08, top}}, {5, 5, 3}));
  p.contact.obstacles = {lowered(needle(in_face, 0.1 * edge), 0.5 * edge, 0.05)};
  return p;
}

TEST(ThinTools, StopTheBodyInEveryCycle) {
  for (const char* cycle : {"single", "rsv", "him"}) {
    Problem p = pierced();
    p.integration.cycle = cycle;
    Simulation<Host> s(p);
    advance(s, static_cast<int>(0.1 / s.macro_step()));
    double lowest = top;
    for (const Point& x : s.surface_positions())
      if ((x - in_face).norm() < edge) lowest = std::min(lowest, x[2]);
    // the needle took the corners of its triangle along
    EXPECT_LT(lowest, top - 0.4 * edge) << cycle;
  }
}

// Where a tool is flat and wide, nothing is added to what points do.
TEST(ThinTools, AddNothingToFlatTools) {
  const auto tool = lowered(BlockOptions{{0.04, 0.04, top + 0.01}, {0.2, 0.2, 0.02}, {0, 0, 0}},
                            0.3 * edge, 0.05);
  const Point points = pushed(block(), tool, 0.1, "never"),
              whole = pushed(block(), tool, 0.1, "always");
  EXPECT_LT(points[2], -1);
  EXPECT_EQ(points, whole);
}

// A ball as wide as three edges is pressed in by more than its radius. Points alone are pushed
// aside until it is between them.
TEST(ThinTools, BluntOnesStayOutsideToo) {
  Problem p = block();
  p.body.material.poisson_ratio = 0.49;
  constexpr double radius = 1.5 * edge;
  const ShapeOptions ball = SphereOptions{{0.041, 0.042, top + radius}, radius};
  const auto force = [&](double way, const std::string& rule) {
    return -pushed(p, lowered(ball, way, 0.2), 0.25, rule)[2];
  };
  const double half = force(0.8 * radius, "auto"), whole = force(1.6 * radius, "auto");
  EXPECT_GT(half, 0.5);
  EXPECT_GT(whole, 2 * half);
  EXPECT_LT(force(1.6 * radius, "never"), half);
}

TEST(ThinTools, TellHowDeepTheyAre) {
  Problem p = block();
  constexpr double radius = 1.5 * edge;
  const Point centre(0.041, 0.042, top + radius);
  p.contact.obstacles = {lowered(SphereOptions{centre, radius}, radius, 0.2),
                         {SphereOptions{{0, 0, 2}, radius}, {}, {}}};
  Simulation<Host> s(p);
  advance(s, static_cast<int>(0.25 / s.macro_step()));
  double points = 0;
  for (const Point& x : s.surface_positions())
    points = std::max(points, radius - (x - centre - s.obstacle_displacement(0)).norm());
  const std::vector<double> depths = s.contact_depths();
  EXPECT_GE(depths.at(0), points - 1e-12);  // or a face between them
  EXPECT_GT(depths.at(0), 0);
  EXPECT_LT(depths.at(0), 0.1 * edge);
  EXPECT_EQ(depths.at(1), 0);
}

TEST(ThinTools, AreSeenWhereTheyCameThroughTheSurface) {
  Problem p = block();
  const Point inside(0.041, 0.042, top / 2), outside(0.041, 0.042, 2 * top);
  p.contact.obstacles = {{SphereOptions{outside, 0.3 * edge}, {}, {}},
                         {SphereOptions{outside, 0.3 * edge}, {}, {}}};
  Simulation<Host> s(p);
  EXPECT_TRUE(obstacles_inside(s, p, s.contact_depths()).empty());
  s.set_obstacle_motion(1, PathMotion{{{0, inside - outside}}});
  EXPECT_EQ(obstacles_inside(s, p, s.contact_depths()), std::vector<int>{1});
  s.set_obstacle_motion(1, PathMotion{{{0, Point(0.041, 0.042, top) - outside}}});
  EXPECT_TRUE(obstacles_inside(s, p, s.contact_depths()).empty()) << "the surface touches it";
}

// What a tool holds keeps its depth: the faces around are not pushed out either.
TEST(ThinTools, LeaveFacesThatTheyHold) {
  Problem p = block();
  p.body.damping.mass = 0;
  ObstacleOptions jaw{BlockOptions{{0.09, 0.04, 0.02}, {0.022, 0.2, 0.2}, {0, 0, 0}}, {}, {}};
  jaw.grasp = GraspOptions{.from = {0}};
  p.contact.obstacles = {jaw};  // a tenth of an edge deep in the block's side
  Simulation<Host> simulation(p);
  advance(simulation, 50);
  for (const Point& v : simulation.velocities()) EXPECT_LT(v.norm(), 1e-9);
}

/// The same surface of triangles cut in four, `times` over.
TriangleSurface cut(TriangleSurface surface, int times) {
  for (; times > 0; --times) {
    TriangleSurface finer{surface.vertices, {}};
    std::map<std::pair<int, int>, int> between;
    const auto middle = [&](int a, int b) {
      const auto [at, added] =
          between.emplace(std::minmax(a, b), static_cast<int>(finer.vertices.size()));
      const auto x = [&](int v) { return surface.vertices[static_cast<std::size_t>(v)]; };
      if (added) finer.vertices.push_back((x(a) + x(b)) / 2);
      return at->second;
    };
    for (const auto& [a, b, c] : surface.triangles) {
      const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      for (const auto& t : {std::array{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}})
        finer.triangles.push_back(t);
    }
    surface = finer;
  }
  return surface;
}

// What the whole surface gives is what very many points give on the same mesh: they leave nothing
// between them.
TEST(ThinTools, AreTouchedAsByManyPoints) {
  const auto compare = [](const ShapeOptions& shape, double way, int cuts, double tolerance) {
    const auto tool = lowered(shape, way, 0.05);
    Problem fine = block();
    fine.body.surface = cut(*fine.body.surface, cuts);
    const Point want = pushed(fine, tool, 0.2, "never"),
                whole = pushed(block(), tool, 0.2, "always");
    EXPECT_NEAR(whole[2], want[2], tolerance * std::abs(want[2]));
  };
  compare(SphereOptions{on_point + Point(0, 0, 3 * edge), 3 * edge}, 0.5 * edge, 2, 0.08);
  compare(SphereOptions{in_face + Point(0, 0, edge), edge}, 0.5 * edge, 2, 0.19);
}

/// Thrown at two needles.
Problem thrown(const char* cycle) {
  Problem p = body_of({jittered_box(decimetre, {5, 5, 5}), jittered_box(decimetre, {3, 3, 3})},
                      "neo_hookean");
  p.integration.cycle = cycle;
  p.body.surface = boundary_surface(p.body.levels[0]).surface;
  p.body.initial.velocity = {0, 0, -0.15};
  for (const Point& at : {Point(0.033, 0.047, 0), Point(0.065, 0.053, 0)})
    p.contact.obstacles.push_back(
        {CapsuleOptions{at - Point(0, 0, 0.053), at - Point(0, 0, 0.003), 0.002}, 0.3, {}});
  return p;
}

template <class B>
class ThinWrenches : public testing::Test {};
TYPED_TEST_SUITE(ThinWrenches, EachBackend);

TYPED_TEST(ThinWrenches, AreTheChangeOfMomentum) {
  using Real = typename TypeParam::Real;
  for (const char* cycle : {"single", "him"}) {
    const Problem p = thrown(cycle);
    Simulation<TypeParam> simulation(p);
    const auto mass = lumped_masses(p.body.levels[0], {p.body.material.density});
    const auto now = [&] {
      Point sum = Point::Zero();
      const auto v = simulation.velocities();
      for (std::size_t a = 0; a < v.size(); ++a) sum += mass[a] * v[a];
      return sum;
    };
    Point before = now();
    double most = 0;
    for (int n = 0; n < 60; ++n) {
      advance(simulation, 1);
      const Point after = now(), gained = (after - before) / simulation.macro_step();
      const auto wrenches = simulation.wrenches();
      const Point by = wrenches[0].force + wrenches[1].force;
      const double rounding = round_off<Real>(400, 1.0) / simulation.macro_step();
      EXPECT_LE((gained - by).norm(), rounding + round_off<Real>(100, by.norm()))
          << cycle << ", step " << n;
      most = std::max(most, wrenches[0].force.norm());
      before = after;
    }
    EXPECT_GT(most, 1) << cycle;
  }
}

#if defined(KOKKOS_ENABLE_OPENMP)
TEST(ThinTools, GiveTheSameBitsForAnyNumberOfThreads) {
  Problem shared = pierced();
  shared.integration.cycle = "rsv";
  for (const Problem& p : {thrown("single"), thrown("him"), shared}) {
    const auto result = [&](int threads) {
      Simulation<Backend<double, Kokkos::OpenMP>> s(p, Kokkos::OpenMP(threads));
      bool touched = false;
      for (int n = 0; n < 60; ++n) {
        advance(s, 1);
        touched = touched || s.wrenches()[0].force.norm() > 0;
      }
      EXPECT_TRUE(touched) << p.integration.cycle;
      return s.positions();
    };
    const auto one = result(1);
    for (int threads = 2; threads <= std::min(3, Kokkos::OpenMP().concurrency()); ++threads)
      EXPECT_TRUE(same_bits(one, result(threads)))
          << p.integration.cycle << ", " << threads << " threads";
  }
}
#endif

// The sites' energy is in the balance: a body thrown at needles keeps what it had, without damping.
TEST(ThinTools, KeepTheEnergy) {
  Problem p = thrown("single");
  p.contact.damping_scale = 0;
  for (auto& o : p.contact.obstacles) o.friction.reset();
  p.integration.macro_step = 0.5 * Simulation<Host>(p).levels()[0].critical_step;
  Simulation<Host> s(p);
  const double start = s.energies().total();
  double contact = 0;
  while (s.time() < 0.06) {
    advance(s, 1);
    const Energies e = s.energies();
    contact = std::max(contact, e.contact);
    EXPECT_NEAR(e.total(), start, 0.05 * start) << s.time();
  }
  EXPECT_GT(contact, 0.03 * start);
}

TEST(ThinTools, NameTheirRules) {
  Problem p = block();
  p.contact.obstacles = {lowered(needle(in_face, 0.1 * edge), 0.5 * edge, 0.1)};
  p.contact.whole_surface = "allways";
  EXPECT_NE(refusal([&] { Simulation<Host>{p}; }).find("always"), std::string::npos);
}

}  // namespace
