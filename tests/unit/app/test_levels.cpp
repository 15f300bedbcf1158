// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "unit/app/child.hpp"
#include "unit/app/scene_text.hpp"
#include "unit/app/temporary_folder.hpp"

// What the program says to hierarchies and cycles that make no sense: exit 2, and nothing is run.
namespace plica::app::test {
namespace {

class Levels : public testing::Test {
 protected:
  Levels() { std::ofstream(folder / "a.yaml") << sound_scene; }
  Child plica(const std::string& command, const std::vector<std::string>& set) {
    std::vector<std::string> words = {PLICA_EXECUTABLE, command, folder / "a.yaml"};
    if (command == "run") words.insert(words.end(), {"-o", folder / "out"});
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

}  // namespace
}  // namespace plica::app::test
