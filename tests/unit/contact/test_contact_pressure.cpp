// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <plica/drivers/run/join_bodies.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/generators.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// The pressure of contact at the points of the surface: with their areas it is the normal force.
namespace {

using namespace plica;
using namespace plica::test;

constexpr double g = 9.81;

/// A flat block on the plane z = 0. Every macro step is one sub-step, so that the last forces are
/// those that an obstacle reports.
Problem block_on_a_plane(const std::string& integrator = "symplectic_euler",
                         std::optional<double> macro_step = {}, int cells = 4) {
  Problem p = body_of({jittered_box({{0, 0, 0}, {0.1, 0.1, 0.05}}, {cells, cells, cells / 2})},
                      "neo_hookean");
  p.body.surface = boundary_surface(p.body.levels[0]).surface;
  p.body.damping.mass = 40;
  p.gravity = {0, 0, -g};
  p.contact.obstacles = {{PlaneOptions{}, {}, {}}};
  p.integration.integrator = {integrator}, p.integration.substeps = {1};
  p.integration.macro_step = macro_step;
  p.integration.implicit.relative_residual = 1e-10;
  return p;
}

/// The sum of pressure times area over points, those with use(point).
template <class B, class Use>
double normal_force(const Simulation<B>& s, const Problem& p, const Use& use) {
  const auto pressure = s.contact_pressure();
  const auto x = s.surface_positions();
  EXPECT_EQ(pressure.size(), x.size());
  double sum = 0;
  for (const auto& t : p.body.surface->triangles) {
    const auto at = [&](std::size_t k) { return x[static_cast<std::size_t>(t[k])]; };
    const double third = (at(1) - at(0)).cross(at(2) - at(0)).norm() / 6;
    for (const int v : t)
      if (use(v)) sum += third * pressure[static_cast<std::size_t>(v)];
  }
  return sum;
}
constexpr auto all_points = [](int) { return true; };

template <class B>
class ContactPressureOn : public testing::Test {};
TYPED_TEST_SUITE(ContactPressureOn, EachBackend);

TYPED_TEST(ContactPressureOn, TimesAreaIsTheObstaclesForce) {
  const std::vector<std::pair<std::string, std::optional<double>>> methods = {
      {"symplectic_euler", {}}, {"implicit_euler", 5e-3}};
  for (const auto& [integrator, step] : methods) {
    SCOPED_TRACE(integrator);
    const Problem p = block_on_a_plane(integrator, step);
    Simulation<TypeParam> s(p);
    for (const double pressure : s.contact_pressure()) EXPECT_EQ(pressure, 0);
    while (s.time() < 0.3) advance(s, 1);
    const double force = s.wrenches()[0].force[2];
    ASSERT_GT(force, 0.1);
    EXPECT_NEAR(normal_force(s, p, all_points), force,
                round_off<typename TypeParam::Real>(500, force));
    const auto pressure = s.contact_pressure();
    for (std::size_t i = 0; i < pressure.size(); ++i) {
      EXPECT_GE(pressure[i], 0);
      if (p.body.surface->vertices[i].z() > 0.001) {
        EXPECT_EQ(pressure[i], 0) << i;
      }
    }
  }
}

// Friction is a force along the plane: it is no part of the pressure.
TEST(ContactPressure, IsOfNormalForcesAlone) {
  Problem p = block_on_a_plane();
  p.contact.obstacles[0].friction = 0.6;
  p.gravity = g * Point(0.5, 0, -1);
  Simulation<Host> s(p);
  while (s.time() < 0.3) advance(s, 1);
  const Point force = s.wrenches()[0].force;
  ASSERT_GT(std::abs(force[0]), 0.1 * force[2]);
  EXPECT_NEAR(normal_force(s, p, all_points), force[2], 1e-9 * force[2]);
}

// A ball that is pressed in, also where faces touch it: the pressure is near it, and the force
// along its axis is less than the sum of the normal forces.
TEST(ContactPressure, IsWhereTheToolIs) {
  for (const auto& [rule, reach] : {std::pair("never", 1e-3), std::pair("always", 0.025)}) {
    SCOPED_TRACE(rule);
    Problem p = block_on_a_plane("symplectic_euler", {}, 8);
    p.gravity = Point::Zero(), p.integration.substeps = {0};  // more of them where it stiffens
    p.body.fixed = {Box{{-1, -1, -1}, {1, 1, 0.001}}};
    constexpr double radius = 0.03;
    const Point start(0.052, 0.048, 0.05 + radius + 5e-4), way(0, 0, -4.5e-3);
    p.contact.obstacles = {
        {SphereOptions{start, radius}, {}, PathMotion{{{0, Point(Point::Zero())}, {0.1, way}}}}};
    p.contact.whole_surface = rule;
    Simulation<Host> s(p);
    while (s.time() < 0.2) advance(s, 1);
    const double force = -s.wrenches()[0].force[2], sum = normal_force(s, p, all_points);
    ASSERT_GT(force, 0.01);
    EXPECT_GE(sum, force);
    EXPECT_LE(sum, 1.5 * force);
    const auto pressure = s.contact_pressure();
    const auto x = s.surface_positions();
    for (std::size_t i = 0; i < pressure.size(); ++i)
      if ((x[i] - start - way).norm() > radius + reach) {
        EXPECT_EQ(pressure[i], 0) << i;
      }
  }
}

Body cube_in(const Box& box, int cells) {
  Body body = body_of({box_mesh(box, {cells, cells, cells})}, "neo_hookean").body;
  body.surface = boundary_surface(body.levels[0]).surface;
  return body;
}
const Box low_cube{{0, 0, 0}, {0.06, 0.06, 0.06}};

// Two bodies press each other with the same force, on points of different areas.
TEST(ContactPressure, OfTwoBodiesIsMutual) {
  constexpr double bottom = 0.06 + 1e-5;
  Body lower = cube_in(low_cube, 3),
       upper = cube_in({{0.01, 0.01, bottom}, {0.05, 0.05, bottom + 0.04}}, 4);
  lower.fixed = {Box{{-1, -1, -1}, {1, 1, 0.001}}};
  Problem p;
  p.body = join_bodies({{"lower", lower}, {"upper", upper}});
  p.body.regions.at("lower").damping.mass = p.body.regions.at("upper").damping.mass = 40;
  p.gravity = {0, 0, -g};
  p.integration.substeps = {1};
  Simulation<Host> s(p);
  while (s.time() < 0.3) advance(s, 1);
  const double force = s.wrenches()[1].force[2];
  ASSERT_GT(force, 0.1);
  const int first = p.body.parts[0].points;
  const double of_lower = normal_force(s, p, [&](int v) { return v < first; }),
               of_upper = normal_force(s, p, [&](int v) { return v >= first; });
  EXPECT_NEAR(of_lower, of_upper, 1e-9 * force);
  EXPECT_NEAR(of_upper, force, 0.05 * force);
}

// What holds a point does not press it.
TEST(ContactPressure, OfAttachmentsIsZero) {
  constexpr double gap = 1e-4, bottom = 0.06 + gap;
  Body lower = cube_in(low_cube, 3),
       upper = cube_in({{0, 0, bottom}, {0.06, 0.06, bottom + 0.06}}, 4);
  upper.fixed = {Box{{-1, -1, 0.119}, {1, 1, 1}}};
  Problem p;
  p.body = join_bodies({{"lower", lower}, {"upper", upper}});
  p.contact.attachments = {{.body = "lower", .to = "upper", .reach = 2 * gap, .stiffness = 300.0}};
  p.gravity = {0, 0, -g};
  Simulation<Host> s(p);
  while (s.time() < 0.02) advance(s, 1);
  ASSERT_GT(s.wrenches()[0].force.norm(), 0.01);
  const auto pressure = s.contact_pressure();
  ASSERT_FALSE(pressure.empty());
  EXPECT_EQ(*std::ranges::max_element(pressure), 0);
}

TEST(ContactPressure, WithoutContactHasNoValues) {
  Problem p = small_cube("neo_hookean");
  EXPECT_TRUE(Simulation<Host>(p).contact_pressure().empty());
  p.body.surface = boundary_surface(p.body.levels[0]).surface;
  EXPECT_TRUE(Simulation<Host>(p).contact_pressure().empty());
}

// A restored simulation has the pressure that the saved one had.
TEST(ContactPressure, IsSavedWithTheState) {
  const Problem p = block_on_a_plane();
  Simulation<Host> s(p), other(p);
  while (s.time() < 0.3) advance(s, 1);
  other.restore(s.save());
  EXPECT_GT(normal_force(other, p, all_points), 0.1);
  EXPECT_EQ(other.contact_pressure(), s.contact_pressure());
}

TEST(AreasOfPoints, AddUpToTheSurface) {
  const TriangleSurface surface = sphere_surface({0, 0, 0}, 0.05, 2);
  const auto area = areas_of_points(surface);
  EXPECT_NEAR(std::accumulate(area.begin(), area.end(), 0.0), surface_area(surface), 1e-15);
  const TriangleSurface one{{Point(0, 0, 0), Point(3, 0, 0), Point(0, 2, 0), Point(5, 5, 5)},
                            {{{0, 1, 2}}}};
  const auto of_one = areas_of_points(one);
  ASSERT_EQ(of_one.size(), 4u);
  for (std::size_t p = 0; p < 4; ++p) EXPECT_EQ(of_one[p], p < 3 ? 1 : 0) << p;
}

}  // namespace
