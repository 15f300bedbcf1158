// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "unit/app/child.hpp"

// What the program says of cycle auto, and what it keeps.
namespace plica::app::test {
namespace {

// Two levels of a beam that sags and swings
constexpr const char* swinging_beam = R"(duration: 50 ms
gravity: [0, 0, -9.81]
body:
  levels:
    - {box: {size: [0.4, 0.1, 0.1], cells: [12, 4, 4]}}
    - {box: {size: [0.4, 0.1, 0.1], cells: [6, 3, 3]}}
  material: {model: corotational, young_modulus: 3 MPa, poisson_ratio: 0.35}
  fixed: [{box: {min: [-1, -1, -1], max: [0, 1, 1]}}]
integration: {cycle: auto, error_class: interactive}
output: {every: 1 s}
)";

class CycleAuto : public ProgramTest {
 protected:
  CycleAuto() : ProgramTest(swinging_beam) {}
  Child begin(const std::string& into, const std::vector<std::string>& more) {
    return plica({"run", scene, "-o", folder / into, "--quiet", "--threads", "1"}, more);
  }
  Json choice_of(const std::string& run) const { return json_of(run + "/summary.json")["choice"]; }
};

TEST_F(CycleAuto, IsExplained) {
  const Child text = plica({"explain", scene});
  ASSERT_EQ(text.status, 0) << text.errors;
  EXPECT_NE(text.output.find("Cycle auto"), std::string::npos) << text.output;
  EXPECT_NE(text.output.find("interactive: the run is short"), std::string::npos) << text.output;
  const Json json = Json::parse(plica({"explain", scene, "--json"}).output),
             choice = json["choice"];
  EXPECT_EQ(json["cycle"], "single");
  EXPECT_EQ(json["cycle"], choice["cycle"]);
  EXPECT_EQ(json["macro_step"], choice["macro_step"]);
  EXPECT_EQ(choice["error_class"], "interactive");
  EXPECT_EQ(choice["trials"], Json::array()) << "a cheap run tries nothing";
  EXPECT_EQ(choice["single_time"], 0) << "nor times anything";
  const Json named = Json::parse(
      plica({"explain", scene, "--json", "--set", "integration={cycle: single}"}).output);
  EXPECT_TRUE(named["choice"].is_null());
  const Child run = plica({"run", scene, "-o", out});
  ASSERT_EQ(run.status, 0) << run.errors;
  EXPECT_NE(run.output.find("the keys {cycle: single, macro_step: auto} of"), std::string::npos)
      << run.output;
  EXPECT_EQ(choice_of("out"), choice);
}

TEST_F(CycleAuto, CheckSaysWhatWouldBeTried) {
  const auto checked = [&](const char* duration) {
    const Child child = plica({"check", scene, "--json", "--duration", duration});
    EXPECT_EQ(child.status, 0) << child.errors;
    return Json::parse(child.output);
  };
  EXPECT_EQ(checked("1 ms")["levels"].size(), 1u) << "level 0 alone is set up";
  EXPECT_NE(checked("1 ms")["cycle_auto"].get<std::string>().find("takes single: the run is short"),
            std::string::npos);
  EXPECT_NE(
      checked("1e7 s")["cycle_auto"].get<std::string>().find("it tries him at 8 critical steps"),
      std::string::npos)
      << "of a run that would take years";
  const Child text = plica({"check", scene});
  EXPECT_NE(text.output.find("cycle auto: a run takes single"), std::string::npos) << text.output;
  const Child named = plica({"check", scene, "--json", "--set", "integration={cycle: him}"});
  EXPECT_TRUE(Json::parse(named.output)["cycle_auto"].is_null());
  const Child refused = plica({"check", scene, "--set", "integration.macro_step=1 ms"});
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(refused.errors.find("cycle auto chooses the macro step; leave it out"),
            std::string::npos)
      << refused.errors;
}

TEST_F(CycleAuto, IsRepeatedByItsKeys) {
  ASSERT_EQ(begin("chosen", {"--duration", "40 s"}).status, 0);
  const Json choice = choice_of("chosen");
  ASSERT_FALSE(choice["trials"].empty() && choice["single_time"] == 0) << choice;
  const std::string keys = "integration={" + choice["keys"].get<std::string>() + "}";
  ASSERT_EQ(begin("named", {"--duration", "40 s", "--set", keys}).status, 0);
  EXPECT_TRUE(choice_of("named").is_null());
  for (const char* file : {"history.csv", "frames/surface_0001.vtu", "frames/surface_0040.vtu"}) {
    const std::string path = file;
    ASSERT_NE(content_of(folder / ("chosen/" + path)), "") << path;
    EXPECT_TRUE(content_of(folder / ("chosen/" + path)) == content_of(folder / ("named/" + path)))
        << path << keys;
  }
}

// What is timed would be another number
TEST_F(CycleAuto, IsNotAskedAgainByARunThatGoesOn) {
  ASSERT_EQ(begin("run", {"--duration", "2 s", "--checkpoint", "every=1 s"}).status, 0);
  const Json before = choice_of("run");
  ASSERT_GT(before["single_time"].get<double>(), 0) << before;
  for (const char* duration : {"2 s", "2.5 s"}) {
    const Child rest = plica(
        {"run", "--resume", folder / "run", "--quiet", "--threads", "1", "--duration", duration});
    ASSERT_EQ(rest.status, 0) << rest.errors;
    EXPECT_EQ(choice_of("run"), before);
  }
}

}  // namespace
}  // namespace plica::app::test
