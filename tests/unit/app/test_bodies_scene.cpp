// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <any>
#include <filesystem>
#include <fstream>
#include <plica/drivers/app/output/json_parts.hpp>
#include <plica/drivers/app/scene/load_scene.hpp>
#include <plica/kernels/contact/shapes.hpp>

#include "support/refusal.hpp"

// Scenes with several bodies.
namespace {

using namespace plica;
using namespace plica::app;
using test::refusal;

const std::string two = R"(
duration: 0.1
bodies:
  left:
    levels: [{box: {size: [1, 1, 1], cells: [2, 2, 2]}}, {box: {size: [1, 1, 1], cells: [1, 1, 1]}}]
    material: {model: st_venant_kirchhoff, young_modulus: 30 kPa}
    fixed: [{half_space: {normal: [0, 0, 1]}}]
    surface: {boundary: true}
  right:
    levels: [{box: {size: [1, 1, 1], cells: [2, 2, 2]}}]
    initial: {position: [2.5, 0.5, 0.5], velocity: [-1, 0, 0]}
    surface: {sphere: {radius: 0.4, subdivisions: 1}}
    material: {model: st_venant_kirchhoff}
contact: {friction: 0.2}
)";

Scene scene_of(const std::string& text) { return load_scene(parse_tree(text, "two.yaml")); }

std::string with(const std::string& from, const std::string& to) {
  std::string text = two;
  return text.replace(text.find(from), from.size(), to);
}

TEST(BodiesScene, IsOneBodyOfSeveralParts) {
  const Scene scene = scene_of(two);
  const Body& body = scene.problem.body;
  ASSERT_EQ(body.parts.size(), 2u);
  EXPECT_EQ(body.parts[0].name, "left");
  EXPECT_EQ(body.parts[0].points, 26);
  EXPECT_EQ(body.parts[1].points, 42);
  ASSERT_EQ(body.levels.size(), 2u);
  EXPECT_EQ(body.levels[0].vertices.size(), 54u);
  EXPECT_EQ(body.levels[1].vertices.size(), 8u + 27u);  // right repeats its one mesh
  EXPECT_EQ(body.regions.at("left").young_modulus, 30e3);
  EXPECT_EQ(body.levels[0].vertex_sets.at("left/fixed.0").size(), 9u);
  EXPECT_TRUE(body.levels[0].vertices[53].isApprox(Point(3, 1, 1)));
  EXPECT_EQ(scene.problem.contact.friction, 0.2);
  EXPECT_EQ(scene.levels.size(), 2u);
}

TEST(BodiesScene, HaveCoarseSpacesOfTheirOwn) {
  const std::string cube = "{box: {size: [1, 1, 1], cells: [4, 4, 4]}}",
                    of_left = "{box: {size: [1, 1, 1], cells: [1, 1, 1]}}";
  std::string text = with("levels: [{box: {size: [1, 1, 1], cells: [2, 2, 2]}}]",
                          "levels: [" + cube + ", {coarsen: 60}, {coarsen: 30}]");
  text.replace(text.find(of_left), of_left.size(), cube + ", {coarsen: 50}");
  const Body body = scene_of(text + "integration: {cycle: him}").problem.body;
  EXPECT_EQ(body.levels.size(), 2u);
  EXPECT_EQ(body.levels[1].vertices.size(), 2 * 125u);  // right repeats its one mesh
  EXPECT_EQ(*body.parts[0].coarsen, std::vector<int>{50});
  EXPECT_EQ(*body.parts[1].coarsen, (std::vector<int>{60, 30}));
  EXPECT_EQ(*body.coarsen, (std::vector<int>{110, 80}));
  const std::string many =
      refusal([&] { scene_of(text.replace(text.find("{coarsen: 60}"), 13, "{coarsen: 10}")); });
  EXPECT_NE(many.find("two.yaml:10: bodies.right.levels"), std::string::npos) << many;
}

TEST(BodiesScene, SaysWhatIsWrongAndWhere) {
  const auto said = [](const std::string& text) { return refusal([&] { scene_of(text); }); };
  EXPECT_NE(said(with("young_modulus", "young_modulos"))
                .find("two.yaml:6: bodies.left.material: unknown key"),
            std::string::npos)
      << said(with("young_modulus", "young_modulos"));
  EXPECT_NE(said(with("normal: [0, 0, 1]", "point: [0, 0, -5]")).find("bodies.left.fixed.0"),
            std::string::npos);
  EXPECT_NE(said(with("{sphere: {radius: 0.4, subdivisions: 1}}", "{file: none.obj}"))
                .find("two.yaml:12:"),
            std::string::npos);
  EXPECT_NE(said(with("    surface: {sphere", "    #surface: {sphere"))
                .find("bodies.right: it has no surface"),
            std::string::npos);
  EXPECT_NE(said(two + "body: {levels: [{box: {size: [1, 1, 1], cells: [1, 1, 1]}}]}")
                .find("only one of body, bodies"),
            std::string::npos);
  EXPECT_NE(said("duration: 1\nbodies: {}").find("at least one body"), std::string::npos);
}

// What one of them says of its steps holds for all, over what the scene says
TEST(BodiesScene, TakeTheStepsOfEachIfTheyAreTheSame) {
  const auto both = [](const std::string& left, const std::string& right) {
    const std::string line = "\n    integration: {";
    std::string text = two + "integration: {safety: 0.8, macro_step: 2 ms, him: {sigma: 0.7}}\n";
    text.replace(text.find("\n    fixed:"), 0, left.empty() ? "" : line + left + "}");
    return text.replace(text.find("\n    initial:"), 0, right.empty() ? "" : line + right + "}");
  };
  const IntegrationOptions one =
      scene_of(both("", "macro_step: 1 ms, cycle: rs, him: {smoothing: false}"))
          .problem.integration;
  EXPECT_EQ(one.macro_step, 1e-3);
  EXPECT_EQ(one.cycle, "rs");
  EXPECT_EQ(one.safety, 0.8);
  EXPECT_EQ(one.him.sigma, 0.7);
  EXPECT_FALSE(one.him.smoothing);
  const IntegrationOptions same =
      scene_of(both("macro_step: 0.001, cycle: single", "macro_step: 1 ms")).problem.integration;
  EXPECT_EQ(same.macro_step, 1e-3);
  EXPECT_EQ(
      scene_of(both("cycle: rs, distribution: [0.3, 0.7]", "cycle: rs, distribution: [0.3, 0.7]"))
          .problem.integration.shares[1],
      0.7);

  const auto said = [&](const std::string& left, const std::string& right) {
    return refusal([&] { scene_of(both(left, right)); });
  };
  EXPECT_EQ(said("macro_step: 1 ms", "macro_step: 3 ms"),
            "two.yaml:12: bodies.right.integration.macro_step is 0.003 s, but "
            "bodies.left.integration.macro_step is "
            "0.001 s; expected the same: bodies are stepped together, since they may touch");
  EXPECT_NE(said("him: {sigma: 0.5}", "safety: 0.8")
                .find("bodies.right.integration.him.sigma is 0.7, but bodies.left"),
            std::string::npos)
      << said("him: {sigma: 0.5}", "safety: 0.8");
  EXPECT_NE(said("cycle: rs, distribution: [0.3, 0.7]", "cycle: rs, distribution: [0.4, 0.6]")
                .find("distribution is custom 0.4 0.6, but"),
            std::string::npos)
      << said("cycle: rs, distribution: [0.3, 0.7]", "cycle: rs, distribution: [0.4, 0.6]");
  EXPECT_NE(said("", "macro_stepp: 1 ms")
                .find("two.yaml:11: bodies.right.integration: unknown key 'macro_stepp'"),
            std::string::npos)
      << said("", "macro_stepp: 1 ms");
  EXPECT_NE(said("cycle: rs, macro_step: 3 s", "")
                .find("two.yaml:7: integration.macro_step is 3 s; expected at most"),
            std::string::npos)
      << said("cycle: rs, macro_step: 3 s", "");
}

// One of them known by its surface alone, which lattices fill
TEST(BodiesScene, LatticesStandBesideMeshes) {
  const std::string box = "[{box: {size: [1, 1, 1], cells: [2, 2, 2]}}]\n    initial",
                    surface = "surface: " PLICA_SOURCE_DIR "/meshes/data/organs/liver.vtk, sizes: ";
  const Scene scene = scene_of(with(box, "{" + surface + "[2 cm, 4 cm]}\n    initial"));
  const TetMesh& mesh = scene.problem.body.levels[0];
  ASSERT_EQ(mesh.filled.size(), mesh.tets.size());
  EXPECT_EQ(mesh.filled.front(), 1);
  EXPECT_LT(mesh.filled.back(), 1);
  const std::string said =
      refusal([&] { scene_of(with(box, "{" + surface + "[2 cm]}\n    initial")); });
  EXPECT_NE(said.find("bodies.right.levels.sizes are 1; expected 2"), std::string::npos) << said;
}

// Obstacles are shared by all bodies: they are read once, and what is wrong with them is said once.
TEST(BodiesScene, ObstaclesAreReadOnce) {
  const auto file = std::filesystem::path(testing::TempDir()) / "plica_sheet_of_two_bodies.obj";
  std::ofstream(file) << "v 0 0 -5\nv 1 0 -5\nv 0 1 -5\nv 5 5 5\nf 1 2 3\n";
  const Scene scene =
      scene_of(with("{friction: 0.2}", "{obstacles: [{surface: {file: '" + file.string() +
                                           "', thickness: 0.1}}, {plane: {point: [0, 0, -9]}}]}"));
  std::filesystem::remove(file);
  EXPECT_EQ(std::ranges::count_if(
                scene.warnings,
                [](const std::string& s) { return s.find("unused point") != std::string::npos; }),
            1);
  const auto& obstacles = scene.problem.contact.obstacles;
  ASSERT_EQ(obstacles.size(), 2u);
  const auto& sheet = std::any_cast<const SurfaceOptions&>(obstacles[0].shape);
  EXPECT_EQ(sheet.surface.triangles.size(), 1u);
  EXPECT_EQ(sheet.thickness, 0.1);
}

}  // namespace
