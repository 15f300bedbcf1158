// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <numbers>
#include <plica/drivers/solver/simulation.hpp>
#include <plica/kernels/contact/shapes.hpp>

#include "support/backends.hpp"
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
  EXPECT_TRUE(scene.warnings.empty());
  EXPECT_NO_THROW(Simulation<plica::test::Host>{scene.problem});
}

INSTANTIATE_TEST_SUITE_P(All, ShippedScene, testing::ValuesIn(shipped_scenes()), [](const auto& one) {
  std::string name = one.param;
  std::ranges::replace(name, '/', '_');
  return name;
});

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
  EXPECT_EQ(count, 8);
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

}  // namespace
}  // namespace plica::app::test
