// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <plica/core/error.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/embedding.hpp>
#include <plica/meshes/generators.hpp>
#include <plica/meshes/mesh_quality.hpp>
#include <plica/meshes/signed_distance.hpp>
#include <random>

#include "support/bodies.hpp"
#include "support/refusal.hpp"
#include "support/tolerance.hpp"

namespace {

using namespace plica;
using namespace plica::test;

// All against all, and without the shortcuts: the reference
double distance_to_mesh(const TetMesh& mesh, const Point& p) {
  double best = std::numeric_limits<double>::infinity();
  for (int t = 0; t < static_cast<int>(mesh.tets.size()); ++t) {
    const auto corners = corners_of(mesh, t);
    best = std::min(best, (weighted(nearest_inside(p, corners), corners) - p).norm());
  }
  return best;
}

// By sampling the tetrahedron: coarse, but nothing in common with the code
double sampled_distance(const Point& p, const std::array<Point, 4>& corners) {
  double best = std::numeric_limits<double>::infinity();
  const int n = 40;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; i + j <= n; ++j)
      for (int k = 0; i + j + k <= n; ++k) {
        const Weights w = {double(n - i - j - k) / n, double(i) / n, double(j) / n, double(k) / n};
        best = std::min(best, (weighted(w, corners) - p).norm());
      }
  return best;
}

std::vector<Point> random_points(int count, double reach, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> coordinate(-reach, reach);
  std::vector<Point> points;
  for (int i = 0; i < count; ++i)
    points.push_back({coordinate(random), coordinate(random), coordinate(random)});
  return points;
}

void expect_as_brute_force(const TetMesh& mesh, const std::vector<Point>& points) {
  const TetLocator locator(mesh);
  for (const Point& p : points) {
    const Located at = locator.locate(p);
    ASSERT_GE(at.tet, 0);
    EXPECT_NEAR(at.distance, distance_to_mesh(mesh, p), 1e-12);
    const auto corners = corners_of(mesh, at.tet);
    EXPECT_NEAR((weighted(at.weights, corners) - p).norm(), 0.0, 1e-12);
    EXPECT_NEAR((weighted(nearest_inside(p, corners), corners) - p).norm(), at.distance, 1e-9);
    const double least = *std::min_element(at.weights.begin(), at.weights.end());
    EXPECT_EQ(at.distance == 0.0, least >= -1e-9);
  }
}

TEST(TetLocator, AgreesWithBruteForce) {
  const Box cube{{-1, -1, -1}, {1, 1, 1}};
  expect_as_brute_force(box_mesh(cube, {3, 4, 5}), random_points(300, 2.0, 1));
  expect_as_brute_force(ball_mesh({0, 0, 0}, 1.0, 6), random_points(300, 1.5, 2));
  expect_as_brute_force(cylinder_mesh({0, 0, -1}, 0.5, 2.0, 4, 5), random_points(300, 1.5, 3));
}

TEST(TetLocator, AgreesWithBruteForceOnFacesEdgesAndCorners) {
  const TetMesh coarse = box_mesh({{-1, -1, -1}, {1, 1, 1}}, {2, 3, 2});
  expect_as_brute_force(coarse, box_mesh({{-1, -1, -1}, {1, 1, 1}}, {6, 6, 6}).vertices);
  expect_as_brute_force(coarse, box_mesh({{-3, -3, -3}, {3, 3, 3}}, {6, 6, 6}).vertices);
}

TEST(TetLocator, OneTetrahedron) {
  TetMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.tets = {{0, 1, 2, 3}};
  expect_as_brute_force(mesh, random_points(200, 2.0, 4));
  EXPECT_DOUBLE_EQ(TetLocator(mesh).locate({-3, 0.2, 0.2}).distance, 3.0);
  EXPECT_DOUBLE_EQ(TetLocator(mesh).locate({0, 0, 3}).distance, 2.0);
  EXPECT_DOUBLE_EQ(TetLocator(mesh).locate({0.5, -1, -1}).distance, std::sqrt(2.0));
}

TEST(TetLocator, NearestPointOfATetrahedron) {
  const std::array<Point, 4> corners = {Point(0.1, 0, 0), Point(1.3, 0.2, 0), Point(0.3, 0.9, 0.1),
                                        Point(0.4, 0.2, 1)};
  for (const Point& p : random_points(60, 2.0, 5)) {
    const Weights w = nearest_inside(p, corners);
    EXPECT_GE(*std::min_element(w.begin(), w.end()), -1e-15);
    const double d = (weighted(w, corners) - p).norm(), sampled = sampled_distance(p, corners);
    EXPECT_LE(d, sampled + 1e-12);
    EXPECT_GE(d, sampled - 0.05);  // the spacing of the samples
  }
}

TEST(TetLocator, PointsJustBeyondAFaceAreInside) {
  const TetMesh mesh = box_mesh({{0, 0, 0}, {1, 1, 1}}, {4, 4, 4});
  const TetLocator locator(mesh);
  EXPECT_EQ(locator.locate({-1e-11, 0.3, 0.6}).distance, 0.0);
  EXPECT_EQ(locator.locate({1 + 1e-11, 1 + 1e-11, 1 + 1e-11}).distance, 0.0);
  EXPECT_NEAR(locator.locate({-1e-6, 0.3, 0.6}).distance, 1e-6, 1e-15);
}

TEST(TetLocator, IsTheSameWhateverTheSizeAndPlace) {
  const auto points = random_points(200, 1.5, 6);
  const TetMesh mesh = ball_mesh({0, 0, 0}, 1.0, 5);
  const TetLocator locator(mesh);
  for (const double scale : {1e-6, 1e3}) {
    TetMesh other = mesh;
    for (Point& p : other.vertices) p = scale * (p + Point(8, -4, 2));
    const TetLocator elsewhere(other);
    for (const Point& p : points) {
      const double d = locator.locate(p).distance,
                   e = elsewhere.locate(scale * (p + Point(8, -4, 2))).distance;
      EXPECT_NEAR(e / scale, d, 1e-12);
    }
  }
}

TEST(TetLocator, RefusesWhatItCannotLocate) {
  const TetMesh mesh = box_mesh({{0, 0, 0}, {1, 1, 1}}, {1, 1, 1});
  const TetLocator locator(mesh);
  const double nan = std::numeric_limits<double>::quiet_NaN(),
               inf = std::numeric_limits<double>::infinity();
  EXPECT_THROW(locator.locate({nan, 0, 0}), InputError);
  EXPECT_THROW(locator.locate({0, inf, 0}), InputError);
  EXPECT_THROW(locator.locate({0, 1e300, 0}), InputError);
  const TetMesh empty;
  EXPECT_THROW(TetLocator{empty}, InputError);
}

const Box unit_box{{0, 0, 0}, {1, 1, 1}};

std::vector<Point> random_points(int count, double low, double high, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> coordinate(low, high);
  std::vector<Point> points;
  for (int i = 0; i < count; ++i)
    points.push_back({coordinate(random), coordinate(random), coordinate(random)});
  return points;
}

double sum(const Weights& w) { return w[0] + w[1] + w[2] + w[3]; }

double row_value(const Embedding& e, std::size_t row, const TetMesh& mesh, const Point& gradient) {
  double value = 0.0;
  for (std::size_t k = 0; k < 4; ++k)
    value += e.weights[row][k] *
             gradient.dot(mesh.vertices[static_cast<std::size_t>(e.vertices[row][k])]);
  return value;
}

// Largest error over random linear fields of unit gradient
double linear_error(const Embedding& e, const std::vector<Point>& points, const TetMesh& mesh) {
  double worst = 0.0;
  for (const Point& direction : random_points(5, -1.0, 1.0, 99)) {
    const Point gradient = direction.normalized();
    for (std::size_t i = 0; i < points.size(); ++i)
      worst = std::max(worst, std::abs(row_value(e, i, mesh, gradient) - gradient.dot(points[i])));
  }
  return worst;
}

TEST(Embedding, ReproducesLinearFieldsInside) {
  const TetMesh mesh = box_mesh(unit_box, {5, 4, 7});
  const auto points = random_points(2000, 0.0, 1.0, 1);
  for (const Outside outside : {Outside::clamp, Outside::extrapolate, Outside::keep}) {
    const Embedding e = embed(points, mesh, outside);
    EXPECT_EQ(e.misses, 0);
    EXPECT_LT(linear_error(e, points, mesh), 1e-12);
    for (const Weights& w : e.weights) EXPECT_NEAR(sum(w), 1.0, 1e-15);
  }
}

TEST(Embedding, ReproducesLinearFieldsBetweenLevels) {
  const TetMesh fine = box_mesh(unit_box, {9, 9, 9}), coarse = box_mesh(unit_box, {6, 6, 6});
  EXPECT_LT(linear_error(embed(fine.vertices, coarse, Outside::clamp), fine.vertices, coarse),
            1e-12);
  EXPECT_LT(linear_error(embed(coarse.vertices, fine, Outside::clamp), coarse.vertices, fine),
            1e-12);
}

TEST(Embedding, OfAMeshInItselfIsTheIdentity) {
  const TetMesh mesh = ball_mesh({1, 2, 3}, 0.5, 6);
  const Embedding e = embed(mesh.vertices, mesh, Outside::clamp);
  EXPECT_EQ(e.misses, 0);
  for (std::size_t v = 0; v < e.vertices.size(); ++v)
    for (std::size_t k = 0; k < 4; ++k)
      EXPECT_NEAR(e.weights[v][k], static_cast<std::size_t>(e.vertices[v][k]) == v ? 1.0 : 0.0,
                  1e-12);
}

TEST(Embedding, ClampMovesMissesToTheNearestPoint) {
  const TetMesh mesh = box_mesh(unit_box, {3, 3, 3});
  const auto points = random_points(500, -0.5, 1.5, 2);
  const Embedding e = embed(points, mesh, Outside::clamp);
  EXPECT_GT(e.misses, 100);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point nearest = points[i].cwiseMax(0.0).cwiseMin(1.0);
    for (int a = 0; a < 3; ++a)
      EXPECT_NEAR(row_value(e, i, mesh, Point::Unit(a)), nearest[a], 1e-12);
    EXPECT_EQ(e.outside[i] != 0, (points[i] - nearest).norm() > 1e-10);
    EXPECT_GE(*std::min_element(e.weights[i].begin(), e.weights[i].end()), 0.0);
    EXPECT_NEAR(sum(e.weights[i]), 1.0, 1e-15);
  }
}

TEST(Embedding, ExtrapolateIsLinearUntilItIsHeld) {
  const TetMesh mesh = box_mesh(unit_box, {3, 3, 3});
  // a tenth of an edge: no weight gets near the bound
  const auto near = random_points(500, -0.04, 1.04, 3);
  const Embedding e = embed(near, mesh, Outside::extrapolate);
  EXPECT_GT(e.misses, 50);
  EXPECT_EQ(e.held, 0);
  EXPECT_LT(linear_error(e, near, mesh), 1e-12);

  const auto far = random_points(500, -5.0, 6.0, 4);
  const Embedding held = embed(far, mesh, Outside::extrapolate);
  EXPECT_GT(held.held, 300);
  for (const Weights& w : held.weights) {
    EXPECT_GE(*std::min_element(w.begin(), w.end()), -0.5 - 1e-12);
    EXPECT_NEAR(sum(w), 1.0, 1e-12);
  }
}

TEST(Embedding, KeepLeavesZeroRows) {
  const TetMesh mesh = box_mesh(unit_box, {2, 2, 2});
  const Embedding e = embed({{0.5, 0.5, 0.5}, {2, 2, 2}}, mesh, Outside::keep);
  EXPECT_EQ(e.misses, 1);
  EXPECT_EQ(e.outside, (std::vector<char>{0, 1}));
  EXPECT_NEAR(sum(e.weights[0]), 1.0, 1e-15);
  EXPECT_EQ(e.weights[1], Weights{});
}

TEST(Embedding, MeasuresHowFarMissesAre) {
  TetMesh mesh;
  mesh.vertices = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}};
  mesh.tets = {{0, 1, 2, 3}};
  const Embedding e = embed({{0.1, 0.1, -1}, {-3, 0.1, 0.1}}, mesh, Outside::clamp);
  EXPECT_NEAR(e.largest_distance_over_edge, 3.0 / mean_edge_length(mesh), 1e-14);
}

TEST(Embedding, NamesThePointThatIsNotFinite) {
  const TetMesh mesh = box_mesh(unit_box, {1, 1, 1});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::string text = refusal([&] { embed({{0, 0, 0}, {0, nan, 0}}, mesh, Outside::clamp); });
  EXPECT_NE(text.find("point 1 is 0, nan, 0"), std::string::npos) << text;
}

TEST(Embedding, SphereInItsBall) {
  const TetMesh mesh = ball_mesh({0, 0, 0}, 0.05, 10);
  const TriangleSurface skin = sphere_surface({0, 0, 0}, 0.05, 3);
  const Embedding e = embed(skin.vertices, mesh, Outside::extrapolate);
  EXPECT_LT(e.largest_distance_over_edge, 0.1);
  EXPECT_EQ(e.held, 0);
  EXPECT_LT(linear_error(e, skin.vertices, mesh), 1e-14);
}

double to_box(const Point& p, const Point& half) {
  const Point d = p.cwiseAbs() - half;
  return d.cwiseMax(0).norm() + std::min(d.maxCoeff(), 0.0);
}

// Edges and corners too: the sign there is where other methods go wrong.
TEST(SignedDistance, OfABoxIsExact) {
  const Point half{0.5, 0.3, 0.2};
  for (const std::array<int, 3>& cells : {std::array<int, 3>{1, 1, 1}, {3, 4, 2}}) {
    const auto surface = boundary_surface(box_mesh({-half, half}, cells)).surface;
    const SignedDistance distance(surface);
    for (const Point& p : random_field(3000, 1, 3))
      EXPECT_NEAR(distance(p), to_box(p, half), round_off<double>(16)) << p.transpose();
    for (const Point& p :
         {Point(0.9, 0, 0), Point(0.6, 0.4, 0.3), Point(0.6, 0.4, 0), Point(0.5, 0.5, 0.2), half})
      EXPECT_NEAR(distance(p), to_box(p, half), round_off<double>(16)) << p.transpose();
  }
}

// The solid angle that the surface fills, seen from p, over that of a sphere (Van Oosterom &
// Strackee 1983)
double winding(const TriangleSurface& surface, const Point& p) {
  double sum = 0;
  for (const auto& t : surface.triangles) {
    Point x[3];
    for (std::size_t k = 0; k < 3; ++k) x[k] = surface.vertices[static_cast<std::size_t>(t[k])] - p;
    const double a = x[0].norm(), b = x[1].norm(), c = x[2].norm();
    sum += 2 * std::atan2(x[0].dot(x[1].cross(x[2])),
                          a * b * c + x[0].dot(x[1]) * c + x[1].dot(x[2]) * a + x[2].dot(x[0]) * b);
  }
  return sum / (4 * std::numbers::pi);
}

/// A spiky ball: every second vertex pulled out, sharp edges both ways.
TriangleSurface star() {
  TriangleSurface s = sphere_surface({0, 0, 0}, 0.5, 2);
  for (std::size_t v = 0; v < s.vertices.size(); ++v) s.vertices[v] *= v % 2 ? 0.5 : 1.5;
  return s;
}

TEST(SignedDistance, OfAStarHasTheSignOfItsWindingNumber) {
  const TriangleSurface s = star();
  const SignedDistance distance(s);
  int inside = 0;
  for (const Point& p : random_field(4000, 0.8, 6)) {
    const bool in = winding(s, p) > 0.5;
    inside += in ? 1 : 0;
    EXPECT_EQ(distance(p) < 0, in) << p.transpose();
  }
  EXPECT_GT(inside, 100);
}

TEST(SignedDistance, OfTwoPartsIsThatOfTheNearer) {
  TriangleSurface two = sphere_surface({0, 0, 0}, 0.3, 3);
  const TriangleSurface other = sphere_surface({1, 0, 0}, 0.2, 3);
  const int first = static_cast<int>(two.vertices.size());
  two.vertices.insert(two.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (auto t : other.triangles)
    two.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  const SignedDistance distance(two);
  EXPECT_NEAR(distance({0.9, 0, 0}), -0.1, 0.004);
  EXPECT_NEAR(distance({0.6, 0, 0}), 0.2, 0.004);
  EXPECT_NEAR(distance({0, 0, 0}), -0.3, 0.004);
}

TEST(SignedDistance, ABoundChangesNothing) {
  const TriangleSurface s = star();
  const SignedDistance distance(s);
  for (const Point& p : random_field(1000, 2, 8)) {
    const double d = distance(p);
    EXPECT_EQ(distance(p, std::abs(d)), d);
    EXPECT_EQ(distance(p, 1.5 * std::abs(d)), d);
    EXPECT_EQ(distance(p, 0.5 * std::abs(d)), d);  // one that is wrong costs a second search
  }
}

TEST(SignedDistance, OfAPointThatIsNotFiniteIsNotANumber) {
  const TriangleSurface s = sphere_surface({0, 0, 0}, 1, 1);
  const SignedDistance distance(s);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isnan(distance(Point(0, nan, 0))));
  EXPECT_TRUE(std::isnan(distance(Point(0, nan, 0), 0.5)));
}

}  // namespace
