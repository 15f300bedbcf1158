// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>
#include <plica/drivers/elastic/fibres.hpp>
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

Problem fibrous(const std::string& element, const FibreOptions& fibres,
                const std::string& law = "costa") {
  Problem p = body_of({jittered_box(decimetre, {3, 3, 3})}, law);
  p.body.element = {element}, p.body.material.fibres = fibres;
  return p;
}

TEST(Fibres, OfElementsAreThoseOfTheBodyWhereTheyAreAlike) {
  const FibreOptions same{{2, 2, 1}, Point(-2, 1, 2)};
  for (const char* law : {"costa", "transversely_isotropic", "holzapfel_gasser_ogden"})
    for (const char* element : {"linear", "nodal"}) {
      Problem p = fibrous(element, {.field = "f", .sheet_field = "s"}, law);
      TetMesh& mesh = p.body.levels[0];
      for (std::size_t t = 0; t < mesh.tets.size(); ++t) {  // of any length and sign
        mesh.tet_vectors["f"].push_back((t % 2 == 0 ? 1 : -3) * same.axis);
        mesh.tet_vectors["s"].push_back((t % 3 == 0 ? 1 : -0.1) * *same.sheet);
      }
      LevelProbe<Host> one(fibrous(element, same, law)), each(p);
      const auto u = random_field(one.vertices(), 4e-3, 3),
                 d = random_field(one.vertices(), 1e-3, 4);
      const auto near = [&](const std::vector<Point>& a, const std::vector<Point>& b) {
        double size = 0;
        for (const Point& f : a) size = std::max(size, f.norm());
        for (std::size_t i = 0; i < a.size(); ++i)
          EXPECT_LE((a[i] - b[i]).norm(), 1e-12 * size) << law << ", " << element;
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
    const Eigen::Matrix3d R =
        Eigen::AngleAxisd(turn / 4, Eigen::Vector3d::UnitZ()).toRotationMatrix();
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
  Problem p =
      body_of({jittered_box(decimetre, {5, 5, 5}), jittered_box(decimetre, {2, 2, 2})}, "costa");
  p.body.material.fibres = FibreOptions{.sheet = Point::UnitZ(), .field = "f"};
  TetMesh& fine = p.body.levels[0];
  const auto middle = [](const TetMesh& mesh, std::size_t t) {
    Point sum = Point::Zero();
    for (const int v : mesh.tets[t]) sum += mesh.vertices[static_cast<std::size_t>(v)];
    return Point(sum / 4);
  };
  const auto direction = [](const Point& x) { return Point(1, 10 * x[0], 0).normalized(); };
  for (std::size_t t = 0; t < fine.tets.size(); ++t)
    fine.tet_vectors["f"].push_back(2 * direction(middle(fine, t)));
  const TetMesh& coarse = p.body.levels[1];
  const auto of_coarse = element_fibres(p.body, coarse, 1);
  ASSERT_EQ(of_coarse.size(), coarse.tets.size());
  for (std::size_t t = 0; t < coarse.tets.size(); ++t) {
    EXPECT_LE((of_coarse[t][0] - direction(middle(coarse, t))).norm(), 0.2);
    EXPECT_NEAR(of_coarse[t][0].dot(of_coarse[t][1]), 0, 1e-12);
  }
}

TEST(Fibres, OfALevelAloneAreThoseThatItHasBesideLevel0) {
  Problem p =
      body_of({jittered_box(decimetre, {3, 3, 3}), jittered_box(decimetre, {2, 2, 2})}, "costa");
  p.body.material.fibres = FibreOptions{.sheet = Point::UnitZ(), .field = "f"};
  TetMesh &fine = p.body.levels[0], &coarse = p.body.levels[1];
  for (std::size_t t = 0; t < fine.tets.size(); ++t)
    fine.tet_vectors["f"].push_back(Point(1, static_cast<double>(t), 0));
  coarse.tet_vectors["own"].assign(coarse.tets.size(), Point::UnitY());
  fine.tet_vectors["own"].assign(fine.tets.size(), Point::UnitX());
  const auto beside = element_fibres(p.body, coarse, 1);
  fields_to_levels(p.body);
  EXPECT_EQ(coarse.tet_vectors.at("own")[0], Point(Point::UnitY())) << "a level's own field stays";
  Body alone = p.body;
  alone.levels.erase(alone.levels.begin());
  EXPECT_EQ(element_fibres(alone, alone.levels[0], 0), beside);
}

constexpr double inner = 0.02, outer = 0.05;

/// A quarter of a pipe: the temperature between its walls is the logarithm of the radius, between
/// its ends the angle.
TetMesh quarter_of_a_pipe(const std::array<int, 3>& cells) {
  TetMesh mesh = box_mesh({{inner, 0, 0}, {outer, turn / 4, 0.03}}, cells);
  for (Point& p : mesh.vertices) p = {p[0] * std::cos(p[1]), p[0] * std::sin(p[1]), p[2]};
  return mesh;
}

double worst_angle(const Body& body, int level, const std::function<Point(const Point&)>& known) {
  const TetMesh& mesh = body.levels[static_cast<std::size_t>(level)];
  const auto fibres = element_fibres(body, mesh, level);
  double worst = 0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    Point middle = Point::Zero();
    for (const int v : mesh.tets[t]) middle += mesh.vertices[static_cast<std::size_t>(v)] / 4;
    worst = std::max(worst, fibres[t][0].cross(known(middle)).norm());
  }
  return worst;
}

TEST(Fibres, FromOneSetToAnotherFollowTheFlowBetweenThem) {
  Problem p = body_of({quarter_of_a_pipe({8, 16, 3}), quarter_of_a_pipe({3, 6, 2})},
                      "transversely_isotropic");
  const auto radial = [](const Point& x) { return Point(x[0], x[1], 0).normalized(); };
  const auto around = [](const Point& x) { return Point(-x[1], x[0], 0).normalized(); };
  const Selection first_end = HalfSpaceSelection{Point::Zero(), Point::UnitY()},
                  last_end = HalfSpaceSelection{Point::Zero(), Point::UnitX()};
  p.body.material.fibres = FibreOptions{.from = first_end, .to = last_end};
  EXPECT_LT(worst_angle(p.body, 0, around), 0.1);
  EXPECT_LT(worst_angle(p.body, 1, around), 0.3) << "of the nearest element of level 0";
  TetMesh& fine = p.body.levels[0];
  // sets that the coarse mesh does not have
  for (std::size_t v = 0; v < fine.vertices.size(); ++v) {
    const double r = fine.vertices[v].head<2>().norm();
    if (r < inner * 1.0001) fine.vertex_sets["inside"].push_back(static_cast<int>(v));
    if (r > outer * 0.9999) fine.vertex_sets["outside"].push_back(static_cast<int>(v));
  }
  p.body.material.fibres =
      FibreOptions{.from = GroupSelection{"inside"}, .to = GroupSelection{"outside"}};
  EXPECT_LT(worst_angle(p.body, 0, radial), 0.15);
  EXPECT_LT(worst_angle(p.body, 1, radial), 0.3);
  Body fields = p.body;
  flows_to_fields(fields, "f");
  EXPECT_FALSE(fields.material.fibres->from);
  for (const int level : {0, 1})
    EXPECT_EQ(worst_angle(fields, level, radial), worst_angle(p.body, level, radial));
  EXPECT_EQ(refusal([&] { Simulation<Host> simulation(p); }), "");
}

// Straight from face to face, whatever the mesh; where a whole element lies in a set its neighbours
// say
TEST(Fibres, OfAFlowThroughABoxAreStraight) {
  Problem p = body_of({jittered_box(decimetre, {4, 4, 4})}, "transversely_isotropic");
  p.body.material.fibres =
      FibreOptions{.from = Box{{-1, -1, -1}, {1, 1, 0}}, .to = Box{{-1, -1, 0.07}, {1, 1, 1}}};
  EXPECT_LT(worst_angle(p.body, 0, [](const Point&) { return Point(0, 0, 1); }), 0.3);
  p.body.material.fibres->to = Box{{-1, -1, 0.1}, {1, 1, 1}};
  EXPECT_LT(worst_angle(p.body, 0, [](const Point&) { return Point(0, 0, 1); }), 1e-6);
}

TEST(Fibres, BetweenSetsThatAreNotThereAreRefused) {
  Problem p = fibrous("linear", {.sheet = Point::UnitZ()});
  FibreOptions& o = *p.body.material.fibres;
  const auto refused = [&] { return refusal([&] { Simulation<Host> simulation(p); }); };
  o.from = Box{{-1, -1, -1}, {0, 1, 1}};
  EXPECT_EQ(
      refused(),
      "body.fibres.to is missing; fibres run from one set of vertices to another, expected both");
  o.to = GroupSelection{"apex"};
  EXPECT_NE(refused().find("body.fibres.to: unknown group on level 0 'apex'"), std::string::npos)
      << refused();
  o.to = Box{{-1, -1, -1}, {1, 0, 1}};
  EXPECT_NE(refused().find("of level 0 is in `from` as well; expected sets apart"),
            std::string::npos)
      << refused();
  o.to = Box{{5, 5, 5}, {6, 6, 6}};
  EXPECT_NE(refused().find("body.fibres.to: the box from [5, 5, 5]"), std::string::npos)
      << refused();
  TetMesh& mesh = p.body.levels[0];
  const TetMesh other = box_mesh({{1, 0, 0}, {1.1, 0.1, 0.1}}, {2, 2, 2});
  const int before = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (auto tet : other.tets) {
    for (int& v : tet) v += before;
    mesh.tets.push_back(tet);
  }
  o.to = Box{{0.1, -1, -1}, {0.2, 1, 1}};
  EXPECT_NE(refused().find("touches only one of `from` and `to`, or none"), std::string::npos)
      << refused();
}

TEST(Fibres, FromFieldsThatAreNotThereAreRefused) {
  Problem p = fibrous("linear", {.sheet = Point::UnitZ(), .field = "fiber"});
  const auto refused = [&] { return refusal([&] { Simulation<Host> simulation(p); }); };
  EXPECT_EQ(refused(),
            "body.fibres.field: the mesh of level 0 has no field of vectors; expected 'fiber' "
            "among those of its cells "
            "or points");
  TetMesh& mesh = p.body.levels[0];
  mesh.tet_vectors["fibre"].assign(mesh.tets.size(), Point::UnitX());
  EXPECT_EQ(refused(),
            "body.fibres.field: unknown field of vectors of the mesh of level 0 'fiber'; did you "
            "mean 'fibre'? (choices: "
            "fibre)");
  p.body.material.fibres->field = "fibre";
  EXPECT_EQ(refused(), "");
  mesh.tet_vectors["fibre"][7].setZero();
  EXPECT_EQ(refused(),
            "body.fibres.field: field 'fibre' has length 0 at element 7 of level 0; expected a "
            "direction at every "
            "element");
}

}  // namespace
