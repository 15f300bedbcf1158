// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/kernels/contact/shapes.hpp>

#include "support/bodies.hpp"
#include "support/tolerance.hpp"

// The obstacles' distance functions: their normals are unit and their gradients, and they are what they say.
namespace {

using namespace plica;
using namespace plica::test;
using V = Vec3<double>;

const Plane::Shape<double> plane{V{0.1, 0.2, -0.3}, V{0.6, 0, 0.8}};
const Sphere::Shape<double> sphere{V{0.1, -0.1, 0.2}, 0.7};
const Bowl::Shape<double> shallow{V{0.1, 0, 0.2}, 1.0, -0.6}, full{V{0, 0, 0}, 1.0, 0.0};

V vec(const Point& p) { return {p[0], p[1], p[2]}; }
Point point(const V& p) { return {p[0], p[1], p[2]}; }

template <class Shape>
void expect_gradient(const Shape& shape, double away_from_edges) {
  const double h = 1e-6;
  int tested = 0;
  for (const Point& p : random_field(4000, 1.6, 4)) {
    const Gap<double> gap = shape(vec(p));
    EXPECT_NEAR(point(gap.normal).norm(), 1, round_off<double>(8)) << p.transpose();
    Point slope;
    bool smooth = true;
    for (int k = 0; k < 3; ++k) {
      const auto at = [&](double d) { return shape(vec(p + d * Point::Unit(k))); };
      slope[k] = (at(h).distance - at(-h).distance) / (2 * h);
      const double turn = std::max((point(at(away_from_edges).normal) - point(gap.normal)).norm(),
                                   (point(at(-away_from_edges).normal) - point(gap.normal)).norm());
      smooth = smooth && turn < 0.1;  // else a ridge of the distance runs between: it has no gradient there
    }
    if (!smooth) continue;
    ++tested;
    EXPECT_LE((slope - point(gap.normal)).norm(), 1e-6) << p.transpose();
  }
  EXPECT_GT(tested, 3000);
}

TEST(ObstacleShapes, NormalsAreTheUnitGradient) {
  expect_gradient(plane, 1e-4);
  expect_gradient(sphere, 1e-4);
  expect_gradient(shallow, 1e-4);
  expect_gradient(full, 1e-4);
}

template <class Shape>
void expect_continuous(const Shape& shape) {  // a distance never changes by more than the way gone
  const auto steps = random_field(20000, 1e-3, 6);
  const auto points = random_field(20000, 1.3, 5);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double change = shape(vec(points[i] + steps[i])).distance - shape(vec(points[i])).distance;
    EXPECT_LE(std::abs(change), steps[i].norm() * (1 + 1e-9)) << points[i].transpose();
  }
}

TEST(ObstacleShapes, DistanceIsContinuous) {
  expect_continuous(plane);
  expect_continuous(sphere);
  expect_continuous(shallow);
  expect_continuous(full);
}

// Outside the solid, against a search over the bowl's boundary: shell below the rim and flat top beside it.
TEST(ObstacleShapes, BowlsDistanceIsTheNearestPointOfItsBoundary) {
  const Point centre{0.1, 0, 0.2};
  const double opening = 0.8, top = -0.6;
  for (const Point& p : random_field(300, 1.2, 8)) {
    const Gap<double> gap = shallow(vec(p));
    const Point d = p - centre;
    const bool outside = d[2] > top || d.norm() < 1;
    EXPECT_EQ(gap.distance > 0, outside) << p.transpose();
    if (!outside) continue;
    // by symmetry the nearest point is in the plane of p and the axis
    const double across = std::hypot(d[0], d[1]);
    double nearest = 1e9;
    for (int i = 0; i <= 20000; ++i) {
      const double t = i / 20000.0, angle = t * std::asin(opening);
      nearest = std::min({nearest, std::hypot(across - std::sin(angle), d[2] + std::cos(angle)),
                          std::hypot(across - opening - 3 * t, d[2] - top)});
    }
    EXPECT_NEAR(gap.distance, nearest, 2e-4) << p.transpose();
  }
}

TEST(ObstacleShapes, CentresAreNoHoles) {
  EXPECT_DOUBLE_EQ(sphere(sphere.centre).distance, -0.7);
  EXPECT_DOUBLE_EQ(shallow(shallow.centre).distance, 1.0);
  EXPECT_DOUBLE_EQ(full(full.centre).distance, 1.0);
  for (const Gap<double>& gap : {sphere(sphere.centre), shallow(shallow.centre), full(full.centre)})
    EXPECT_DOUBLE_EQ(point(gap.normal).norm(), 1);
  // on the axis above the rim every point of the rim is as near as another
  EXPECT_NEAR(point(full(V{0, 0, 0.3}).normal).norm(), 1, round_off<double>(8));
  EXPECT_NEAR(full(V{0, 0, 0.3}).distance, std::hypot(1, 0.3), round_off<double>(8));
}

}  // namespace
