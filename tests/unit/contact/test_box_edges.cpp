// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <plica/drivers/run/energy_meter.hpp>
#include <plica/kernels/contact/find_on_faces.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/generators.hpp>
#include <random>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"

// Edges of boxes on faces of a body. The distance to a box has two normals at an edge.
namespace {

using namespace plica;
using namespace plica::test;

Point of(const Vec3<double>& v) { return {v[0], v[1], v[2]}; }
Vec3<double> vec(const Point& p) { return {p[0], p[1], p[2]}; }

using BoxShape = Block::Shape<double>;
using OnFaces = FindOnFaces<Host, BoxShape>;

/// Depth of the deepest place on a triangle, from a fine search.
double depth_of(const BoxShape& box, const std::array<Point, 3>& x) {
  const double size = std::max({(x[1] - x[0]).norm(), (x[2] - x[1]).norm(), (x[0] - x[2]).norm()});
  const Vec3<double> w = deepest_on_triangle(box, vec(x[0]), vec(x[1]), vec(x[2]), size);
  return -box(w[0] * vec(x[0]) + w[1] * vec(x[1]) + w[2] * vec(x[2])).distance;
}

// Where a box's edge is pressed into a triangle, the depth does not change as the triangle slides
// along itself: the normal has no part in its plane, wherever rounding puts the deepest place.
TEST(BoxEdges, PushAcrossTheFace) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-1, 1);
  int edges = 0;
  for (int n = 0; n < 400; ++n) {
    const double turn = 0.25 * std::numbers::pi * (1 + 0.6 * any(random));
    const BoxShape box = Block::shape<double>({{0, 0, 0}, {2, 6, 2}, {0, turn, 0}});
    // the lowest place of the box is on an edge along y; the triangle lies a little above it
    const double lowest = std::cos(turn) + std::sin(turn), middle = std::cos(turn) - std::sin(turn),
                 start = std::numbers::pi * any(random);
    std::array<Point, 3> x;
    for (std::size_t c = 0; c < 3; ++c) {
      const double angle = start + 2 * std::numbers::pi / 3 * static_cast<double>(c);
      x[c] = Point(middle + std::cos(angle) + 0.2 * any(random), std::sin(angle), 0.05 - lowest);
    }
    const Vec3<double> y[3] = {vec(x[0]), vec(x[1]), vec(x[2])};
    const Vec3<double> w = deepest_on_triangle(box, y[0], y[1], y[2], 2.0);
    const Gap<double> gap = box(w[0] * y[0] + w[1] * y[1] + w[2] * y[2]);
    if (!(gap.distance < -0.02) || std::min({w[0], w[1], w[2]}) < 0.02) continue;
    ++edges;
    const Point N = of(OnFaces::out_of(gap.normal, y, w));
    EXPECT_NEAR(N.norm(), 1, 1e-12);
    EXPECT_LT(std::hypot(N[0], N[1]), 1e-9) << n << ": " << N.transpose();
    // and so says the depth, which the search finds to a thousandth of the triangle
    const Point slide(0.05, 0, 0);
    EXPECT_NEAR(depth_of(box, {x[0] + slide, x[1] + slide, x[2] + slide}), -gap.distance, 4e-3);
  }
  EXPECT_GT(edges, 50);
}

// Over a side of the triangle the normal may lean: there the depth changes as the triangle slides.
// Of a smooth tool it is the tool's own, to the last bit.
TEST(BoxEdges, LeaveOtherNormals) {
  const Vec3<double> x[3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const Vec3<double> on_side{0.5, 0.5, 0}, within{0.3, 0.3, 0.4};
  const auto normal = [&](const Point& N, const Vec3<double>& w) {
    return of(OnFaces::out_of(vec(N), x, w));
  };
  const Point leaning(0, 0.6, -0.8), wrong(0, -0.6, -0.8), inward(0, 0, -1),
      smooth = Point(0.03, -0.02, -1).normalized();
  EXPECT_EQ(normal(leaning, on_side), leaning) << "the depth is less within the triangle";
  EXPECT_LT((normal(wrong, on_side) - inward).norm(), 1e-12) << "it would be more there";
  EXPECT_LT((normal(leaning, within) - inward).norm(), 1e-12);
  EXPECT_EQ(normal(smooth, within), smooth);
}

/// A slab of tissue whose underside is held, without damping, and a blade beside it that is hinged
/// above and swings into its side.
Problem retracted() {
  Problem p = body_of({box_mesh({{0, 0, 0}, {0.08, 0.06, 0.04}}, {16, 12, 8})}, "neo_hookean");
  p.body.material.young_modulus = 10e3, p.body.material.poisson_ratio = 0.45;
  p.body.element = {"nodal"};
  p.body.fixed = {HalfSpaceSelection{{0, 0, 0}, {0, 0, 1}}};
  p.body.surface = boundary_surface(p.body.levels[0]).surface;
  ObstacleOptions blade{BlockOptions{{0.088, 0.03, 0.04}, {0.014, 0.03, 0.05}}, {}, {}};
  const double angle = std::numbers::pi / 9;
  blade.turn =
      Turn{{0, 1, 0}, Point(0.088, 0.03, 0.07), {0, 0, 0}, PathTurn{{{0.05, 0}, {0.3, angle}}}};
  p.contact.obstacles = {blade};
  return p;
}

// Steps near the critical one, as a run chooses them.
TEST(BoxEdges, MakeNoEnergyWhereABoxTurns) {
  const Problem p = retracted();
  Simulation<Host> s(p);
  EnergyBudget energy(s, p);
  ObstacleWork<Host> work(s, p);
  energy.look(s.time(), s.energies());
  for (int n = 1; s.time() < 0.5; ++n) {
    ASSERT_FALSE(s.step_checked()) << s.time();
    work.step(s);
    if (n % 10 == 0) energy.look(s.time(), s.energies(), work.done());
  }
  EXPECT_GT(work.done(), 1e-4);
  EXPECT_EQ(energy.warning(), "") << energy.growth();
}

}  // namespace
