// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <plica/drivers/body/masses.hpp>
#include <plica/drivers/body/selection.hpp>
#include <plica/drivers/body/supports.hpp>
#include <plica/drivers/elastic/level_constants.hpp>
#include <plica/drivers/loads/assemble_loads.hpp>
#include <plica/drivers/run/compose_levels.hpp>
#include <plica/drivers/run/join_bodies.hpp>
#include <plica/drivers/run/simulation.hpp>
#include <plica/drivers/run/validate.hpp>
#include <plica/meshes/composite.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/refusal.hpp"
#include "support/simulate.hpp"

// Levels that cover a part of the body, as options of a problem.
namespace {

using namespace plica;
using namespace plica::test;

const BallSelection ball{{0.2, 0.05, 0}, 0.06};

/// A beam, and elements of it in eight.
Problem refined_beam() {
  Problem p = body_of({TetMesh(), box_mesh(beam_box, {12, 3, 3})});
  p.body.covers[0] = {ball, true};
  return p;
}

/// A beam, and elements of a finer mesh that is not nested in it.
Problem beam_with_part() {
  Problem p = body_of({jittered_box(beam_box, {28, 7, 7}), jittered_box(beam_box, {12, 3, 3})});
  p.body.covers[0] = {ball};
  return p;
}

TetMesh composite_of(Problem p) {
  compose_levels(p.body);
  EXPECT_EQ(p.body.levels.size(), 1u);
  EXPECT_TRUE(p.body.covers.empty());
  return p.body.levels.front();
}

Point centre_of_mass(const TetMesh& mesh, const std::vector<double>& mass) {
  Point sum = Point::Zero();
  for (std::size_t v = 0; v < mass.size(); ++v) sum += mass[v] * mesh.vertices[v];
  return sum / std::accumulate(mass.begin(), mass.end(), 0.);
}

TEST(PartLevels, KeepMassAndCentre) {
  const TetMesh mesh = composite_of(refined_beam());
  const std::vector<double> mass = lumped_masses(mesh, {1000});
  EXPECT_NEAR(std::accumulate(mass.begin(), mass.end(), 0.), 4, 1e-12);
  EXPECT_LE((centre_of_mass(mesh, mass) - Point(0.2, 0.05, 0.05)).norm(), 1e-13);
  for (const int v : mesh.followers.vertex) EXPECT_EQ(mass[static_cast<std::size_t>(v)], 0);
  double of_pieces = 0;
  for (const PieceReport& piece : piece_reports(mesh, {1000})) of_pieces += piece.mass;
  EXPECT_NEAR(of_pieces, 4, 1e-12);
}

TEST(PartLevels, AreReported) {
  Problem p = refined_beam();
  const Simulation<Host> s(p);
  ASSERT_EQ(s.levels().size(), 1u);
  const LevelReport& level = s.levels().front();
  EXPECT_EQ(level.kind, LevelKind::part);
  EXPECT_NEAR(level.mass, 4, 1e-6);
  ASSERT_EQ(level.pieces.size(), 2u);
  const TetMesh mesh = composite_of(p);
  EXPECT_EQ(level.pieces[0].tets, std::ranges::count(mesh.piece, 0));
  EXPECT_EQ(level.pieces[0].tets + level.pieces[1].tets, std::ssize(mesh.tets));
  EXPECT_EQ(level.pieces[0].followers, std::ssize(mesh.followers.vertex));
  EXPECT_EQ(level.pieces[1].followers, 0);
  EXPECT_EQ(level.pieces[1].cut, 0);
  EXPECT_EQ(level.pieces[1].least_filled, 1);

  const Simulation<Host> other(beam_with_part());
  EXPECT_GT(other.levels().front().pieces[1].cut, 10);
  EXPECT_GE(other.levels().front().pieces[1].least_filled, 0.02);
}

// A free body falls without deforming, followers too.
TEST(PartLevels, FallFreely) {
  for (Problem p : {refined_beam(), beam_with_part()}) {
    p.gravity = Point(0, 0, -10);
    Simulation<Host> s(p);
    advance(s, 50);
    const Point expected = 50 * s.macro_step() * p.gravity;
    for (const Point& v : s.velocities()) EXPECT_LE((v - expected).norm(), 1e-9 * expected.norm());
  }
}

TEST(PartLevels, SupportsAndLoadsChooseNoFollower) {
  Problem p = refined_beam();
  p.body.fixed = {BallSelection{{0.2, 0.05, 0}, 0.1}};
  p.body.loads = {{Box{{0, 0, 0}, {0.4, 0.1, 0}}, Traction{{0, 0, 10}}, {}}};
  const TetMesh mesh = composite_of(p);
  const std::vector<char> follows = follows_others(mesh);
  const auto free = [&](int v) { return follows[static_cast<std::size_t>(v)] == 0; };
  EXPECT_TRUE(
      std::ranges::all_of(select_vertices(mesh, p.body.fixed[0].where, {"body.fixed.0", 0}), free));
  const Supports supports = find_supports(p.body, mesh, 0);
  for (const int v : mesh.followers.vertex)
    EXPECT_EQ(supports.constrained[static_cast<std::size_t>(v)], 0);
  // the nearest one to a follower is another vertex
  const int follower = mesh.followers.vertex.front();
  const std::vector<int> nearest = select_vertices(
      mesh, NearestSelection{mesh.vertices[static_cast<std::size_t>(follower)]}, {"", 0});
  ASSERT_EQ(nearest.size(), 1u);
  EXPECT_TRUE(free(nearest.front()));

  p.body.fixed.clear();
  const LevelConstants constants = level_constants(p.body, mesh, Point::Zero(), 0);
  const std::vector<AssembledLoad> loads = assemble_loads(p.body, mesh, constants, 0, {});
  Point sum = Point::Zero(), moment = Point::Zero();
  for (std::size_t i = 0; i < loads[0].vertex.size(); ++i) {
    const int v = loads[0].vertex[i];
    EXPECT_TRUE(free(v));
    sum += loads[0].force[i];
    moment += mesh.vertices[static_cast<std::size_t>(v)].cross(loads[0].force[i]);
  }
  // 10 Pa on 0.4 m x 0.1 m, whose centre is at (0.2, 0.05, 0)
  EXPECT_LE((sum - Point(0, 0, 0.4)).norm(), 1e-13);
  EXPECT_LE((moment - Point(0.2, 0.05, 0).cross(Point(0, 0, 0.4))).norm(), 1e-13);
}

TEST(PartLevels, TractionsOnCutElementsAreRefused) {
  Problem p = beam_with_part();
  p.body.loads = {{Box{{0, 0, 0}, {0.4, 0.1, 0}}, Traction{{0, 0, 10}}, {}}};
  EXPECT_NE(refusal([&] { Simulation<Host>{p}; }).find("is of an element that a finer part cuts"),
            std::string::npos);
}

TEST(PartLevels, OfSeveralBodiesAreJoined) {
  Problem one = refined_beam();
  compose_levels(one.body);
  Body other = body_of({box_mesh({{0, 0, 1}, {0.4, 0.1, 1.1}}, {4, 1, 1})}).body;
  const Body both = join_bodies({{"left", other}, {"right", refined_beam().body}});
  const TetMesh& mesh = both.levels.front();
  validate_mesh(mesh, 0);
  const auto before = static_cast<int>(other.levels.front().vertices.size());
  const TetMesh& own = one.body.levels.front();
  ASSERT_EQ(mesh.followers.vertex.size(), own.followers.vertex.size());
  EXPECT_EQ(mesh.followers.vertex.front(), own.followers.vertex.front() + before);
  EXPECT_EQ(mesh.followers.of.back()[2], own.followers.of.back()[2] + before);
  EXPECT_EQ(mesh.piece.size(), mesh.tets.size());
  EXPECT_EQ(mesh.inner_faces.size(), own.inner_faces.size());
}

TEST(PartLevels, AreRefusedWhereTheyCannotBe) {
  Problem last = refined_beam();
  last.body.covers = {{1, {ball}}};
  EXPECT_EQ(refusal([&] { validate(last); }).find("body.levels.1.covers: the last level"), 0u);

  Problem cycle = refined_beam();
  cycle.body.levels.push_back(box_mesh(beam_box, {8, 2, 2}));
  cycle.integration.cycle = "rsv";
  EXPECT_NE(refusal([&] { validate(cycle); }).find("which cycle rsv cannot integrate"),
            std::string::npos);

  Problem nothing = refined_beam();
  nothing.body.covers[0].where = BallSelection{{3, 0, 0}, 0.1};
  EXPECT_EQ(refusal([&] { validate(nothing); }).find("body.levels.0.refine: "), 0u);

  Problem whole = refined_beam();
  whole.body.covers[0].where = BallSelection{{0.2, 0, 0}, 3};
  EXPECT_EQ(refusal([&] { validate(whole); }).find("body.levels.0: the part has no border"), 0u);

  Problem silent = beam_with_part();
  silent.body.covers.clear();
  silent.body.levels[0] = box_mesh({{0, 0, 0}, {0.2, 0.1, 0.1}}, {12, 6, 6});
  EXPECT_NE(refusal([&] { validate(silent); }).find("the key covers of the level"),
            std::string::npos);
}

TEST(PartLevels, MeshesWithWrongFollowersAreRefused) {
  const TetMesh mesh = composite_of(refined_beam());
  const auto why = [&](const auto& damage) {
    TetMesh wrong = mesh;
    damage(wrong);
    return refusal([&] { validate_mesh(wrong, 0); });
  };
  EXPECT_EQ(why([](TetMesh&) {}), "");
  EXPECT_NE(why([](TetMesh& m) { m.followers.weight[3][0] += 0.1; }).find("have the sum"),
            std::string::npos);
  EXPECT_NE(why([](TetMesh& m) {
              m.followers.of[3][0] = m.followers.vertex[0];
            }).find("expected one that follows no other"),
            std::string::npos);
  EXPECT_NE(why([](TetMesh& m) {
              std::swap(m.followers.vertex[0], m.followers.vertex[1]);
            }).find("ascending"),
            std::string::npos);
  EXPECT_NE(why([](TetMesh& m) { m.followers.of.pop_back(); }).find("expected as many"),
            std::string::npos);
  EXPECT_NE(why([](TetMesh& m) { m.piece.pop_back(); }).find("expected all or none"),
            std::string::npos);
}

}  // namespace
