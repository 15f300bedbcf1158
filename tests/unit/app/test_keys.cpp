// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <plica/drivers/app/scene/key_list.hpp>
#include <plica/drivers/app/scene/tree.hpp>
#include <plica/drivers/app/scene/units.hpp>
#include <plica/drivers/run/registry.hpp>
#include <plica/drivers/run/simulation.hpp>
#include <regex>
#include <set>

#include "unit/app/child.hpp"
#include "unit/app/scene_text.hpp"

namespace plica::app::test {
namespace {

using Json = nlohmann::ordered_json;

TEST(KeyList, EveryKeyIsDescribed) {
  std::set<std::string> paths;
  for (const KeyInfo& key : scene_keys()) {
    EXPECT_FALSE(key.type_text.empty()) << key.path;
    EXPECT_FALSE(key.help.empty()) << key.path;
    EXPECT_TRUE(paths.insert(key.path).second) << key.path << " twice";
  }
  for (const char* path : {"duration", "body.levels[].box.cells", "body.material.young_modulus",
                           "body.regions.<name>.density", "integration.implicit.relative_residual",
                           "contact.obstacles[].bowl.rim", "output.every"})
    EXPECT_TRUE(paths.contains(path)) << path;
}

TEST(KeyList, SaysUnitRangeAndDefault) {
  for (const KeyInfo& key : scene_keys()) {
    if (key.path != "body.material.young_modulus") continue;
    EXPECT_EQ(key.type_text, "a pressure (Pa) in [1e-06, 1e+15] Pa");
    EXPECT_EQ(key.otherwise, "20000 Pa");
  }
}

// The automatic step of him is another one than that of the other cycles.
TEST(KeyList, SaysWhatTheAutomaticStepIs) {
  const auto& keys = scene_keys();
  const auto key = std::ranges::find(keys, "integration.macro_step", &KeyInfo::path);
  ASSERT_NE(key, keys.end());
  EXPECT_NE(key->help.find("8 critical steps of the finest level, or 4 with contact"),
            std::string::npos)
      << key->help;
  using Host = Backend<double, Kokkos::DefaultHostExecutionSpace>;
  const auto over_critical = [](const std::string& obstacles) {
    const Scene scene =
        scene_of(sound_scene, {"integration={cycle: him}", "contact.obstacles=" + obstacles});
    const Simulation<Host> s(scene.problem);
    return s.him()->usual_step / s.levels().front().critical_step;
  };
  EXPECT_NEAR(over_critical("[]"), 8, 0.1);
  EXPECT_NEAR(over_critical("[{plane: {point: [0, 0, -0.1]}}]"), 4, 0.05);
}

TEST(KeyList, HasEveryObstacleShape) {
  for (const Choice& shape : obstacle_shapes()) {
    const std::string path = "contact.obstacles[]." + shape.name;
    const auto& keys = scene_keys();
    EXPECT_TRUE(std::any_of(keys.begin(), keys.end(), [&](const KeyInfo& key) {
      return key.path == path;
    })) << path;
  }
}

// A scene as an editor sees it: with numbers and truth values
Json typed(const Json& words) {
  if (words.is_string()) {
    const std::string text = words.get<std::string>();
    if (text == "true" || text == "false") return text == "true";
    const auto number = parse_number(text);
    if (number && *number == std::floor(*number) && std::abs(*number) < 1e9)
      return static_cast<long>(*number);
    return number ? Json(*number) : words;
  }
  Json result = words;
  for (auto& item : result) item = typed(item);
  return result;
}

// The schema of "body.levels[].box.cells" or "body.regions.<name>.density"
const Json* schema_at(const Json& schema, const std::string& path) {
  const Json* at = &schema;
  std::istringstream parts(path);
  for (std::string part; std::getline(parts, part, '.');) {
    const bool list = part.ends_with("[]");
    if (list) part.resize(part.size() - 2);
    const char* inside = part == "<name>" ? "additionalProperties" : "properties";
    if (at->contains("anyOf"))  // a word or a map
      for (const Json& one : at->at("anyOf"))
        if (one.contains(inside)) at = &one;
    if (!at->contains(inside)) return nullptr;
    at = &at->at(inside);
    if (part != "<name>") {
      if (!at->contains(part)) return nullptr;
      at = &at->at(part);
    }
    if (list) at = &at->at("items");
  }
  return at;
}

TEST(Schema, HasEveryKey) {
  const Json schema = scene_schema();
  for (const KeyInfo& key : scene_keys()) {
    const Json* at = schema_at(schema, key.path);
    ASSERT_NE(at, nullptr) << key.path;
    EXPECT_TRUE(at->contains("description")) << key.path;
  }
  EXPECT_EQ(schema["required"], Json({"duration"}));
  EXPECT_EQ(schema["allOf"].at(0).at("oneOf").size(), 2);  // body or bodies
  const Json* one = schema_at(schema, "bodies.<name>");
  EXPECT_EQ(one->at("required"), schema_at(schema, "body")->at("required"));
  EXPECT_EQ(one->at("properties").at("integration").at("$ref"), "#/properties/integration");
  EXPECT_FALSE(schema_at(schema, "body")->at("properties").contains("integration"));
  EXPECT_EQ(schema_at(schema, "body.levels[]")->at("allOf").at(0).at("oneOf").size(), 8);
}

bool fits(const Dimension& dimension, const std::string& unit) {
  return std::regex_match(unit, std::regex(unit_pattern(dimension)));
}

TEST(Schema, UnitsOfADimension) {
  for (const char* unit : {"m", "cm", "km", "um"}) EXPECT_TRUE(fits(length, unit)) << unit;
  for (const char* unit : {"Pa", "kPa", "mmHg", "bar", "N/m^2", "N / mm2", "J/m^3"})
    EXPECT_TRUE(fits(pressure, unit)) << unit;
  for (const char* unit : {"kg/m^3", "g/cm^3"}) EXPECT_TRUE(fits(density, unit)) << unit;
  for (const char* unit : {"1/s", "Hz", "kHz", "1/min"}) EXPECT_TRUE(fits(rate, unit)) << unit;
  for (const char* unit : {"m/s^2", "mm/ms2"}) EXPECT_TRUE(fits(acceleration, unit)) << unit;
  for (const char* unit : {"rad/s", "deg/s"}) EXPECT_TRUE(fits(angular_velocity, unit)) << unit;
  EXPECT_TRUE(fits(plain, "%"));
  const Dimension angular_damping{.mass = 1, .length = 2, .time = -1};
  for (const char* unit : {"kg*m^2/s", "J*s"}) EXPECT_TRUE(fits(angular_damping, unit)) << unit;
  for (const char* unit : {"s", "m/s", "metre", "m^2", "cPa", "%"})
    EXPECT_FALSE(fits(length, unit)) << unit;
  for (const char* unit : {"m", "m/s", "kg", "Hz/m"}) EXPECT_FALSE(fits(density, unit)) << unit;
}

class SchemaByPython : public testing::Test {
 protected:
  SchemaByPython() { std::ofstream(folder / "schema.json") << scene_schema().dump(); }
  // One line per scene: whether it fits; nothing where nobody can tell
  std::vector<std::string> verdicts(const std::vector<Tree>& scenes) {
    std::vector<std::string> words = {python(), PLICA_SOURCE_DIR "/tests/unit/app/validate.py",
                                      folder / "schema.json"};
    for (const Tree& scene : scenes) {
      words.push_back(folder / (std::to_string(words.size()) + ".json"));
      std::ofstream(words.back()) << typed(json_of(scene)).dump();
    }
    const Child child = run_child(words, folder);
    constexpr int no_jsonschema = 77, no_python = 127;
    std::vector<std::string> lines;
    if (child.status == no_jsonschema || child.status == no_python || child.status < 0)
      return lines;
    EXPECT_EQ(child.status, 0) << child.errors;
    std::istringstream text(child.output);
    for (std::string line; std::getline(text, line);) lines.push_back(line);
    EXPECT_EQ(lines.size(), scenes.size());
    return lines;
  }
  TemporaryFolder folder;
};

TEST_F(SchemaByPython, TakesSoundScenes) {
  std::vector<Tree> scenes = {parse_tree(sound_scene, "sound")};
  for (const auto& file :
       std::filesystem::recursive_directory_iterator(PLICA_SOURCE_DIR "/drivers/scenes"))
    if (file.path().extension() == ".yaml") scenes.push_back(read_tree(file.path()));
  ASSERT_GT(scenes.size(), 15);
  const auto say = verdicts(scenes);
  if (say.empty()) GTEST_SKIP() << "no Python with jsonschema here";
  for (std::size_t i = 0; i < say.size(); ++i) EXPECT_EQ(say[i], "yes") << scenes[i].where.file;
}

TEST_F(SchemaByPython, TakesWhatTheReaderTakes) {
  std::vector<Tree> scenes;
  for (const char* set :
       {"integration.substeps=[3, auto]", "integration.distribution=[0.25, 75 %]",
        "integration.macro_step=auto", "integration.integrator=[symplectic_euler, implicit_euler]",
        "body.surface={boundary: true}",
        "output={every: 10 steps, volume: [0, 1], probes: {tip: [0.1, 2 cm, 20 mm]}, probe_every: "
        "1 ms}",
        "output={volume: all, fields: [stress, pressure]}", "output.fields=contact_pressure",
        "output.volume=all", "body.damping.mass=0.5 1/s", "gravity=[0, 0, -981 cm/s^2]",
        "study.truth=true", "study.truth={refinements: 1}", "body.jitter=0.2", "body.order=hilbert",
        "contact.obstacles=[]"}) {
    scenes.push_back(parse_tree(sound_scene, set));
    override_value(scenes.back(), set, set);
    EXPECT_NO_THROW(check_scene(read_scene(scenes.back()), scenes.back())) << set;
  }
  const auto say = verdicts(scenes);
  if (say.empty()) GTEST_SKIP() << "no Python with jsonschema here";
  for (std::size_t i = 0; i < say.size(); ++i) EXPECT_EQ(say[i], "yes") << scenes[i].where.file;
}

TEST_F(SchemaByPython, RefusesBadScenes) {
  std::vector<Tree> scenes;
  for (const char* set : {"durtion=1 s",
                          "duration=4 cm",
                          "duration=0",
                          "duration=-1 s",
                          "gravity=[0, 0]",
                          "integration.cycle=rvs",
                          "body.levels=[]",
                          "body.levels.0={box: {size: [1, 1, 1], cells: [1, 1, 1]}, file: a.msh}",
                          "body.levels.0.box.cells=[4, 4, 0]",
                          "body.levels.0.box={size: [1, 1, 1]}",
                          "body.material.poisson_ratio=0.5",
                          "body.material.young_modulus=50 kpa",
                          "body=3",
                          "output={volume: some}",
                          "output={every: 0 steps}",
                          "output={probes: {a b: [0, 0, 0]}}",
                          "integration.substeps=0",
                          "study.truth={refinements: 0}",
                          "study.truth=1",
                          "body.jitter=0.5",
                          "body.order=file",
                          "body.levels.0={tube: {radius: 1, wall: 1, length: 1}}"}) {
    scenes.push_back(parse_tree(sound_scene, set));
    override_value(scenes.back(), set, set);
    EXPECT_THROW(check_scene(read_scene(scenes.back()), scenes.back()), InputError) << set;
  }
  const auto say = verdicts(scenes);
  if (say.empty()) GTEST_SKIP() << "no Python with jsonschema here";
  for (std::size_t i = 0; i < say.size(); ++i)
    EXPECT_TRUE(say[i].starts_with("no:")) << scenes[i].where.file;
}

}  // namespace
}  // namespace plica::app::test
