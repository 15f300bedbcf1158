// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/drivers/app/scene/key_list.hpp>
#include <plica/drivers/solver/registry.hpp>
#include <set>

namespace plica::app {
namespace {

TEST(KeyList, EveryKeyIsDescribed) {
  std::set<std::string> paths;
  for (const KeyInfo& key : scene_keys()) {
    EXPECT_FALSE(key.expects.empty()) << key.path;
    EXPECT_FALSE(key.help.empty()) << key.path;
    EXPECT_TRUE(paths.insert(key.path).second) << key.path << " twice";
  }
  for (const char* path :
       {"duration", "body.levels[].box.cells", "body.material.young_modulus", "body.regions.<name>.density",
        "integration.implicit.relative_residual", "contact.obstacles[].bowl.rim", "output.every"})
    EXPECT_TRUE(paths.contains(path)) << path;
}

TEST(KeyList, SaysUnitRangeAndDefault) {
  for (const KeyInfo& key : scene_keys()) {
    if (key.path != "body.material.young_modulus") continue;
    EXPECT_EQ(key.expects, "a pressure (Pa) > 0");
    EXPECT_EQ(key.otherwise, "20000 Pa");
  }
}

TEST(KeyList, HasEveryObstacleShape) {
  for (const Choice& shape : obstacle_shapes()) {
    const std::string path = "contact.obstacles[]." + shape.name;
    const auto& keys = scene_keys();
    EXPECT_TRUE(std::any_of(keys.begin(), keys.end(), [&](const KeyInfo& key) { return key.path == path; })) << path;
  }
}

}  // namespace
}  // namespace plica::app
