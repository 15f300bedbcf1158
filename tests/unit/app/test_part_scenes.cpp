// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <plica/drivers/app/output/border_contact.hpp>
#include <plica/drivers/app/scene/key_list.hpp>
#include <plica/drivers/body/masses.hpp>
#include <plica/drivers/run/simulation.hpp>
#include <plica/drivers/run/validate.hpp>
#include <plica/meshes/boundary_triangles.hpp>

#include "support/backends.hpp"
#include "support/refusal.hpp"
#include "unit/app/scene_text.hpp"

// Scenes with levels that cover a part of the body.
namespace plica::app::test {
namespace {

std::string scene_with(const std::string& levels) {
  return "duration: 1 s\ngravity: [0, 0, -9.81]\nbody:\n  levels:\n" + levels +
         "  material: {young_modulus: 50 kPa}\n"
         "  fixed: [{box: {min: [0, 0, 0], max: [0, 1, 1]}}]\n"
         "integration: {cycle: single}\n";
}

const std::string whole = "    - {box: {size: [0.4, 0.1, 0.1], cells: [12, 3, 3]}}\n";
const std::string ball = "{sphere: {centre: [0.2, 0.05, 0], radius: 6 cm}}";

TEST(PartScenes, RefineAPartAndRun) {
  const Scene scene = scene_of(scene_with("    - {refine: " + ball + "}\n" + whole));
  ASSERT_EQ(scene.problem.body.levels.size(), 1u);
  EXPECT_EQ(scene.numbering.size(), 1u);
  EXPECT_TRUE(scene.warnings.empty());
  const TetMesh& mesh = scene.problem.body.levels.front();
  const auto fine = std::ranges::count(mesh.piece, 0);
  EXPECT_EQ(fine % 8, 0);
  EXPECT_EQ(std::ssize(mesh.tets), 6 * 12 * 3 * 3 + fine - fine / 8);
  const std::vector<PieceReport> pieces = piece_reports(mesh, {1000});
  ASSERT_EQ(pieces.size(), 2u);
  EXPECT_EQ(pieces[0].dropped, 0);
  EXPECT_EQ(pieces[1].dropped, fine / 8);
  EXPECT_NEAR(1000 * pieces[1].covered, pieces[0].mass, 1e-12 * pieces[0].mass);
  validate(scene.problem);
  Simulation<plica::test::Host> simulation(scene.problem);
  for (int i = 0; i < 20; ++i) EXPECT_FALSE(simulation.step_checked());
  // the beam's end sinks, its base stays
  const std::vector<Point> places = simulation.positions();
  for (std::size_t v = 0; v < places.size(); ++v) {
    if (mesh.vertices[v][0] == 0) {
      EXPECT_LE((places[v] - mesh.vertices[v]).norm(), 1e-15);
    }
    if (mesh.vertices[v][0] > 0.4 - 1e-9) {
      EXPECT_LT(places[v][2], mesh.vertices[v][2]);
    }
  }
}

TEST(PartScenes, NeedASurfaceOfTheirOwnForContactWithThemselves) {
  const auto said = [](const std::string& levels) {
    const Scene scene =
        scene_of(scene_with(levels + "  surface: {boundary: true}\n") + "contact: {self: true}\n");
    return plica::test::refusal([&] { validate(scene.problem); });
  };
  const std::string refused = said("    - {refine: " + ball + "}\n" + whole);
  EXPECT_NE(refused.find("expected body.surface: {file: SURFACE}, a closed surface of the body"),
            std::string::npos)
      << refused;
  EXPECT_EQ(said(whole).find("SURFACE"), std::string::npos);
}

// Touched at the border of the part, and two coarse edges from it
TEST(PartScenes, WarnOfContactAtABorder) {
  const Scene scene = scene_of(
      scene_with("    - {refine: {box: {min: [0, 0, 0], max: [0.2, 0.1, 0.1]}}}\n" + whole));
  const TetMesh& mesh = scene.problem.body.levels.front();
  const TriangleSurface surface = boundary_surface(mesh).surface;
  const auto warning = [&](double x) {
    BorderContact contact(mesh, surface);
    EXPECT_TRUE(contact.looks());
    std::vector<double> pressure(surface.vertices.size(), 0);
    contact.look(1, pressure);
    EXPECT_EQ(contact.warning(), "");
    for (std::size_t p = 0; p < pressure.size(); ++p)
      if (std::abs(surface.vertices[p][0] - x) < 1e-9) pressure[p] = 5;
    contact.look(2, pressure), contact.look(3, pressure);
    return contact.warning();
  };
  EXPECT_EQ(warning(0.2).find("contact: at 2 s something touches the body within a coarse edge"),
            0u);
  EXPECT_EQ(warning(0.1), "");
  const TetMesh one = scene_of(scene_with(whole)).problem.body.levels.front();
  EXPECT_FALSE(BorderContact(one, boundary_surface(one).surface).looks());
}

TEST(PartScenes, AMeshOfAPartAndAPartOfAMeshAreAlike) {
  const std::string part =
      "    - {box: {size: [0.2, 0.1, 0.1], cells: [12, 6, 6]}, covers: part}\n";
  const std::string of_whole =
      "    - {box: {size: [0.4, 0.1, 0.1], cells: [24, 6, 6]}, covers: {box: {min: [0, 0, 0], "
      "max: [0.2, 0.1, 0.1]}}}\n";
  const std::string refined = "    - {refine: {box: {min: [0, 0, 0], max: [0.2, 0.1, 0.1]}}}\n";
  const auto mesh_of = [](const std::string& levels) {
    return scene_of(scene_with(levels + whole)).problem.body.levels.front();
  };
  const TetMesh one = mesh_of(part);
  for (const TetMesh& other : {mesh_of(of_whole), mesh_of(refined)}) {
    EXPECT_EQ(other.tets.size(), one.tets.size());
    EXPECT_EQ(other.vertices.size(), one.vertices.size());
    EXPECT_EQ(other.followers.vertex.size(), one.followers.vertex.size());
  }
  EXPECT_EQ(one.followers.vertex.size(), 49u);
}

TEST(PartScenes, SeveralPartsAreOneLevel) {
  const Scene scene =
      scene_of(scene_with("    - {refine: {sphere: {centre: [0.2, 0.05, 0], radius: 2.5 cm}}}\n"
                          "    - {refine: {sphere: {centre: [0.2, 0.05, 0], radius: 9 cm}}}\n" +
                          whole + "    - {coarsen: 30}\n"),
               {"integration.cycle=him"});
  ASSERT_EQ(scene.problem.body.levels.size(), 1u);
  EXPECT_EQ(*std::ranges::max_element(scene.problem.body.levels.front().piece), 2);
}

TEST(PartScenes, OneOfSeveralBodiesMayHaveAPart) {
  const Scene scene = load_scene(
      parse_tree("duration: 1 s\nbodies:\n  left:\n    levels:\n"
                 "      - {refine: " +
                     ball +
                     "}\n"
                     "      - {box: {size: [0.4, 0.1, 0.1], cells: [12, 3, 3]}}\n"
                     "  right:\n    levels:\n"
                     "      - {box: {size: [0.4, 0.1, 0.1], cells: [6, 2, 2], origin: [0, 0, 1]}}\n"
                     "contact: {bodies: false}\nintegration: {cycle: single}\n",
                 "a.yaml"));
  ASSERT_EQ(scene.problem.body.levels.size(), 1u);
  const TetMesh& mesh = scene.problem.body.levels.front();
  EXPECT_EQ(mesh.piece.size(), mesh.tets.size());
  EXPECT_FALSE(mesh.followers.vertex.empty());
}

const std::string tool =
    "contact: {obstacles: [{name: tool, sphere: {centre: [0.1, 0.05, 0.13], "
    "radius: 2 cm}, velocity: [2, 0, 0]}]}\n";

TEST(PartScenes, FollowATool) {
  const Scene scene = scene_of(
      scene_with("    - {refine: {follows: {obstacle: tool, radius: 7 cm}}}\n" + whole) + tool);
  const Body& body = scene.problem.body;
  ASSERT_EQ(body.levels.size(), 1u);
  ASSERT_TRUE(body.following);
  EXPECT_EQ(std::ssize(body.levels.front().tets),
            6 * 12 * 3 * 3 + 7 * std::ssize(body.following->refined));
  EXPECT_FALSE(body.following->refined.empty());
  // the surface is as fine everywhere: two triangles on each of 24 x 6 cells of four sides, and of
  // 6 x 6 on two
  EXPECT_EQ(body.surface->triangles.size(), 2u * (4 * 24 * 6 + 2 * 6 * 6));
  validate(scene.problem);
  Simulation<plica::test::Host> simulation(scene.problem);
  while (simulation.time() < 0.05) EXPECT_FALSE(simulation.step_checked());
  EXPECT_GE(simulation.followed().moves, 1);
}

TEST(PartScenes, SayWhatTheyCannotFollow) {
  const auto error = [](const std::string& part) {
    return error_of(scene_with("    - {refine: " + part + "}\n" + whole) + tool);
  };
  EXPECT_EQ(
      error("{follows: {obstacle: tol, radius: 7 cm}}")
          .find("a.yaml:5: body.levels.0.refine.follows.obstacle: unknown obstacle 'tol'; did "
                "you mean 'tool'?"),
      0u);
  EXPECT_EQ(error("{follows: {obstacle: tool, radius: -7 cm}}")
                .find("a.yaml:5: body.levels.0.refine.follows.radius"),
            0u);
  EXPECT_NE(error("{follows: {obstacle: tool, radius: 7 cm}, sphere: {radius: 1 cm}}"), "no error");
}

TEST(PartScenes, SayWhatIsWrongAndWhere) {
  const auto error = [](const std::string& levels) { return error_of(scene_with(levels)); };
  EXPECT_EQ(
      error(whole + "    - {refine: " + ball + "}\n"),
      "a.yaml:6: body.levels.1.refine: the last level has none after it to refine; expected a "
      "coarser one of the whole body after it");
  EXPECT_EQ(
      error(whole + "    - {box: {size: [1, 1, 1], cells: [2, 2, 2]}, covers: part}\n"),
      "a.yaml:6: body.levels.1.covers: the last level covers a part; expected a coarser one of "
      "the whole body after it");
  EXPECT_EQ(error("    - {refine: {nearest: [0.2, 0.05, 0]}}\n" + whole),
            "a.yaml:5: body.levels.0.refine.nearest: one element is no part; expected sphere, box, "
            "half_space or region");
  EXPECT_EQ(error("    - {box: {size: [1, 1, 1], cells: [2, 2, 2]}, covers: all}\n" + whole),
            "a.yaml:5: body.levels.0.covers: expected part, or a map such as {sphere: {centre: "
            "[0, 0, 0], radius: 1 cm}}, got 'all'");
  EXPECT_EQ(error("    - {box: {size: [0.1, 0.1, 0.1], cells: [4, 4, 4]}, border: cut}\n" + whole),
            "a.yaml:5: body.levels.0.border: only a level with covers has one");
  EXPECT_EQ(error("    - {refine: " + ball + ", covers: part}\n" + whole),
            "a.yaml:5: body.levels.0 has refine and covers; expected one: refine chooses the part");
  EXPECT_EQ(error("    - {refine: {sphere: {centre: [3, 0, 0], radius: 1 cm}}}\n" + whole)
                .find("a.yaml:5: body.levels.0.refine: the sphere of radius 0.01 m at [3, 0, 0] m "
                      "selects no element's centroid on level 1"),
            0u);
  EXPECT_EQ(error("    - {box: {size: [0.4, 0.1, 0.1], cells: [24, 6, 6]}, covers: part}\n" + whole)
                .find("a.yaml:5: body.levels.0: the part has no border"),
            0u);
  EXPECT_EQ(error("    - {box: {size: [0.2, 0.1, 0.1], cells: [12, 6, 6], origin: [0.3, 0, 0]}, "
                  "covers: part}\n" +
                  whole)
                .find("a.yaml:5: body.levels.0: the part sticks out of the coarser level: its "
                      "vertex at [0."),
            0u);
}

TEST(PartScenes, AreInTheSchema) {
  const auto& level =
      scene_schema()["properties"]["body"]["properties"]["levels"]["items"]["properties"];
  EXPECT_EQ(level["covers"]["anyOf"][0]["const"], "part");
  EXPECT_TRUE(level["covers"]["anyOf"][1]["properties"].contains("sphere"));
  EXPECT_TRUE(level["refine"]["properties"].contains("box"));
  EXPECT_TRUE(level["refine"]["properties"]["follows"]["properties"].contains("radius"));
}

}  // namespace
}  // namespace plica::app::test
