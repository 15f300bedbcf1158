// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <plica/core/error.hpp>
#include <plica/meshes/ball_mesh.hpp>
#include <plica/meshes/box_mesh.hpp>
#include <plica/meshes/edge_lengths.hpp>
#include <plica/meshes/embedding.hpp>
#include <plica/meshes/sphere_surface.hpp>
#include <random>

namespace {

using namespace plica;

const Box unit_box{{0, 0, 0}, {1, 1, 1}};

std::vector<Point> random_points(int count, double low, double high, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> coordinate(low, high);
  std::vector<Point> points;
  for (int i = 0; i < count; ++i) points.push_back({coordinate(random), coordinate(random), coordinate(random)});
  return points;
}

double sum(const Weights& w) { return w[0] + w[1] + w[2] + w[3]; }

double row_value(const Embedding& e, std::size_t row, const TetMesh& mesh, const Point& gradient) {
  double value = 0.0;
  for (std::size_t k = 0; k < 4; ++k)
    value += e.weights[row][k] * gradient.dot(mesh.vertices[static_cast<std::size_t>(e.vertices[row][k])]);
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
  EXPECT_LT(linear_error(embed(fine.vertices, coarse, Outside::clamp), fine.vertices, coarse), 1e-12);
  EXPECT_LT(linear_error(embed(coarse.vertices, fine, Outside::clamp), coarse.vertices, fine), 1e-12);
}

TEST(Embedding, OfAMeshInItselfIsTheIdentity) {
  const TetMesh mesh = ball_mesh({1, 2, 3}, 0.5, 6);
  const Embedding e = embed(mesh.vertices, mesh, Outside::clamp);
  EXPECT_EQ(e.misses, 0);
  for (std::size_t v = 0; v < e.vertices.size(); ++v)
    for (std::size_t k = 0; k < 4; ++k)
      EXPECT_NEAR(e.weights[v][k], static_cast<std::size_t>(e.vertices[v][k]) == v ? 1.0 : 0.0, 1e-12);
}

TEST(Embedding, ClampMovesMissesToTheNearestPoint) {
  const TetMesh mesh = box_mesh(unit_box, {3, 3, 3});
  const auto points = random_points(500, -0.5, 1.5, 2);
  const Embedding e = embed(points, mesh, Outside::clamp);
  EXPECT_GT(e.misses, 100);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point nearest = points[i].cwiseMax(0.0).cwiseMin(1.0);
    for (int a = 0; a < 3; ++a) EXPECT_NEAR(row_value(e, i, mesh, Point::Unit(a)), nearest[a], 1e-12);
    EXPECT_EQ(e.outside[i] != 0, (points[i] - nearest).norm() > 1e-10);
    EXPECT_GE(*std::min_element(e.weights[i].begin(), e.weights[i].end()), 0.0);
    EXPECT_NEAR(sum(e.weights[i]), 1.0, 1e-15);
  }
}

TEST(Embedding, ExtrapolateIsLinearUntilItIsHeld) {
  const TetMesh mesh = box_mesh(unit_box, {3, 3, 3});
  const auto near = random_points(500, -0.04, 1.04, 3);  // a tenth of an edge: no weight gets near the bound
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
  try {
    embed({{0, 0, 0}, {0, nan, 0}}, mesh, Outside::clamp);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("point 1 is 0, nan, 0"), std::string::npos) << error.what();
  }
}

TEST(Embedding, SphereInItsBall) {
  const TetMesh mesh = ball_mesh({0, 0, 0}, 0.05, 10);
  const TriangleSurface skin = sphere_surface({0, 0, 0}, 0.05, 3);
  const Embedding e = embed(skin.vertices, mesh, Outside::extrapolate);
  EXPECT_LT(e.largest_distance_over_edge, 0.1);
  EXPECT_EQ(e.held, 0);
  EXPECT_LT(linear_error(e, skin.vertices, mesh), 1e-14);
}

}  // namespace
