// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>
#include <plica/drivers/solver/set_up/fibres.hpp>
#include <plica/drivers/study/level_probe.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/refusal.hpp"

// Directions of fibres by rule and from fields, and what elements make of them.
namespace {

using namespace plica;
using namespace plica::test;

constexpr double turn = 2 * std::numbers::pi;

TEST(Fibres, WindRoundALine) {
  const FibreWinding winding{{1, 0, 0}, {0, 0, 2}, turn / 12};
  const auto [axis, sheet] = fibre_axes({.around = winding}, {3, 0, 7});
  EXPECT_LE((axis - Point(0, std::cos(turn / 12), std::sin(turn / 12))).norm(), 1e-12);
  EXPECT_LE((sheet - Point(0, -std::sin(turn / 12), std::cos(turn / 12))).norm(), 1e-12);
  EXPECT_NEAR(fibre_axes({.around = winding}, {1, 0, 5})[0].norm(), 1, 1e-12) << "on the line";
}

Problem fibrous(const std::string& element, const FibreOptions& fibres) {
  Problem p = body_of({jittered_box(decimetre, {3, 3, 3})}, "costa");
  p.body.element = {element}, p.body.material.fibres = fibres;
  return p;
}

TEST(Fibres, OfElementsAreThoseOfTheBodyWhereTheyAreAlike) {
  const FibreOptions same{{2, 2, 1}, Point(-2, 1, 2)};
  for (const char* element : {"linear", "nodal"}) {
    Problem p = fibrous(element, {.field = "f", .sheet_field = "s"});
    TetMesh& mesh = p.body.levels[0];
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {  // of any length and sign
      mesh.tet_vectors["f"].push_back((t % 2 == 0 ? 1 : -3) * same.axis);
      mesh.tet_vectors["s"].push_back((t % 3 == 0 ? 1 : -0.1) * *same.sheet);
    }
    LevelProbe<Host> one(fibrous(element, same)), each(p);
    const auto u = random_field(one.vertices(), 4e-3, 3), d = random_field(one.vertices(), 1e-3, 4);
    const auto near = [&](const std::vector<Point>& a, const std::vector<Point>& b) {
      double size = 0;
      for (const Point& f : a) size = std::max(size, f.norm());
      for (std::size_t i = 0; i < a.size(); ++i) EXPECT_LE((a[i] - b[i]).norm(), 1e-12 * size) << element;
    };
    near(one.force(u), each.force(u));
    near(one.stiffness(u, d), each.stiffness(u, d));
    EXPECT_NEAR(one.elastic_energy(u), each.elastic_energy(u), 1e-12 * one.elastic_energy(u));
  }
}

// Turned by a quarter about its line, a wound body is the same body
TEST(Fibres, RoundALineTurnWithIt) {
  const Box cube{{-0.05, -0.05, 0}, {0.05, 0.05, 0.1}};
  for (const char* element : {"linear", "nodal"}) {
    Problem p = body_of({box_mesh(cube, {4, 4, 4})}, "transversely_isotropic"), q = p;
    p.body.element = {element};
    p.body.material.fibres = FibreOptions{.around = FibreWinding{.angle = 0.5}};
    const Eigen::Matrix3d R = Eigen::AngleAxisd(turn / 4, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    q = p;
    for (Point& x : q.body.levels[0].vertices) x = R * x;
    LevelProbe<Host> here(p), turned(q);
    const auto u = random_field(here.vertices(), 2e-3, 5);
    std::vector<Point> v;
    for (const Point& d : u) v.push_back(R * d);
    const auto f = here.force(u), g = turned.force(v);
    for (std::size_t a = 0; a < f.size(); ++a) EXPECT_LE((R * f[a] - g[a]).norm(), 1e-9) << element;
    p.body.material.fibres = FibreOptions{.around = FibreWinding{.angle = -0.5}};
    EXPECT_GT((LevelProbe<Host>(p).force(u)[0] - f[0]).norm(), 1e-6) << "the other helix differs";
  }
}

TEST(Fibres, OfACoarserLevelAreThoseOfTheNearestElement) {
  Problem p = body_of({jittered_box(decimetre, {5, 5, 5}), jittered_box(decimetre, {2, 2, 2})}, "costa");
  p.body.material.fibres = FibreOptions{.sheet = Point::UnitZ(), .field = "f"};
  TetMesh& fine = p.body.levels[0];
  const auto middle = [](const TetMesh& mesh, std::size_t t) {
    Point sum = Point::Zero();
    for (const int v : mesh.tets[t]) sum += mesh.vertices[static_cast<std::size_t>(v)];
    return Point(sum / 4);
  };
  const auto direction = [](const Point& x) { return Point(1, 10 * x[0], 0).normalized(); };
  for (std::size_t t = 0; t < fine.tets.size(); ++t) fine.tet_vectors["f"].push_back(2 * direction(middle(fine, t)));
  const TetMesh& coarse = p.body.levels[1];
  const auto of_coarse = element_fibres(p.body, coarse, 1);
  ASSERT_EQ(of_coarse.size(), coarse.tets.size());
  for (std::size_t t = 0; t < coarse.tets.size(); ++t) {
    EXPECT_LE((of_coarse[t][0] - direction(middle(coarse, t))).norm(), 0.2);
    EXPECT_NEAR(of_coarse[t][0].dot(of_coarse[t][1]), 0, 1e-12);
  }
}

TEST(Fibres, FromFieldsThatAreNotThereAreRefused) {
  Problem p = fibrous("linear", {.sheet = Point::UnitZ(), .field = "fiber"});
  const auto refused = [&] { return refusal([&] { Simulation<Host> simulation(p); }); };
  EXPECT_EQ(refused(),
            "body.fibres.field: the mesh of level 0 has no field of vectors; expected 'fiber' among those of its cells "
            "or points");
  TetMesh& mesh = p.body.levels[0];
  mesh.tet_vectors["fibre"].assign(mesh.tets.size(), Point::UnitX());
  EXPECT_EQ(
      refused(),
      "body.fibres.field: unknown field of vectors of the mesh of level 0 'fiber'; did you mean 'fibre'? (choices: "
      "fibre)");
  p.body.material.fibres->field = "fibre";
  EXPECT_EQ(refused(), "");
  mesh.tet_vectors["fibre"][7].setZero();
  EXPECT_EQ(refused(),
            "body.fibres.field: field 'fibre' has length 0 at element 7 of level 0; expected a direction at every "
            "element");
}

}  // namespace
