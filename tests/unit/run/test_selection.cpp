// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/core/error.hpp>
#include <plica/drivers/body/selection.hpp>
#include <plica/meshes/generators.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/refusal.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// Parts of a body that are chosen by shape, by name or by place.
namespace {

using namespace plica;
using namespace plica::test;

const Selecting who{"body.fixed.2", 1};
const TetMesh cube = jittered_box(decimetre, {4, 4, 4});

template <class Wanted>
void expect_chosen(const TetMesh& mesh, const Selection& selection, const Wanted& wanted) {
  const auto chosen = select_vertices(mesh, selection, who);
  std::vector<int> want;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    if (wanted(mesh.vertices[v])) want.push_back(static_cast<int>(v));
  EXPECT_EQ(chosen, want);
  EXPECT_FALSE(want.empty());
  EXPECT_LT(want.size(), mesh.vertices.size());
}

TEST(Selection, ByShape) {
  expect_chosen(cube, Box{{0, 0, 0}, {0.1, 0.05, 0.1}},
                [](const Point& p) { return p[1] <= 0.05 + 1e-9; });
  expect_chosen(cube, BallSelection{{0, 0, 0}, 0.06},
                [](const Point& p) { return p.norm() <= 0.06; });
  expect_chosen(cube, HalfSpaceSelection{{0, 0, 0}, {0, 0, 1}},
                [](const Point& p) { return p[2] == 0; });
  expect_chosen(cube, HalfSpaceSelection{{0, 0, 0.1}, {0, 0, -5}},
                [](const Point& p) { return p[2] == 0.1; });
  expect_chosen(cube, HalfSpaceSelection{{0.1, 0, 0}, {1, 1, 0}},
                [](const Point& p) { return p[0] + p[1] < 0.1 + 1e-9; });
}

// Files keep coordinates in single precision, and what is turned into place is rounded: a face is
// chosen by its own coordinates all the same.
TEST(Selection, OfAFaceForgivesRounding) {
  constexpr double top = 0.06;  // 1.3e-9 more than in single precision
  TetMesh mesh = box_mesh({{0, 0, 0}, {top, top, top}}, {3, 3, 3});
  for (Point& p : mesh.vertices) p = p.cast<float>().cast<double>();
  ASSERT_LT(bounding_box(mesh.vertices).max[2], top - 1e-9);
  const auto on_top = [](const Point& p) { return p[2] > top - 1e-3; };
  expect_chosen(mesh, HalfSpaceSelection{{0, 0, top}, {0, 0, -1}}, on_top);
  expect_chosen(mesh, Box{{0, 0, top}, {top, top, 1}}, on_top);
  EXPECT_EQ(select_triangles(mesh, Box{{0, 0, top}, {1, 1, 1}}, who).size(), 18u);
  EXPECT_NE(refusal([&] {
              select_vertices(mesh, HalfSpaceSelection{{0, 0, top + 1e-6}, {0, 0, -1}}, who);
            }).find("selects no vertex"),
            std::string::npos);
}

TEST(Selection, NearestIsOneVertexOnEveryLevel) {
  for (int cells : {2, 3, 5}) {
    const TetMesh mesh = box_mesh(decimetre, {cells, cells, cells});
    const auto chosen = select_vertices(mesh, NearestSelection{{0.09, 0.02, 0.3}}, who);
    ASSERT_EQ(chosen.size(), 1u);
    const double own =
        (mesh.vertices[static_cast<std::size_t>(chosen[0])] - Point(0.09, 0.02, 0.3)).norm();
    for (const Point& p : mesh.vertices)
      EXPECT_LE(own, (p - Point(0.09, 0.02, 0.3)).norm() + 1e-15);
  }
}

TEST(Selection, OfNothingSaysWhereTheMeshIs) {
  for (const Selection& nothing :
       {Selection(Box{{1, 1, 1}, {2, 2, 2}}), Selection(BallSelection{{1, 1, 1}, 0.1}),
        Selection(HalfSpaceSelection{{0, 0, -1}, {0, 0, 1}})}) {
    const std::string text = refusal([&] { select_vertices(cube, nothing, who); });
    EXPECT_NE(text.find("body.fixed.2: the "), std::string::npos) << text;
    EXPECT_NE(
        text.find(
            "selects no vertex on level 1, which reaches from [0, 0, 0] to [0.1, 0.1, 0.1] m"),
        std::string::npos)
        << text;
  }
}

TEST(Selection, UnknownNamesGetTheNearest) {
  TetMesh mesh = with_regions(cube, 0.05, "liver", "tumour");
  mesh.vertex_sets["left side"] = {0, 1};
  EXPECT_EQ(select_vertices(mesh, GroupSelection{"left side"}, who), (std::vector<int>{0, 1}));
  EXPECT_EQ(select_vertices(mesh, GroupSelection{"liver"}, who),
            select_vertices(mesh, RegionSelection{"liver"}, who));
  EXPECT_NE(refusal([&] {
              select_vertices(mesh, GroupSelection{"left sid"}, who);
            }).find("did you mean 'left side'?"),
            std::string::npos);
  const std::string set =
      refusal([&] { select_vertices(mesh, RegionSelection{"left side"}, who); });
  EXPECT_NE(set.find("unknown region on level 1 'left side'"), std::string::npos) << set;
  EXPECT_NE(refusal([&] {
              select_elements(mesh, GroupSelection{"left side"}, who);
            }).find("unknown region"),
            std::string::npos);
}

TEST(Selection, TrianglesNeedAllTheirVertices) {
  const auto top = select_triangles(cube, HalfSpaceSelection{{0, 0, 0.1}, {0, 0, -1}}, who);
  EXPECT_EQ(top.size(), 32u);
  for (const auto& t : top)
    for (int v : t) EXPECT_EQ(cube.vertices[static_cast<std::size_t>(v)][2], 0.1);
  const std::string text = refusal([&] { select_triangles(cube, NearestSelection{}, who); });
  EXPECT_NE(text.find("selects 1 vertices on level 1, but no boundary triangle"), std::string::npos)
      << text;
}

TEST(Regions, AreAddedBySelection) {
  TetMesh mesh = box_mesh(decimetre, {4, 4, 4});
  std::map<std::string, RegionOptions> regions;
  regions["low"].where = Box{{0, 0, 0}, {0.1, 0.1, 0.05}};
  regions["corner"].where = BallSelection{{0.1, 0.1, 0.1}, 0.04};
  add_regions(mesh, regions, 0);
  EXPECT_EQ(mesh.region_names, (std::vector<std::string>{"", "corner", "low"}));
  std::array<int, 3> count = {};
  for (std::size_t e = 0; e < mesh.tets.size(); ++e) {
    Point centroid = Point::Zero();
    for (int v : mesh.tets[e]) centroid += mesh.vertices[static_cast<std::size_t>(v)] / 4;
    const int want = centroid[2] <= 0.05                                ? 2
                     : (centroid - Point(0.1, 0.1, 0.1)).norm() <= 0.04 ? 1
                                                                        : 0;
    EXPECT_EQ(mesh.region[e], want);
    ++count[static_cast<std::size_t>(mesh.region[e])];
  }
  for (int n : count) EXPECT_GT(n, 0);
}

TEST(Regions, BySelectionMustNotOverlapOrHideTheMeshsOwn) {
  std::map<std::string, RegionOptions> regions;
  regions["a"].where = Box{{0, 0, 0}, {0.1, 0.1, 0.05}};
  regions["b"].where = Box{{0, 0, 0}, {0.05, 0.1, 0.1}};
  TetMesh mesh = cube;
  const std::string overlap = refusal([&] { add_regions(mesh, regions, 0); });
  EXPECT_NE(overlap.find("body.regions.b.where: element "), std::string::npos) << overlap;
  EXPECT_NE(overlap.find("belongs to region 'a' as well"), std::string::npos) << overlap;
  regions.erase("b");
  mesh = with_regions(cube, 0.05, "a", "rest");
  EXPECT_NE(refusal([&] { add_regions(mesh, regions, 0); }).find("has a region of that name"),
            std::string::npos);
}

// The same body, whether the mesh or a selection says where the stiff half is; and a region can be
// selected in its turn.
TEST(Regions, BySelectionActLikeTheMeshsOwn) {
  const auto body = [](bool selected) {
    TetMesh mesh = box_mesh(beam_box, {8, 2, 2});
    Problem p = body_of({selected ? mesh : with_regions(mesh, 0.2, "stiff", "soft")});
    if (selected) p.body.regions["stiff"].where = Box{{0, 0, 0}, {0.2, 0.1, 0.1}};
    p.body.regions["stiff"].young_modulus = 80e3;
    p.body.regions["stiff"].density = 2000;
    p.body.fixed = {RegionSelection{"stiff"}};
    p.gravity = {0, 0, -9.81};
    p.integration.macro_step = 1e-3;
    return p;
  };
  Simulation<Host> own(body(false)), selected(body(true));
  advance(own, 50), advance(selected, 50);
  EXPECT_DOUBLE_EQ(own.levels()[0].mass, selected.levels()[0].mass);
  EXPECT_LE(largest_difference(own.positions(), selected.positions()), 1e-12);
  EXPECT_GT(largest_difference(own.positions(), body(false).body.levels[0].vertices), 1e-3);
}

}  // namespace
