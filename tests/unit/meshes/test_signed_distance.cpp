// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/generators.hpp>
#include <plica/meshes/signed_distance.hpp>

#include "support/bodies.hpp"
#include "support/tolerance.hpp"

namespace {

using namespace plica;
using namespace plica::test;

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
    for (const Point& p : {Point(0.9, 0, 0), Point(0.6, 0.4, 0.3), Point(0.6, 0.4, 0), Point(0.5, 0.5, 0.2), half})
      EXPECT_NEAR(distance(p), to_box(p, half), round_off<double>(16)) << p.transpose();
  }
}

// The solid angle that the surface fills, seen from p, over that of a sphere (Van Oosterom & Strackee 1983)
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
  for (auto t : other.triangles) two.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
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

}  // namespace
