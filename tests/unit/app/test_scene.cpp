// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <plica/drivers/run/simulation.hpp>
#include <plica/kernels/contact/shapes.hpp>

#include "fuzz/replay.hpp"
#include "fuzz/scene_target.hpp"
#include "support/backends.hpp"
#include "unit/app/child.hpp"
#include "unit/app/scene_text.hpp"

namespace plica::app::test {
namespace {

TEST(Scene, KeepsWhatItSays) {
  const Scene scene = scene_of(sound_scene);
  EXPECT_EQ(scene.name, "a");
  EXPECT_EQ(scene.duration, 1);
  EXPECT_EQ(scene.problem.gravity, Point(0, 0, -9.81));
  ASSERT_EQ(scene.problem.body.levels.size(), 2);
  EXPECT_EQ(scene.problem.body.levels[0].tets.size(), 6 * 64);
  EXPECT_DOUBLE_EQ(scene.problem.body.material.young_modulus, 50e3);
  EXPECT_EQ(scene.problem.body.material.density, 1000);
  EXPECT_EQ(scene.problem.integration.cycle, "rsv");
  EXPECT_DOUBLE_EQ(scene.problem.integration.macro_step.value(), 1e-3);
  ASSERT_TRUE(scene.problem.body.surface.has_value());
  EXPECT_EQ(scene.problem.body.surface->vertices.size(), 42);
  const Box box = bounding_box(scene.problem.body.surface->vertices);
  EXPECT_LT(((box.min + box.max) / 2 - Point(0.05, 0.05, 0.05)).norm(), 1e-12);
  ASSERT_EQ(scene.problem.contact.obstacles.size(), 1);
  EXPECT_EQ(std::any_cast<const PlaneOptions&>(scene.problem.contact.obstacles[0].shape).point.z(),
            -0.1);
  EXPECT_EQ(scene.problem.contact.obstacles[0].friction, 0.2);
}

TEST(Scene, ListsPerLevel) {
  const Scene scene = scene_of(
      sound_scene, {"integration.substeps=[3, auto]", "integration.distribution=[0.25, 0.75]",
                    "integration.integrator=[symplectic_euler, implicit_euler]"});
  const IntegrationOptions& integration = scene.problem.integration;
  EXPECT_EQ(integration.substeps, (std::vector<int>{3, 0}));
  EXPECT_EQ(integration.distribution, "custom");
  EXPECT_EQ(integration.shares, (std::vector<double>{0.25, 0.75}));
  EXPECT_EQ(integration.integrator,
            (std::vector<std::string>{"symplectic_euler", "implicit_euler"}));
}

TEST(Scene, GeneratorsAndSurfaces) {
  const Scene scene = scene_of(
      sound_scene, {"body.levels.0={ball: {radius: 1 cm, cells: 4, centre: [1, 2, 3]}}",
                    "body.levels.1={cylinder: {radius: 1, length: 2, across: 2, along: 3}}",
                    "body.surface={boundary: true}"});
  EXPECT_EQ(scene.problem.body.levels[0].tets.size(), 6 * 64);
  EXPECT_EQ(scene.problem.body.levels[1].tets.size(), 6 * 2 * 2 * 3);
  EXPECT_EQ(scene.problem.body.surface->triangles.size(), 6 * 16 * 2);
}

TEST(Scene, CoarseSpacesAreNoMeshes) {
  const auto coarsened = [](const std::string& spaces) {
    return scene_of(sound_scene,
                    {"integration={cycle: him}",
                     "body.levels=[{box: {size: [1, 1, 1], cells: [4, 4, 4]}}, " + spaces + "]"});
  };
  const Scene automatic = coarsened("{coarsen: auto}");
  EXPECT_EQ(automatic.problem.body.levels.size(), 1);
  ASSERT_TRUE(automatic.problem.body.coarsen);
  EXPECT_TRUE(automatic.problem.body.coarsen->empty());
  EXPECT_EQ(*coarsened("{coarsen: 100}, {coarsen: 40}").problem.body.coarsen,
            (std::vector<int>{100, 40}));
  const Scene below = coarsened("{box: {size: [1, 1, 1], cells: [3, 3, 3]}}, {coarsen: 40}");
  EXPECT_EQ(below.problem.body.levels.size(), 2);
  EXPECT_EQ(*below.problem.body.coarsen, std::vector<int>{40});
  EXPECT_FALSE(scene_of(sound_scene).problem.body.coarsen);
}

TEST(Scene, LatticesOverASurface) {
  const auto levels = [](const std::string& rest) {
    return std::vector<std::string>{"integration={cycle: rsv}", "body.levels={" + rest + "}"};
  };
  const std::string data = PLICA_SOURCE_DIR "/meshes/data/",
                    ball = "surface: " + data + "ball.msh, ";
  const Scene scene = scene_of(sound_scene, levels(ball + "sizes: [15 mm, 40 mm]"));
  ASSERT_EQ(scene.problem.body.levels.size(), 2);
  for (const TetMesh& mesh : scene.problem.body.levels)
    EXPECT_EQ(mesh.filled.size(), mesh.tets.size());
  EXPECT_EQ(scene.problem.body.surface->vertices.size(), 42);  // the scene's own
  Tree without =
      parse_tree(damaged("  surface: {sphere: {radius: 4 cm, subdivisions: 1}}\n", ""), "a.yaml");
  for (const std::string& set : levels(ball + "sizes: 20 mm")) override_value(without, set, set);
  EXPECT_GT(load_scene(without).problem.body.surface->vertices.size(), 100);  // the ball's

  const auto said = [&](const std::string& rest) { return error_of(sound_scene, levels(rest)); };
  const auto expect_said = [&](const std::string& rest, const std::string& words) {
    EXPECT_NE(said(rest).find(words), std::string::npos) << said(rest);
  };
  expect_said(ball + "sizes: [2 mm, 2 mm]",
              "body.levels.sizes.1 is 0.002 m after 0.002 m; expected larger cells");
  expect_said(ball + "sizes: [9 m]", "the size of cells, 9 m, is larger than the body");
  expect_said(ball + "size: 9 mm", "body.levels: unknown key 'size'");
  expect_said("sizes: 9 mm", "body.levels: the key 'surface' is missing");
  expect_said("surface: no.stl, sizes: 9 mm", "there is no surface file");
  expect_said("surface: " + data + "formats/blocks.stl, sizes: 9 mm",
              "has no inside: 4 open edges");
  EXPECT_NE(error_of(sound_scene, {"body.jitter=0.1", levels(ball + "sizes: 9 mm")[1]})
                .find("body.jitter"),
            std::string::npos);
}

TEST(Override, ReplacesAndAdds) {
  const Scene scene =
      scene_of(sound_scene, {"duration=20 ms", "body.levels.0.box.cells=[3, 3, 3]", "name=a=b",
                             "body.initial.angular_velocity=[90 deg/s, 0, 0]", "duration=30 ms",
                             "integration.macro_step=auto"});
  EXPECT_DOUBLE_EQ(scene.duration, 0.03);
  EXPECT_EQ(scene.problem.body.levels[0].tets.size(), 6 * 27);
  EXPECT_EQ(scene.name, "a=b");
  EXPECT_DOUBLE_EQ(scene.problem.body.initial.angular_velocity.x(), std::numbers::pi / 2);
  EXPECT_FALSE(scene.problem.integration.macro_step.has_value());
}

TEST(Override, ErrorsNameIt) {
  const auto error = [](const std::string& set) { return error_of(sound_scene, {set}); };
  EXPECT_EQ(error("duration=4 cm"),
            "--set duration=4 cm: duration: expected a time (s) > 0, got '4 cm', a length");
  EXPECT_EQ(error("durtion=4").substr(0, 64),
            "--set durtion=4: unknown key 'durtion'; did you mean 'duration'?");
  EXPECT_EQ(
      error("body.levels.2.box.cells=3"),
      "--set body.levels.2.box.cells=3: '2' is no entry of this list, which has 2, counted from 0");
  EXPECT_EQ(error("duration.x=3"),
            "--set duration.x=3: cannot set 'x' inside '1 s', which is a single value");
  EXPECT_EQ(error("duration"), "--set duration: expected key.path=value");
  EXPECT_EQ(error("=3"), "--set =3: expected key.path=value");
  EXPECT_EQ(error("duration=[").substr(0, 28), "--set duration=[: not YAML: ");
}

const std::filesystem::path scenes = PLICA_SOURCE_DIR "/drivers/scenes";

std::vector<std::string> shipped_scenes() {
  std::vector<std::string> list;
  for (const auto& file : std::filesystem::recursive_directory_iterator(scenes))
    if (file.path().extension() == ".yaml")
      list.push_back(file.path().lexically_relative(scenes).replace_extension().string());
  std::ranges::sort(list);
  return list;
}

class ShippedScene : public testing::TestWithParam<std::string> {};

TEST_P(ShippedScene, IsSound) {
  const Scene scene = load_scene(scenes / (GetParam() + ".yaml"));
  // the paper's meshes and elements are what they are
  for (const std::string& warning : scene.warnings)
    EXPECT_TRUE(warning.find("has linear elements") != std::string::npos &&
                GetParam().find("ball_in_bowl") != std::string::npos)
        << warning;
  EXPECT_NO_THROW(Simulation<plica::test::Host>{scene.problem});
}

INSTANTIATE_TEST_SUITE_P(All, ShippedScene, testing::ValuesIn(shipped_scenes()),
                         [](const auto& one) {
                           std::string name = one.param;
                           std::ranges::replace(name, '/', '_');
                           return name;
                         });

// The scene in README.md is drivers/scenes/press.yaml but for its comments at the top.
TEST(Readme, ShowsAShippedScene) {
  const std::string readme = content_of(PLICA_SOURCE_DIR "/README.md"), start = "```yaml\n";
  const std::size_t from = readme.find(start);
  if (from == std::string::npos) GTEST_SKIP() << "README.md shows no scene";
  const std::string in_readme = readme.substr(
      from + start.size(), readme.find("```", from + start.size()) - from - start.size());
  const std::string shipped = content_of(PLICA_SOURCE_DIR "/drivers/scenes/press.yaml");
  EXPECT_EQ(in_readme, shipped.substr(shipped.find("name: ")));
}

TEST(StudyScenes, AreSoundOnAllTheirLevels) {
  int count = 0;
  for (const auto& file : std::filesystem::directory_iterator(scenes / "study")) {
    SCOPED_TRACE(file.path());
    Scene scene = load_scene(file.path(), {{"integration.cycle=rsv", "--set"}});
    ASSERT_EQ(scene.problem.body.levels.size(), 3);
    const Simulation<plica::test::Host> simulation(scene.problem);
    EXPECT_EQ(simulation.levels().size(), 3);
    EXPECT_GT(simulation.levels()[0].tets, 2 * simulation.levels()[1].tets);
    ++count;
  }
  EXPECT_EQ(count, 10);
}

TEST(Scene, BallStartsWhereTheyAgreed) {
  const Scene scene =
      load_scene(std::string(PLICA_SOURCE_DIR) + "/drivers/scenes/ball_in_bowl.yaml");
  EXPECT_EQ(scene.problem.body.surface->vertices.size(), 642);
  const auto& bowl = std::any_cast<const BowlOptions&>(scene.problem.contact.obstacles[0].shape);
  const Point start = *scene.problem.body.initial.position;
  const double below =
      bowl.centre.z() - std::sqrt(bowl.radius * bowl.radius - start.x() * start.x());
  EXPECT_NEAR(start.x(), 0.01, 1e-12);
  EXPECT_NEAR(start.z() - 0.05 - below, 0.025, 1e-4);
}

TEST(Scene, TissuesGiveValuesThatOtherKeysOverride) {
  const Scene scene = scene_of(damaged(
      "{model: neo_hookean, young_modulus: 50 kPa}",
      "{a: 3 kPa, tissue: heart_muscle, volume: logarithmic}\n  fibres: {axis: [0, 0, 2]}"));
  const MaterialOptions& m = scene.problem.body.material;
  EXPECT_EQ(m.model, "costa");
  EXPECT_EQ(m.tissue, "heart_muscle");
  EXPECT_EQ(m.parameters.at("a"), 3000);
  EXPECT_EQ(m.parameters.at("b_ff"), 8);
  EXPECT_EQ(m.volume, "logarithmic");
  ASSERT_TRUE(m.fibres);
  EXPECT_EQ(m.fibres->axis, Point(0, 0, 2));
}

TEST(Scene, ListsOfATissueAreReplaced) {
  const char* const law = "{model: neo_hookean, young_modulus: 50 kPa}";
  const MaterialOptions m = scene_of(damaged(law, "{tissue: brain}")).problem.body.material;
  EXPECT_EQ(m.terms.size(), 1U);
  EXPECT_EQ(m.prony.size(), 2U);
  EXPECT_EQ(m.density, 1040);
  const MaterialOptions own =
      scene_of(damaged(law, "{tissue: brain, prony: [], terms: [{mu: 1 kPa, alpha: 2}]}"))
          .problem.body.material;
  ASSERT_EQ(own.terms.size(), 1U);
  EXPECT_EQ(own.terms[0].mu, 1000);
  EXPECT_TRUE(own.prony.empty());
  EXPECT_EQ(own.convention, "two_mu_over_alpha2");
}

TEST(Scene, FibresRunFromOneSetToAnother) {
  const Scene scene = scene_of(damaged(
      "{model: neo_hookean, young_modulus: 50 kPa}",
      "{tissue: heart_muscle}\n  fibres: {from: {half_space: {}}, to: {nearest: [0, 0, 1]}}"));
  const FibreOptions& fibres = *scene.problem.body.material.fibres;
  ASSERT_TRUE(fibres.from && fibres.to);
  EXPECT_EQ(std::get<HalfSpaceSelection>(*fibres.from).normal, Point(0, 0, 1));
  EXPECT_EQ(std::get<NearestSelection>(*fibres.to).to, Point(0, 0, 1));
}

TEST(Scene, PresetsGiveOptionsThatOtherKeysOverride) {
  const Scene scene = scene_of(damaged("gravity: [0, 0, -9.81]", "preset: tled"));
  EXPECT_EQ(scene.problem.preset, "tled");
  EXPECT_EQ(scene.problem.body.element, std::vector<std::string>{"linear"});
  EXPECT_EQ(scene.problem.integration.integrator, std::vector<std::string>{"central_difference"});
}

TEST(Scene, EmptyIsAnError) {
  EXPECT_EQ(error_of(""), "a.yaml: the scene is empty");
  EXPECT_EQ(error_of("# nothing but words\n"), "a.yaml: the scene is empty");
  EXPECT_EQ(error_of("- 1\n- 2\n"), "a.yaml:1: the scene: expected a map of keys, got a list of 2");
  EXPECT_EQ(error_of("- a list\n").substr(0, 10), "a.yaml:1: ");
}

TEST(Scene, TouchesObstaclesByItsBoundary) {
  const std::string surface = "  surface: {sphere: {radius: 4 cm, subdivisions: 1}}\n";
  const Body body = scene_of(damaged(surface, "")).problem.body;
  ASSERT_TRUE(body.surface);
  EXPECT_EQ(body.surface->triangles.size(), 6u * 2 * 4 * 4);
  EXPECT_FALSE(scene_of(damaged(surface, ""), {"contact.obstacles=[]"}).problem.body.surface);
}

TEST(Scene, MayTouchNothing) {
  const std::string obstacle = "- {plane: {point: [0, 0, -0.1]}, friction: 0.2}";
  EXPECT_TRUE(scene_of(damaged(obstacle, "[]")).problem.contact.obstacles.empty());
  EXPECT_EQ(error_of(sound_scene, {"contact.obstacles=[]", "body.fixed=[]", "body.loads=[]"}),
            "no error");
}

TEST(Scene, MissingFileIsAnError) {
  EXPECT_THROW(load_scene("/nowhere/at/all.yaml"), InputError);
  EXPECT_THROW(load_scene(PLICA_SOURCE_DIR), InputError);
}

// What the program says to hierarchies and cycles that make no sense: exit 2, and nothing is run.
class Levels : public testing::Test {
 protected:
  Levels() { std::ofstream(folder / "a.yaml") << sound_scene; }
  Child plica(const std::string& command, const std::vector<std::string>& set) {
    std::vector<std::string> words = {PLICA_EXECUTABLE, command, folder / "a.yaml"};
    if (command == "run") words.insert(words.end(), {"-o", folder / "out", "--force"});
    for (const std::string& assignment : set) words.insert(words.end(), {"--set", assignment});
    return run_child(words, folder);
  }
  void expect_refusal(const std::vector<std::string>& set, const std::string& says) {
    for (const char* command : {"run", "explain", "check"}) {
      const Child child = plica(command, set);
      EXPECT_EQ(child.status, 2) << set[0] << child.output << child.errors;
      EXPECT_NE(child.errors.find(says), std::string::npos) << child.errors;
      EXPECT_FALSE(std::filesystem::exists(folder / "out")) << set[0];
    }
  }
  TemporaryFolder folder;
};

TEST_F(Levels, RefusesWhatMakesNoSense) {
  expect_refusal({"integration.distribution=[0.5, 0.4]"}, "must add up to 1, got 0.9");
  expect_refusal({"integration.macro_step=10 s", "duration=50 ms"},
                 "integration.macro_step is 10 s; expected at most the duration, 0.05 s");
  expect_refusal({"integration.substeps=0"}, "expected a whole number >= 1, got '0'");
  expect_refusal({"integration.cycle=fas", "integration.outside=extrapolate"}, "expected clamp");
  expect_refusal({"integration.distribution=[1]"},
                 "expected one for each level (2 in body.levels), got a list of 1");
  expect_refusal({"body.levels.1.box.origin=[1, 0, 0]"}, "do not overlap, they are 0.9 m apart");
  expect_refusal({"body.initial={twist: {from: [0, 0, 0], to: [0, 0, 0], angular_velocity: 3}}"},
                 "body.initial.twist.to, as a distance from .from, is 0");
  expect_refusal(
      {"body.initial={parts: [{sphere: {centre: [9, 9, 9], radius: 1}, velocity: [0, 0, 1]}]}"},
      "body.initial.parts.0");
  expect_refusal({"body.initial={parts: [{group: tip, velocity: [0, 0, 1]}]}"},
                 "body.initial.parts.0.group: there is no group 'tip': the meshes name none");
}

TEST_F(Levels, WarnsWhereTheyDoNotCoarsen) {
  for (const char* command : {"run", "explain", "check"}) {
    const Child child = plica(command, {"body.levels.1.box.cells=[4, 4, 4]", "duration=1 ms"});
    EXPECT_EQ(child.status, 0) << child.errors;
    EXPECT_NE(child.errors.find("level 1 is not coarser than level 0: 384 tetrahedra after 384"),
              std::string::npos)
        << child.errors;
    EXPECT_EQ(plica(command, {"duration=1 ms"}).errors.find("coarser"), std::string::npos);
  }
}

// What the fuzzer of scenes starts from, and what it once found, without libFuzzer

TEST(FuzzScenes, AreRefusedOrSound) {
  for (const plica::fuzz::Target& target : plica::fuzz::scene_targets)
    EXPECT_GE(plica::fuzz::replay(target), 3);
}

}  // namespace
}  // namespace plica::app::test
