// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <plica/drivers/body/masses.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/generators.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"

// Tools whose surface is open: sheets with two sides.
namespace {

using namespace plica;
using namespace plica::test;

/// Part of a sphere of radius 13 cm round the origin, open above.
TriangleSurface bowl() {
  constexpr int around = 32, rings = 10;
  constexpr double radius = 0.13, pi = std::numbers::pi;
  TriangleSurface s;
  s.vertices.emplace_back(0, 0, -radius);
  for (int i = 1; i <= rings; ++i)
    for (int j = 0; j < around; ++j) {
      const double t = 0.3 * pi * i / rings, p = 2 * pi * j / around;
      s.vertices.push_back(
          radius * Point(std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), -std::cos(t)));
    }
  for (int j = 0; j < around; ++j) {
    const int next = (j + 1) % around;
    s.triangles.push_back({0, 1 + next, 1 + j});
    for (int i = 0; i + 1 < rings; ++i) {
      const int a = 1 + i * around + j, b = 1 + i * around + next;
      s.triangles.push_back({a, b, b + around}), s.triangles.push_back({a, b + around, a + around});
    }
  }
  return s;
}

/// Force of a sheet on a ball of tissue that comes to rest on it, over the ball's weight.
/// @param at  centre of the ball, whose radius is 4 cm [m]
/// @param up  direction against gravity: 1 along z, -1 against it
double borne(const TriangleSurface& sheet, const Point& at, double up) {
  Problem p = body_of({ball_mesh(at, 0.04, 6)}, "neo_hookean");
  p.body.element = {"nodal"};
  p.body.material.young_modulus = 20e3, p.body.material.poisson_ratio = 0.4;
  p.body.damping.mass = 40;
  p.body.surface = boundary_surface(p.body.levels[0]).surface;
  p.gravity = {0, 0, -9.81 * up};
  SurfaceOptions tool{sheet, 0};
  tool.thickness = 4e-3;
  p.contact.obstacles = {{tool, 0.5, {}}};
  Simulation<Host> s(p);
  while (s.time() < 0.6) {
    if (s.step_checked()) return -1;
  }
  double mass = 0;
  for (const double m : lumped_masses(p.body.levels[0], region_densities(p.body, p.body.levels[0])))
    mass += m;
  return up * s.wrenches()[0].force[2] / (9.81 * mass);
}

TEST(Sheets, BearABodyOnBothSides) {
  const TriangleSurface hollow = bowl();
  EXPECT_NEAR(borne(hollow, {0, 0, -0.13 + 0.043}, 1), 1, 0.02) << "in the bowl";
  TriangleSurface plate;
  plate.vertices = {{-0.06, -0.06, 0}, {0.06, -0.06, 0}, {0.06, 0.06, 0}, {-0.06, 0.06, 0}};
  plate.triangles = {{0, 1, 2}, {0, 2, 3}};
  EXPECT_NEAR(borne(plate, {0, 0, 0.043}, 1), 1, 0.02) << "on the plate";
  EXPECT_NEAR(borne(plate, {0, 0, -0.043}, -1), 1, 0.02) << "under it";
}

}  // namespace
