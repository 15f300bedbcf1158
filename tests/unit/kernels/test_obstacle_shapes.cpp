// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/drivers/contact/sample_distance.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/generators.hpp>

#include "support/bodies.hpp"
#include "support/tolerance.hpp"

// The obstacles' distance functions: their normals are unit and their gradients, and they are what
// they say.
namespace {

using namespace plica;
using namespace plica::test;

using V = Vec3<double>;

const Plane::Shape<double> plane{V{0.1, 0.2, -0.3}, V{0.6, 0, 0.8}};
const Sphere::Shape<double> sphere{V{0.1, -0.1, 0.2}, 0.7};
const Bowl::Shape<double> shallow{V{0.1, 0, 0.2}, 1.0, -0.6}, full{V{0, 0, 0}, 1.0, 0.0};
const Capsule::Shape<double> capsule{V{-0.5, 0.1, -0.2}, V{0.6, 0, 0.8}, 1.0, 0.3};
const Block::Shape<double> block{
    V{0.1, -0.2, 0.1}, {V{0.6, 0, 0.8}, V{0, 1, 0}, V{-0.8, 0, 0.6}}, V{0.7, 0.4, 0.2}};
const Cylinder::Shape<double> cylinder{V{0.1, 0.1, -0.1}, V{0, 0.6, 0.8}, 0.5, 0.4};
Cone::Shape<double> cone(double radius, double to_radius) {
  return Cone::shape<double>({{-0.5, 0.1, -0.4}, {0.1, 0.1, 0.4}, radius, to_radius});
}

struct SampledBall {
  TriangleSurface surface = sphere_surface({0.1, -0.1, 0.2}, 0.7, 5);
  DistanceGrid grid = sample_distance(surface, 40);
  SampledSurface::Shape<double> shape() const {
    return {grid.value.data(),
            {grid.nodes[0], grid.nodes[1], grid.nodes[2]},
            V{grid.origin[0], grid.origin[1], grid.origin[2]},
            grid.cell,
            grid.margin};
  }
};
const SampledBall& sampled() {
  static const SampledBall ball;
  return ball;
}

// Of every shape some examples: one that has none here does not compile.
std::vector<Plane::Shape<double>> examples(Plane) { return {plane}; }
std::vector<Sphere::Shape<double>> examples(Sphere) { return {sphere}; }
std::vector<Bowl::Shape<double>> examples(Bowl) { return {shallow, full}; }
std::vector<Capsule::Shape<double>> examples(Capsule) { return {capsule}; }
std::vector<Block::Shape<double>> examples(Block) { return {block}; }
std::vector<Cylinder::Shape<double>> examples(Cylinder) { return {cylinder}; }
std::vector<Cone::Shape<double>> examples(Cone) {
  return {cone(0.7, 0), cone(0.3, 0.6), cone(0.8, 0.5), cone(0.5, 0.5)};
}
std::vector<SampledSurface::Shape<double>> examples(SampledSurface) { return {sampled().shape()}; }

// How far the slope of the distance may be from the normal: the sampled one's is that of its
// interpolation.
template <class Family>
constexpr double slope_error = 1e-6;
template <>
constexpr double slope_error<SampledSurface> = 0.05;

// The distances in which it is one: the sampled one's is a lower bound outside its grid, and rough
// around its middle.
template <class Family>
constexpr double lowest = -1e9;
template <class Family>
constexpr double highest = 1e9;
template <>
constexpr double lowest<SampledSurface> = -0.4;
template <>
constexpr double highest<SampledSurface> = 0.1;
template <class Family>
bool within(double distance) {
  return distance > lowest<Family> && distance < highest<Family>;
}

V vec(const Point& p) { return {p[0], p[1], p[2]}; }
Point point(const V& p) { return {p[0], p[1], p[2]}; }

template <class Family, class Shape>
void expect_gradient(const Shape& shape) {
  const double h = 1e-6, away_from_edges = 1e-4;
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
      // else a ridge of the distance runs between: it has no gradient there
      smooth = smooth && turn < 0.1;
    }
    if (!smooth || (gap.distance < 0 && !within<Family>(gap.distance))) continue;
    ++tested;
    EXPECT_LE((slope - point(gap.normal)).norm(), slope_error<Family>) << p.transpose();
  }
  EXPECT_GT(tested, 3000);
}

TEST(ObstacleShapes, NormalsAreTheUnitGradient) {
  ObstacleShapes::for_each([](auto family) {
    SCOPED_TRACE(family.name);
    for (const auto& shape : examples(family)) expect_gradient<decltype(family)>(shape);
  });
}

template <class Family, class Shape>
void expect_continuous(const Shape& shape) {  // a distance never changes by more than the way gone
  const auto steps = random_field(20000, 1e-3, 6);
  const auto points = random_field(20000, 1.3, 5);
  int tested = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double before = shape(vec(points[i])).distance,
                 after = shape(vec(points[i] + steps[i])).distance;
    if (!within<Family>(before) || !within<Family>(after)) continue;
    ++tested;
    const double slack = slope_error<Family> > 0.01 ? slope_error<Family> : 1e-9;
    EXPECT_LE(std::abs(after - before), steps[i].norm() * (1 + slack)) << points[i].transpose();
  }
  EXPECT_GT(tested, 1000);
}

TEST(ObstacleShapes, DistanceIsContinuous) {
  ObstacleShapes::for_each([](auto family) {
    SCOPED_TRACE(family.name);
    for (const auto& shape : examples(family)) expect_continuous<decltype(family)>(shape);
  });
}

// Back along the normal by the distance lies the surface: with the two tests above the distance is
// the true one.
template <class Family, class Shape>
void expect_surface(const Shape& shape, double tolerance) {
  int outside = 0, inside = 0;
  for (const Point& p : random_field(2000, 0.8, 9)) {
    const Gap<double> gap = shape(vec(p));
    inside += gap.distance < 0 ? 1 : 0;
    if (gap.distance < 0 || !within<Family>(gap.distance)) continue;
    ++outside;
    const Point foot = p - gap.distance * point(gap.normal);
    EXPECT_NEAR(shape(vec(foot)).distance, 0, tolerance) << p.transpose();
  }
  EXPECT_GT(outside, 100);
  EXPECT_GT(inside, 20);
}

TEST(ObstacleShapes, TheSurfaceIsADistanceAway) {
  ObstacleShapes::for_each([](auto family) {
    SCOPED_TRACE(family.name);
    const bool sampled_one = std::is_same_v<decltype(family), SampledSurface>;
    for (const auto& shape : examples(family))
      expect_surface<decltype(family)>(shape, sampled_one ? 2e-3 : 1e-9);
  });
}

TEST(ObstacleShapes, DistancesThatOneCanSee) {
  const Capsule::Shape<double> upright{V{0, 0, 0}, V{0, 0, 1}, 2.0, 0.5};
  EXPECT_DOUBLE_EQ(upright(V{1, 0, 1}).distance, 0.5);
  EXPECT_DOUBLE_EQ(upright(V{0, 0, 3}).distance, 0.5);
  EXPECT_DOUBLE_EQ(upright(V{3, 4, -0.0}).distance, 4.5);
  EXPECT_DOUBLE_EQ(upright(V{0, 0, 1}).distance, -0.5);
  const Block::Shape<double> box{V{0, 0, 0}, Mat3<double>::identity(), V{1, 2, 3}};
  EXPECT_DOUBLE_EQ(box(V{2, 0, 0}).distance, 1);
  EXPECT_DOUBLE_EQ(box(V{4, 6, 0}).distance, 5);
  EXPECT_DOUBLE_EQ(box(V{3, 4, 4}).distance, 3);
  EXPECT_DOUBLE_EQ(box(V{0, -1.5, 0}).distance, -0.5);
  EXPECT_DOUBLE_EQ(box(V{0, -1.9, 0}).normal[1], -1);
  const Cylinder::Shape<double> disc{V{0, 0, 0}, V{0, 0, 1}, 1.0, 2.0};
  EXPECT_DOUBLE_EQ(disc(V{0, 0, 3}).distance, 2);
  EXPECT_DOUBLE_EQ(disc(V{0, 5, 0.5}).distance, 3);
  EXPECT_DOUBLE_EQ(disc(V{5, 0, -5}).distance, 5);
  EXPECT_DOUBLE_EQ(disc(V{0, 0, -0.75}).distance, -0.25);
  EXPECT_NEAR(disc(V{1.9, 0, 0}).distance, -0.1, 1e-15);
  // its side: 4 across to 3 along, 5 long
  const auto needle = Cone::shape<double>({{0, 0, 0}, {0, 0, 4}, 3, 0});
  EXPECT_DOUBLE_EQ(needle(V{0, 0, 6}).distance, 2);
  EXPECT_DOUBLE_EQ(needle(V{0, -3, 4}).distance, 2.4);
  EXPECT_DOUBLE_EQ(needle(V{0, 0, 2}).distance, -1.2);
  EXPECT_DOUBLE_EQ(needle(V{0, 1, 0.25}).distance, -0.25);
  EXPECT_DOUBLE_EQ(needle(V{6, 0, -4}).distance, 5);
  EXPECT_DOUBLE_EQ(needle(V{1, 0, -4}).distance, 4);
  EXPECT_EQ(Cone::radius({{0, 0, 0}, {0, 0, 4}, 3, 1}), 1);
}

// Nodes hold the exact distance, and nobody is told to be farther away than he is.
TEST(ObstacleShapes, SampledSurfaceIsNearTheSphereItSamples) {
  const SampledBall& ball = sampled();
  const auto shape = ball.shape();
  double worst = 0;
  int beyond = 0;
  for (const Point& p : random_field(4000, 3, 2)) {
    const double want = sphere(vec(p)).distance, got = shape(vec(p)).distance;
    const bool in_grid =
        ((p - ball.grid.origin).array() >= 0).all() &&
        ((p - ball.grid.origin).array() <=
         ball.grid.cell *
             Eigen::Array3d(ball.grid.nodes[0] - 1, ball.grid.nodes[1] - 1, ball.grid.nodes[2] - 1))
            .all();
    if (in_grid && want > -0.5) worst = std::max(worst, std::abs(got - want));
    if (in_grid) continue;
    ++beyond;
    EXPECT_LE(got, want + 0.01) << p.transpose();
    EXPECT_GT(got, 0) << p.transpose();
  }
  // of 0.7: the interpolation is off by up to an eighth of cell^2 times the curvature
  EXPECT_LT(worst, 0.002);
  EXPECT_GT(beyond, 1000);
}

// Outside the solid, against a search over the bowl's boundary: shell below the rim and flat top
// beside it.
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
  EXPECT_NEAR(point(full(V{0, 0, 0.3}).normal).norm(), 1, test::round_off<double>(8));
  EXPECT_NEAR(full(V{0, 0, 0.3}).distance, std::hypot(1, 0.3), test::round_off<double>(8));
}

}  // namespace
