// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <plica/drivers/app/scene/older_keys.hpp>

#include "support/refusal.hpp"
#include "unit/app/scene_text.hpp"

// Keys that have an older name: the scene is the same by either, and the older one is answered with
// a warning.
namespace plica::app::test {
namespace {

const std::string older = R"(duration: 1 s
body:
  levels: [{box: {size: [0.1, 0.1, 0.1], cells: [2, 2, 2]}}]
  pressure: smoothed
  material: {model: neo_hookean, young_modulus: 50 kPa}
  regions: {plane: {where: {plane: {normal: [1, 0, 0], point: [5 cm, 0, 0]}}, density: 900}}
  fixed: [{plane: {normal: [0, 0, 1]}}]
  prescribed:
    - {plane: {point: [0, 0, 0.1], normal: [0, 0, -1]},
       path: [{time: 0, displacement: [0, 0, 0]}, {time: 1 s, displacement: [0, 0, 1 mm]}]}
  loads: [{plane: {normal: [1, 0, 0]}, traction: [1 Pa, 0, 0], course: [{time: 1 s, factor: 2}]}]
  surface: {boundary: true}
contact:
  obstacles:
    - {plane: {point: [0, 0, -0.1]}, path: [{time: 0, displacement: [0, 0, 0]}]}
    - sphere: {centre: [0, 0, 1], radius: 1 cm}
      turn: {axis: [0, 0, 1], path: [{time: 0, angle: 0 deg}, {time: 1 s, angle: 90 deg}]}
integration: {macro_step: 1 ms}
output: {probes: {plane: [5 cm, 5 cm, 5 cm]}}
)";

Scene loaded(const std::string& text, const std::vector<std::string>& sets = {}) {
  Tree tree = parse_tree(text, "a.yaml");
  for (const std::string& set : sets) set_value(tree, set, "--set " + set);
  return load_scene(tree);
}

TEST(OlderKeys, SayTheSame) {
  const Scene scene = loaded(older);
  const Body& body = scene.problem.body;
  EXPECT_EQ(body.pressure, "smoothed");
  EXPECT_EQ(std::get<HalfSpaceSelection>(body.fixed.at(0).where).normal, Point::UnitZ());
  EXPECT_EQ(std::get<HalfSpaceSelection>(*body.regions.at("plane").where).point[0], 0.05);
  EXPECT_EQ(std::get<PathMotion>(body.prescribed.at(0).motion).knots.size(), 2u);
  EXPECT_EQ(std::get<PolygonCourse>(body.loads.at(0).course).knots.at(0).factor, 2);
  const auto& obstacles = scene.problem.contact.obstacles;
  EXPECT_EQ(std::get<PathMotion>(obstacles.at(0).motion).knots.size(), 1u);
  EXPECT_EQ(std::get<PathTurn>(obstacles.at(1).turn->angle).knots.size(), 2u);
  EXPECT_TRUE(scene.output.probes.contains("plane"));
}

TEST(OlderKeys, AreKnownWhereverTheyMayStand) {
  const auto present = [](const std::string& text) {
    Tree tree = parse_tree(text, "a.yaml");
    use_present_keys(tree);
    return json_of(tree).dump();
  };
  EXPECT_NE(present("bodies: {plane: {pressure: plain}}").find("volumetric_smoothing"),
            std::string::npos);
  for (const char* text :
       {"body: {initial: {parts: [{plane: {}}]}}", "body: {fibres: {from: {plane: {}}}}",
        "body: {fibres: {to: {plane: {}}}}", "attachments: [{where: {plane: {}}}]"})
    EXPECT_NE(present(text).find("half_space"), std::string::npos) << text;
}

TEST(OlderKeys, AreAnsweredByOneWarningEach) {
  std::vector<std::string> of_keys;
  for (const std::string& warning : loaded(older).warnings)
    if (warning.find("older name") != std::string::npos) of_keys.push_back(warning);
  const std::vector<std::string> expected = {
      "a.yaml:4: the key 'pressure' is called 'volumetric_smoothing'; the older name still works",
      "a.yaml:6: the key 'plane' is called 'half_space'; the older name still works",
      "a.yaml:10: the key 'path' is called 'curve'; the older name still works",
      "a.yaml:11: the key 'course' is called 'curve'; the older name still works",
      "a.yaml:17: the key 'turn' is called 'rotate'; the older name still works"};
  EXPECT_EQ(of_keys, expected);
}

TEST(OlderKeys, NoWarningForPresentOnes) {
  Tree tree = parse_tree(older, "a.yaml");
  use_present_keys(tree);
  tree = tree_of(json_of(tree), "a.yaml");
  for (const std::string& warning : load_scene(tree).warnings)
    EXPECT_EQ(warning.find("older name"), std::string::npos) << warning;
}

TEST(OlderKeys, AreSetByEitherName) {
  EXPECT_EQ(loaded(older, {"body.volumetric_smoothing=plain"}).problem.body.pressure, "plain");
  EXPECT_EQ(loaded(older, {"body.pressure=plain"}).problem.body.pressure, "plain");
  const auto turned = [](const std::string& set) {
    const Scene scene = loaded(older, {set});
    return scene.problem.contact.obstacles.at(1).turn->axis;
  };
  EXPECT_EQ(turned("contact.obstacles.1.turn.axis=[0, 1, 0]"), Point::UnitY());
  EXPECT_EQ(turned("contact.obstacles.1.rotate.axis=[0, 1, 0]"), Point::UnitY());
  EXPECT_EQ(turned("contact.obstacles.1={sphere: {radius: 1 cm}, turn: {axis: [1, 0, 0]}}"),
            Point::UnitX());
}

TEST(OlderKeys, OfOneKeyOnlyOneName) {
  std::string both = older;
  both.replace(both.find("pressure:"), 9, "volumetric_smoothing: auto\n  pressure:");
  EXPECT_EQ(plica::test::refusal([&] { loaded(both); }),
            "a.yaml:5: body.pressure: 'pressure' is an older name of 'volumetric_smoothing'; "
            "expected one of them");
}

}  // namespace
}  // namespace plica::app::test
