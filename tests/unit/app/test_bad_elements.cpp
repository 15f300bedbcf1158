// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <plica/drivers/app/output/plan.hpp>
#include <plica/drivers/app/output/summary.hpp>

#include "unit/app/scene_text.hpp"

// What is printed of elements that hold a step back, and of steps that were bad.
namespace plica::app::test {
namespace {

using Json = nlohmann::ordered_json;

LevelReport level_with(double worst) {
  LevelReport level;
  level.element_bound = worst, level.typical_element = 1e-3, level.critical_step = 1.1 * worst;
  level.share = 1, level.substeps = 1;
  level.stiffest = {{71, "bone", 25, worst}, {8, "", 1.9, 0.6e-3}};
  return level;
}

TEST(PlanText, NamesElementsThatAreOutOfTheOrdinary) {
  const Scene scene = scene_of(sound_scene);
  Plan plan;
  plan.macro_step = 1e-3, plan.levels = {level_with(0.04e-3)};
  const std::string text = plan_text(scene, plan);
  EXPECT_NE(text.find("Elements that hold the step back"), std::string::npos) << text;
  EXPECT_NE(text.find("71"), std::string::npos);
  EXPECT_NE(text.find("bone"), std::string::npos);
  EXPECT_EQ(text.find("0.6 ms"), std::string::npos) << text;  // more than half the median
  plan.levels = {level_with(0.55e-3)};
  EXPECT_EQ(plan_text(scene, plan).find("hold the step back"), std::string::npos);
}

TEST(LevelsJson, HaveTheStiffestElements) {
  const Json levels = levels_json({level_with(0.04e-3)});
  EXPECT_EQ(levels[0]["typical_element"], 1e-3);
  ASSERT_EQ(levels[0]["stiffest"].size(), 2u);
  EXPECT_EQ(levels[0]["stiffest"][0],
            (Json{{"element", 71}, {"region", "bone"}, {"height_ratio", 25}, {"step", 0.04e-3}}));
}

TEST(Keys, OfBadStatesAndSteps) {
  const Scene scene = scene_of(sound_scene, {"body.initial.stretch=[1, 0, -1]", "body.material.allow_inversion=true",
                                             "integration.retry.halvings=3"});
  EXPECT_EQ(scene.problem.body.initial.stretch, Point(1, 0, -1));
  EXPECT_EQ(scene.problem.body.material.allow_inversion, true);
  EXPECT_EQ(scene.problem.integration.retry.halvings, 3);
  EXPECT_EQ(scene_of(sound_scene, {"body.initial.random=7"}).problem.body.initial.random, 7);
  EXPECT_FALSE(scene_of(sound_scene).problem.body.material.allow_inversion);
  EXPECT_NE(error_of(sound_scene, {"body.initial.random=seven"}).find("body.initial.random"), std::string::npos);
}

}  // namespace
}  // namespace plica::app::test
