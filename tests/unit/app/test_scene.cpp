// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <plica/drivers/solver/simulation.hpp>
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
  EXPECT_EQ(std::any_cast<const PlaneOptions&>(scene.problem.contact.obstacles[0].shape).point.z(), -0.1);
  EXPECT_EQ(scene.problem.contact.obstacles[0].friction, 0.2);
}

TEST(Scene, ListsPerLevel) {
  const Scene scene = scene_of(sound_scene, {"integration.substeps=[3, auto]", "integration.distribution=[0.25, 0.75]",
                                             "integration.integrator=[symplectic_euler, implicit_euler]"});
  const IntegrationOptions& integration = scene.problem.integration;
  EXPECT_EQ(integration.substeps, (std::vector<int>{3, 0}));
  EXPECT_EQ(integration.distribution, "custom");
  EXPECT_EQ(integration.shares, (std::vector<double>{0.25, 0.75}));
  EXPECT_EQ(integration.integrator, (std::vector<std::string>{"symplectic_euler", "implicit_euler"}));
}

TEST(Scene, GeneratorsAndSurfaces) {
  const Scene scene = scene_of(sound_scene, {"body.levels.0={ball: {radius: 1 cm, cells: 4, centre: [1, 2, 3]}}",
                                             "body.levels.1={cylinder: {radius: 1, length: 2, across: 2, along: 3}}",
                                             "body.surface={boundary: true}"});
  EXPECT_EQ(scene.problem.body.levels[0].tets.size(), 6 * 64);
  EXPECT_EQ(scene.problem.body.levels[1].tets.size(), 6 * 2 * 2 * 3);
  EXPECT_EQ(scene.problem.body.surface->triangles.size(), 6 * 16 * 2);
}

TEST(Scene, CoarseSpacesAreNoMeshes) {
  const auto coarsened = [](const std::string& spaces) {
    return scene_of(sound_scene, {"integration={cycle: him}",
                                  "body.levels=[{box: {size: [1, 1, 1], cells: [4, 4, 4]}}, " + spaces + "]"});
  };
  const Scene automatic = coarsened("{coarsen: auto}");
  EXPECT_EQ(automatic.problem.body.levels.size(), 1);
  ASSERT_TRUE(automatic.problem.body.coarsen);
  EXPECT_TRUE(automatic.problem.body.coarsen->empty());
  EXPECT_EQ(*coarsened("{coarsen: 100}, {coarsen: 40}").problem.body.coarsen, (std::vector<int>{100, 40}));
  EXPECT_FALSE(scene_of(sound_scene).problem.body.coarsen);
}

TEST(Scene, LatticesOverASurface) {
  const auto levels = [](const std::string& rest) {
    return std::vector<std::string>{"integration={cycle: rsv}", "body.levels={" + rest + "}"};
  };
  const std::string data = PLICA_SOURCE_DIR "/meshes/data/", ball = "surface: " + data + "ball.msh, ";
  const Scene scene = scene_of(sound_scene, levels(ball + "sizes: [15 mm, 40 mm]"));
  ASSERT_EQ(scene.problem.body.levels.size(), 2);
  for (const TetMesh& mesh : scene.problem.body.levels) EXPECT_EQ(mesh.filled.size(), mesh.tets.size());
  EXPECT_EQ(scene.problem.body.surface->vertices.size(), 42);  // the scene's own
  Tree without = parse_tree(damaged("  surface: {sphere: {radius: 4 cm, subdivisions: 1}}\n", ""), "a.yaml");
  for (const std::string& set : levels(ball + "sizes: 20 mm")) override_value(without, set, set);
  EXPECT_GT(load_scene(without).problem.body.surface->vertices.size(), 100);  // the ball's

  const auto said = [&](const std::string& rest) { return error_of(sound_scene, levels(rest)); };
  const auto expect_said = [&](const std::string& rest, const std::string& words) {
    EXPECT_NE(said(rest).find(words), std::string::npos) << said(rest);
  };
  expect_said(ball + "sizes: [2 mm, 2 mm]", "body.levels.sizes.1 is 0.002 m after 0.002 m; expected larger cells");
  expect_said(ball + "sizes: [9 m]", "the size of cells, 9 m, is larger than the body");
  expect_said(ball + "size: 9 mm", "body.levels: unknown key 'size'");
  expect_said("sizes: 9 mm", "body.levels: the key 'surface' is missing");
  expect_said("surface: no.stl, sizes: 9 mm", "there is no surface file");
  expect_said("surface: " + data + "formats/blocks.stl, sizes: 9 mm", "has no inside: 4 open edges");
  EXPECT_NE(error_of(sound_scene, {"body.jitter=0.1", levels(ball + "sizes: 9 mm")[1]}).find("body.jitter"),
            std::string::npos);
}

TEST(Override, ReplacesAndAdds) {
  const Scene scene = scene_of(
      sound_scene, {"duration=20 ms", "body.levels.0.box.cells=[3, 3, 3]", "name=a=b",
                    "body.initial.angular_velocity=[90 deg/s, 0, 0]", "duration=30 ms", "integration.macro_step=auto"});
  EXPECT_DOUBLE_EQ(scene.duration, 0.03);
  EXPECT_EQ(scene.problem.body.levels[0].tets.size(), 6 * 27);
  EXPECT_EQ(scene.name, "a=b");
  EXPECT_DOUBLE_EQ(scene.problem.body.initial.angular_velocity.x(), std::numbers::pi / 2);
  EXPECT_FALSE(scene.problem.integration.macro_step.has_value());
}

TEST(Override, ErrorsNameIt) {
  const auto error = [](const std::string& set) { return error_of(sound_scene, {set}); };
  EXPECT_EQ(error("duration=4 cm"), "--set duration=4 cm: duration: expected a time (s) > 0, got '4 cm', a length");
  EXPECT_EQ(error("durtion=4").substr(0, 64), "--set durtion=4: unknown key 'durtion'; did you mean 'duration'?");
  EXPECT_EQ(error("body.levels.2.box.cells=3"),
            "--set body.levels.2.box.cells=3: '2' is no entry of this list, which has 2, counted from 0");
  EXPECT_EQ(error("duration.x=3"), "--set duration.x=3: cannot set 'x' inside '1 s', which is a single value");
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
  for (const std::string& warning : scene.warnings)  // the paper's meshes and elements are what they are
    EXPECT_TRUE(warning.find("has linear elements") != std::string::npos &&
                GetParam().find("ball_in_bowl") != std::string::npos)
        << warning;
  EXPECT_NO_THROW(Simulation<plica::test::Host>{scene.problem});
}

INSTANTIATE_TEST_SUITE_P(All, ShippedScene, testing::ValuesIn(shipped_scenes()), [](const auto& one) {
  std::string name = one.param;
  std::ranges::replace(name, '/', '_');
  return name;
});

// The scene in README.md is drivers/scenes/press.yaml but for its comments at the top.
TEST(Readme, ShowsAShippedScene) {
  const std::string readme = content_of(PLICA_SOURCE_DIR "/README.md"), start = "```yaml\n";
  const std::size_t from = readme.find(start);
  if (from == std::string::npos) GTEST_SKIP() << "README.md shows no scene";
  const std::string shown =
      readme.substr(from + start.size(), readme.find("```", from + start.size()) - from - start.size());
  const std::string shipped = content_of(PLICA_SOURCE_DIR "/drivers/scenes/press.yaml");
  EXPECT_EQ(shown, shipped.substr(shipped.find("name: ")));
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
  const Scene scene = load_scene(std::string(PLICA_SOURCE_DIR) + "/drivers/scenes/ball_in_bowl.yaml");
  EXPECT_EQ(scene.problem.body.surface->vertices.size(), 642);
  const auto& bowl = std::any_cast<const BowlOptions&>(scene.problem.contact.obstacles[0].shape);
  const Point start = *scene.problem.body.initial.position;
  const double below = bowl.centre.z() - std::sqrt(bowl.radius * bowl.radius - start.x() * start.x());
  EXPECT_NEAR(start.x(), 0.01, 1e-12);
  EXPECT_NEAR(start.z() - 0.05 - below, 0.025, 1e-4);
}

TEST(Scene, TissuesGiveValuesThatOtherKeysOverride) {
  const Scene scene =
      scene_of(damaged("{model: neo_hookean, young_modulus: 50 kPa}",
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

TEST(Scene, PresetsGiveOptionsThatOtherKeysOverride) {
  const Scene scene = scene_of(damaged("gravity: [0, 0, -9.81]", "preset: tled"));
  EXPECT_EQ(scene.problem.preset, "tled");
  EXPECT_EQ(scene.problem.body.element, std::vector<std::string>{"linear"});
  EXPECT_EQ(scene.problem.integration.integrator, std::vector<std::string>{"central_difference"});
}

struct Damage {
  const char* name;
  const char* piece;
  const char* replacement;
  const char* message;  // all of it, or its beginning
};

class SceneError : public testing::TestWithParam<Damage> {};

TEST_P(SceneError, SaysWhereWhatAndWhatInstead) {
  const auto& [name, piece, replacement, message] = GetParam();
  EXPECT_EQ(error_of(damaged(piece, replacement)).substr(0, std::string(message).size()), message);
}

const Damage damages[] = {
    {"UnknownKey",
     "material:", "materal:", "a.yaml:7: body: unknown key 'materal'; did you mean 'material'? (choices: "},
    {"UnknownTopLevelKey", "gravity:", "gravty:", "a.yaml:2: unknown key 'gravty'; did you mean 'gravity'? (choices: "},
    {"MisplacedKey", "gravity: [0, 0, -9.81]", "young_modulus: 3",
     "a.yaml:2: unknown key 'young_modulus'; it belongs in body.material or body.regions.<name>"},
    {"MisplacedBelow", "macro_step: 1 ms", "gravity: [0, 0, -9.81]",
     "a.yaml:11: integration: unknown key 'gravity'; it belongs in the top level"},
    {"DuplicateKey", "gravity: [0, 0, -9.81]", "gravity: [0, 0, -9.81]\ngravity: [0, 0, 0]",
     "a.yaml:3: the key 'gravity' stands here for the second time; the first is in line 2"},
    {"MissingKey", "duration: 1 s", "name: x", "a.yaml:1: the key 'duration' is missing"},
    {"MissingKeyBelow", "radius: 4 cm, ", "", "a.yaml:8: body.surface.sphere: the key 'radius' is missing"},
    {"WrongDimension", "50 kPa", "4 cm",
     "a.yaml:7: body.material.young_modulus: expected a pressure (Pa) > 0, got '4 cm', a length"},
    {"UnknownUnit", "50 kPa", "50 kpa",
     "a.yaml:7: body.material.young_modulus: expected a pressure (Pa) > 0, got '50 kpa', unknown unit 'kpa'; did you "
     "mean "
     "'kPa'?"},
    {"NotANumber", "1 s", "long", "a.yaml:1: duration: expected a time (s) > 0, got 'long', not a number"},
    {"NotFinite", "1 s", ".inf", "a.yaml:1: duration: expected a time (s) > 0, got '.inf', not a number"},
    {"OutOfRange", "1 s", "-1 s", "a.yaml:1: duration: expected a time (s) > 0, got '-1 s'"},
    {"PoissonRatio", "young_modulus: 50 kPa", "poisson_ratio: 0.5",
     "a.yaml:7: body.material.poisson_ratio: expected a number in [0, 0.5), got '0.5'"},
    {"StiffnessOfAnotherLaw", "neo_hookean", "mooney_rivlin",
     "a.yaml:7: body.material.young_modulus: unknown parameter of mooney_rivlin 'young_modulus'; did you mean "
     "'bulk_modulus'? (choices: c10, c01, bulk_modulus)"},
    {"NoStiffnessAtRest", "{model: neo_hookean, young_modulus: 50 kPa}", "{model: mooney_rivlin, c10: -1 kPa}",
     "a.yaml:7: body.material, as the shear stiffness of mooney_rivlin at rest, is 0 Pa; expected a pressure (Pa) > 0"},
    {"OgdensAlpha", "{model: neo_hookean, young_modulus: 50 kPa}",
     "{model: ogden, convention: mu_over_alpha, terms: [{mu: 1 kPa, alpha: 0}]}",
     "a.yaml:7: body.material.terms.0.alpha is 0; expected a number other than 0"},
    {"NoFibres", "{model: neo_hookean, young_modulus: 50 kPa}", "{tissue: heart_muscle}",
     "a.yaml:3: body.fibres is missing; expected the direction of the fibres of costa, such as {axis: [0, 0, 1]}, of "
     "the body or of every region"},
    {"FibreOfNoLength", "{model: neo_hookean, young_modulus: 50 kPa}",
     "{tissue: heart_muscle}\n  fibres: {axis: [0, 0, 0]}", "a.yaml:8: body.fibres.axis: expected a direction, got "},
    {"FibresTwice", "{model: neo_hookean, young_modulus: 50 kPa}",
     "{tissue: heart_muscle}\n  fibres: {axis: [0, 0, 1], field: a}", "a.yaml:8: body.fibres: "},
    {"FibreFieldIsNotThere", "{model: neo_hookean, young_modulus: 50 kPa}",
     "{tissue: heart_muscle}\n  fibres: {field: fibre}",
     "a.yaml:8: body.fibres.field: the mesh of level 0 has no field of vectors; expected 'fibre' among those of its "
     "cells "
     "or points"},
    {"PronySum", "young_modulus: 50 kPa", "prony: [{alpha: 0.6, tau: 1 s}, {alpha: 0.5, tau: 2 s}]",
     "a.yaml:7: body.material.prony: the sum of alpha is 1.1; expected one below 1"},
    {"PronyTime", "young_modulus: 50 kPa", "prony: [{alpha: 0.6, tau: 0 s}]",
     "a.yaml:7: body.material.prony.0.tau: expected a time (s) > 0, got '0 s'"},
    {"PronyOfALawWithoutShape", "neo_hookean", "corotational, prony: [{alpha: 0.6, tau: 1 s}]",
     "a.yaml:7: body.material.prony: corotational does not split shape from volume"},
    {"UnknownPreset", "gravity: [0, 0, -9.81]", "preset: led",
     "a.yaml:2: preset: unknown preset 'led'; did you mean 'tled'? (choices: tled)"},
    {"UnknownTissue", "{model: neo_hookean, young_modulus: 50 kPa}", "{tissue: heart}",
     "a.yaml:7: body.material.tissue: unknown tissue 'heart' (choices: heart_muscle, artery_adventitia)"},
    {"UnknownVolume", "{model: neo_hookean, young_modulus: 50 kPa}", "{model: mooney_rivlin, volume: log}",
     "a.yaml:7: body.material.volume: unknown volume 'log' (choices: simo_hughes, logarithmic, quadratic)"},
    {"Nothing", "1 s", "", "a.yaml:1: duration: expected a time (s) > 0, got nothing"},
    {"ScalarForList", "[0, 0, -9.81]", "-9.81",
     "a.yaml:2: gravity: expected a list of 3 accelerations (m/s^2), got '-9.81'"},
    {"ListLength", "[0, 0, -9.81]", "[0, -9.81]",
     "a.yaml:2: gravity: expected a list of 3 accelerations (m/s^2), got a list of 2"},
    {"ListEntry", "[0, 0, -9.81]", "[0, x, -9.81]",
     "a.yaml:2: gravity.1: expected an acceleration (m/s^2), got 'x', not a number"},
    {"MapForScalar", "1 s", "{s: 1}", "a.yaml:1: duration: expected a time (s) > 0, got a map (s)"},
    {"ScalarForMap", "{model: neo_hookean, young_modulus: 50 kPa}", "soft",
     "a.yaml:7: body.material: expected a map of keys, got 'soft'"},
    {"FractionalCount", "[4, 4, 4]", "[4, 4.5, 4]",
     "a.yaml:5: body.levels.0.box.cells.1: expected a whole number >= 1, got '4.5'"},
    {"CountTooSmall", "[2, 2, 2]", "[2, 2, 0]",
     "a.yaml:6: body.levels.1.box.cells.2: expected a whole number >= 1, got '0'"},
    {"CountTooLarge", "[2, 2, 2]", "[2000, 2000, 2000]",
     "a.yaml:6: body.levels.1: a mesh this fine makes the scene take about 1.68e+04 GB of memory; this machine has "},
    {"SubdividedTooOften", "subdivisions: 1", "subdivisions: 2000000000",
     "a.yaml:8: body.surface: a mesh this fine makes the scene take about "},
    {"TooFewPoints", "{box: {size: [10 cm, 10 cm, 10 cm], cells: [2, 2, 2]}}", "{coarsen: 20}",
     "a.yaml:6: body.levels.1.coarsen: expected a whole number >= 30, got '20'"},
    {"CoarsenFirst", "{box: {size: [0.1, 0.1, 0.1], cells: [4, 4, 4]}}", "{coarsen: auto}",
     "a.yaml:5: body.levels.0: coarsen makes coarse spaces of the mesh before it; expected a mesh first"},
    {"CoarsenWithMeshes", "  material:", "    - {coarsen: auto}\n  material:",
     "a.yaml:7: body.levels.2: coarsen makes coarse spaces of the finest mesh, but 2 meshes stand before it"},
    {"CoarsenInAPaperCycle", "{box: {size: [10 cm, 10 cm, 10 cm], cells: [2, 2, 2]}}", "{coarsen: auto}",
     "a.yaml:4: body.levels: coarsen makes spaces without elements, but cycle rsv integrates its coarser levels"},
    {"NotAFlag", "macro_step: 1 ms", "allow_unstable: yes",
     "a.yaml:11: integration.allow_unstable: expected true or false, got 'yes'"},
    {"UnknownName", "neo_hookean", "neohookean",
     "a.yaml:7: body.material.model: unknown material 'neohookean'; did you mean 'neo_hookean'? (choices: "},
    {"TwoAlternatives", "{plane: {point: [0, 0, -0.1]}, ", "{plane: {}, sphere: {radius: 1}, ",
     "a.yaml:14: contact.obstacles.0: expected only one of plane, sphere, bowl, capsule, box, cylinder, surface, got "
     "a map (plane, sphere, friction)"},
    {"NoAlternative", "{plane: {point: [0, 0, -0.1]}, friction: 0.2}", "{friction: 0.2}",
     "a.yaml:14: contact.obstacles.0: expected one of plane, sphere, bowl, capsule, box, cylinder, surface, got a "
     "map (friction)"},
    {"EmptyList", "- {plane: {point: [0, 0, -0.1]}, friction: 0.2}", "[]",
     "a.yaml:14: contact.obstacles: expected at least one entry, got a list of 0"},
    {"AutoMisspelt", "1 ms", "automatic",
     "a.yaml:11: integration.macro_step: expected a time (s) > 0, or auto, got 'automatic', not a number"},
    {"Substeps", "macro_step: 1 ms", "substeps: 0",
     "a.yaml:11: integration.substeps: expected a whole number >= 1, got '0'"},
    {"SubstepsPerLevel", "macro_step: 1 ms", "substeps: [auto, 2, 3]",
     "a.yaml:11: integration.substeps: expected one for all or one for each level (2 in body.levels), got a list of 3"},
    {"IntegratorPerLevel", "macro_step: 1 ms", "integrator: [rk4, rk4, rk4]",
     "a.yaml:11: integration.integrator: expected one for all or one for each level (2 in body.levels), got a list of "
     "3"},
    {"SharesPerLevel", "macro_step: 1 ms", "distribution: [1]",
     "a.yaml:11: integration.distribution: expected one for each level (2 in body.levels), got a list of 1"},
    {"SharesSum", "macro_step: 1 ms", "distribution: [0.5, 0.6]",
     "a.yaml:11: integration.distribution: the shares must add up to 1, got 1.1"},
    {"ContactWithoutSurface", "  surface: {sphere: {radius: 4 cm, subdivisions: 1}}\n", "",
     "a.yaml:12: contact.obstacles: the body has no surface to touch them; give body.surface"},
    {"RimAboveRadius", "plane: {point: [0, 0, -0.1]}", "bowl: {radius: 1, rim: 2}",
     "a.yaml:14: contact.obstacles.0.bowl.rim is 2 m; expected at most the radius, 1 m"},
    {"NoNormal", "point: [0, 0, -0.1]", "normal: [0, 0, 0]",
     "a.yaml:14: contact.obstacles.0.plane.normal: expected a direction, got [0, 0, 0]"},
    {"BoxUpsideDown", "material:", "fixed: [{box: {min: [0, 0, 1], max: [1, 1, 0]}}]\n  material:",
     "a.yaml:7: body.fixed.0.box.min is [0, 0, 1] m; expected at most max, [1, 1, 0] m"},
    {"ScaleWithoutFile", "cells: [4, 4, 4]}}", "cells: [4, 4, 4]}, scale: 2}",
     "a.yaml:5: body.levels.0.scale: only a file has one"},
    {"MergeWithoutFile", "cells: [4, 4, 4]}}", "cells: [4, 4, 4]}, merge_duplicates: 0}",
     "a.yaml:5: body.levels.0.merge_duplicates: only a file has one"},
    {"SurfaceScaleWithoutFile", "subdivisions: 1}", "subdivisions: 1}, scale: 2",
     "a.yaml:8: body.surface.scale: only a file has one"},
    {"NoSurfaceKind", "sphere: {radius: 4 cm, subdivisions: 1}", "boundary: false",
     "a.yaml:8: body.surface.boundary: expected true, got 'false'; leave body.surface out to have none"},
    {"UnknownGroup", "material:", "fixed: [{group: left}]\n  material:",
     "a.yaml:7: body.fixed.0.group: there is no group 'left': the meshes name none"},
    {"UnknownRegion", "material:", "regions: {tumour: {density: 1}}\n  material:",
     "a.yaml:7: body.regions.tumour: there is no region 'tumour': the meshes name none"},
    {"MissingMesh", "{box: {size: [0.1, 0.1, 0.1], cells: [4, 4, 4]}}", "{file: nowhere.msh}",
     "a.yaml:5: there is no mesh file 'nowhere.msh' (its name is relative to the scene)"},
    {"StepOverDuration", "macro_step: 1 ms", "macro_step: 10 s",
     "a.yaml:11: integration.macro_step is 10 s; expected at most the duration, 1 s"},
    {"TooManyHalvings", "macro_step: 1 ms", "retry: {halvings: 11}",
     "a.yaml:11: integration.retry.halvings: expected a whole number in [0, 10], got '11'"},
    {"NotYaml", "gravity: [0, 0, -9.81]", "gravity: [0, 0, -9.81", "a.yaml:3: not YAML: "},
    {"TwoDocuments", "gravity:", "---\ngravity:", "a.yaml:2: a scene is one YAML document; here begins another"},
    {"StrayBrace", "duration: 1 s", "}", "a.yaml:"},
    {"AliasOfItself", "duration: 1 s", "duration: &a [*a]", "a.yaml:1: nested more than 50 deep"},
};

INSTANTIATE_TEST_SUITE_P(All, SceneError, testing::ValuesIn(damages),
                         [](const auto& one) { return std::string(one.param.name); });

TEST(Scene, EmptyIsAnError) {
  EXPECT_EQ(error_of(""), "a.yaml: the scene is empty");
  EXPECT_EQ(error_of("# nothing but words\n"), "a.yaml: the scene is empty");
  EXPECT_EQ(error_of("- a list\n").substr(0, 10), "a.yaml:1: ");
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
  expect_refusal({"integration.distribution=[1]"}, "expected one for each level (2 in body.levels), got a list of 1");
  expect_refusal({"body.levels.1.box.origin=[1, 0, 0]"}, "do not overlap, they are 0.9 m apart");
  expect_refusal({"body.initial={twist: {from: [0, 0, 0], to: [0, 0, 0], angular_velocity: 3}}"},
                 "body.initial.twist.to, as a distance from .from, is 0");
  expect_refusal({"body.initial={parts: [{sphere: {centre: [9, 9, 9], radius: 1}, velocity: [0, 0, 1]}]}"},
                 "body.initial.parts.0");
  expect_refusal({"body.initial={parts: [{group: tip, velocity: [0, 0, 1]}]}"},
                 "body.initial.parts.0.group: there is no group 'tip': the meshes name none");
}

TEST_F(Levels, WarnsWhereTheyDoNotCoarsen) {
  for (const char* command : {"run", "explain", "check"}) {
    const Child child = plica(command, {"body.levels.1.box.cells=[4, 4, 4]", "duration=1 ms"});
    EXPECT_EQ(child.status, 0) << child.errors;
    EXPECT_NE(child.errors.find("level 1 is not coarser than level 0: 384 tetrahedra after 384"), std::string::npos)
        << child.errors;
    EXPECT_EQ(plica(command, {"duration=1 ms"}).errors.find("coarser"), std::string::npos);
  }
}

// What the fuzzer of scenes starts from, and what it once found, without libFuzzer

TEST(FuzzScenes, AreRefusedOrSound) {
  for (const plica::fuzz::Target& target : plica::fuzz::scene_targets) EXPECT_GE(plica::fuzz::replay(target), 3);
}

}  // namespace
}  // namespace plica::app::test
