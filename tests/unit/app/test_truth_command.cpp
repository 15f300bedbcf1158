// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <plica/drivers/app/output/study_files.hpp>
#include <plica/drivers/app/output/truth_report.hpp>

#include "unit/app/child.hpp"

// plica study --truth
namespace plica::app::test {
namespace {

using Json = nlohmann::json;

constexpr const char* small_beam = R"(duration: 50 ms
gravity: [0, 0, -9.81]
body:
  levels:
    - {box: {size: [0.4, 0.1, 0.1], cells: [8, 2, 2]}}
    - {box: {size: [0.4, 0.1, 0.1], cells: [4, 1, 1]}}
  material: {model: neo_hookean, young_modulus: 1 MPa, poisson_ratio: 0.3}
  fixed: [{half_space: {normal: [1, 0, 0]}}]
output: {probes: {tip: [0.4, 0.05, 0.05]}}
study:
  methods: [single/symplectic_euler, coarse, coarse/1/rk4]
  samples: 5
  timed_runs: 0
)";

class TruthCommand : public testing::Test {
 protected:
  TruthCommand() { std::ofstream(scene) << small_beam; }

  Child study(std::vector<std::string> more) {
    std::vector<std::string> words = {PLICA_EXECUTABLE, "study", scene, "-o", out};
    words.insert(words.end(), more.begin(), more.end());
    return run_child(words, folder);
  }
  Json json() const { return Json::parse(content_of(folder / "out/study.json")); }

  TemporaryFolder folder;
  std::string scene = folder / "beam.yaml", out = folder / "out";
};

TEST_F(TruthCommand, WritesTheTruthAndEachRowsParts) {
  const Child run = study({"--truth", "--set", "study.truth.refinements=1"});
  ASSERT_EQ(run.status, 0) << run.errors;
  const Json written = json(), reference = written["reference"], truth = reference.at("truth");
  EXPECT_EQ(reference["method"], "truth");
  EXPECT_EQ(reference["own_error"], truth["error"]);
  EXPECT_EQ(truth["family"]["meshes"].size(), 2u);
  EXPECT_EQ(truth["family"]["meshes"][1]["tets"], 1536);
  EXPECT_TRUE(truth["family"]["order"].is_number()) << "level 1 is a third mesh";
  EXPECT_EQ(truth["family"]["name"], "nodal");
  EXPECT_EQ(truth["check"]["name"], "linear");
  ASSERT_EQ(reference["meshes"].size(), 4u);
  ASSERT_EQ(written["rows"].size(), 8u);
  for (const Json& row : written["rows"]) {
    const double error = row["total_error"], space = row["space_error"], time = row["error"];
    EXPECT_LE(error, 1.000001 * (space + time));
    const int level = row["method"] == "single/symplectic_euler" ? 0 : 1;
    for (const Json& mesh : reference["meshes"]) {
      const bool same = mesh["element"] == row["element"] && mesh["level"] == level;
      EXPECT_TRUE(!same || space == mesh["error_space"]) << row;
    }
  }
  for (const char* words :
       {"Reference: the truth", "in space", "uncertain by 0.", "Explicit alone, nodal meshes"})
    EXPECT_NE(run.output.find(words), std::string::npos) << run.output;
  const std::string csv = content_of(folder / "out/study.csv");
  EXPECT_NE(csv.find(",total_error,space_error,"), std::string::npos);
  const Child again = study({"--truth", "--set", "study.truth.refinements=1"});
  EXPECT_NE(again.errors.find("going on with"), std::string::npos) << again.errors;
  EXPECT_EQ(json()["reference"], reference) << "found again";
}

TEST_F(TruthCommand, IsAKeyOfTheScene) {
  const Child run =
      study({"--set", "study.truth={refinements: 1, jitter: 0.1}", "--set", "body.jitter=0.2"});
  ASSERT_EQ(run.status, 0) << run.errors;
  EXPECT_TRUE(json()["reference"]["truth"]["family"]["order"].is_null())
      << "jittered levels are not nested";
  EXPECT_EQ(json()["reference"]["truth"]["check"]["name"], "nodal, jittered");
  EXPECT_NE(run.output.find("two meshes show no order"), std::string::npos) << run.output;
  EXPECT_NE(run.output.find("not good enough"), std::string::npos) << run.output;
  const Child without = study({"--force", "--set", "study.truth=false"});
  ASSERT_EQ(without.status, 0) << without.errors;
  EXPECT_FALSE(json()["reference"].contains("truth"));
  ASSERT_EQ(json()["rows"].size(), 4u);
  for (const Json& row : json()["rows"])
    EXPECT_TRUE(row["element"] == "nodal" && row["space_error"].is_null() &&
                row["total_error"].is_null());
}

// Level 1 alone is the fastest row within 5 %, and none is within 0.1 %
TEST_F(TruthCommand, ARunTakesWhatTheStudyChose) {
  ASSERT_EQ(study({"--truth", "--set", "body.levels.1.box.cells=[9, 2, 2]", "--set",
                   "study.methods=coarse"})
                .status,
            0);
  const Json chosen = json()["choices"][0];
  EXPECT_EQ(chosen["error_class"], "interactive");
  EXPECT_EQ(chosen["case"].get<std::string>().find("coarse/1"), 0u) << chosen;
  EXPECT_LT(chosen["error"].get<double>() + json()["reference"]["own_error"].get<double>(), 0.05);
  EXPECT_TRUE(json()["choices"][2]["case"].is_null());
  const auto chosen_run = [&](const std::string& error_class, const std::string& of) {
    return run_child({PLICA_EXECUTABLE, "run", of, "--study", out, "--set",
                      "integration.error_class=" + error_class, "-o", folder / "run"},
                     folder);
  };
  const Child run = chosen_run("interactive", scene);
  ASSERT_EQ(run.status, 0) << run.errors;
  EXPECT_NE(run.errors.find("interactive: coarse/1"), std::string::npos) << run.errors;
  const Json summary = Json::parse(content_of(folder / "run/summary.json"));
  ASSERT_EQ(summary["levels"].size(), 1u);
  EXPECT_EQ(summary["levels"][0]["tets"], 6 * 9 * 2 * 2);
  EXPECT_EQ(summary["levels"][0]["element"], "nodal");
  const auto refuses = [&](const Child& child, const char* words) {
    EXPECT_EQ(child.status, 2);
    EXPECT_NE(child.errors.find(words), std::string::npos) << child.errors;
  };
  refuses(chosen_run("accurate", scene), "nothing to take for integration.error_class accurate");
  refuses(chosen_run("sloppy", scene), "unknown error class 'sloppy'");
  std::filesystem::copy_file(scene, folder / "other.yaml");
  refuses(chosen_run("interactive", folder / "other.yaml"), "other.yaml");
}

TEST_F(TruthCommand, BadInputIs2) {
  const auto refuses = [&](const std::vector<std::string>& more, const std::string& words) {
    const Child run = study(more);
    EXPECT_EQ(run.status, 2);
    EXPECT_NE(run.errors.find(words), std::string::npos) << run.errors;
  };
  refuses({"--truth", "--space"}, "--space");
  refuses({"--space", "--set", "study.truth=true"}, "error in space");
  refuses({"--set", "study.truth=maybe"}, "true or false");
  refuses({"--set", "study.truth={refinement: 1}"}, "did you mean 'refinements'");
  refuses({"--set", "study.elements=nodl"}, "did you mean 'nodal'");
  refuses({"--set", "study.truth={refinements: 0}"}, "study.truth.refinements");
  refuses({"--set", "body.jitter=0.5"}, "body.jitter");
  refuses({"--truth", "--set", "study.methods=coarse/1/rk5"}, "did you mean 'coarse/1/rk");
  refuses({"--truth", "--budget", "1us"}, "left of the budget");
  EXPECT_FALSE(std::filesystem::exists(folder / "out/study.json"));
}

TEST_F(TruthCommand, CanBeDrawn) {
  if (run_child({python(), "-c", "import matplotlib"}, folder).status != 0)
    GTEST_SKIP() << "no Python with Matplotlib";
  ASSERT_EQ(study({"--truth", "--quiet", "--set", "study.truth.refinements=1"}).status, 0);
  const Child draw = run_child({python(), PLICA_SOURCE_DIR "/drivers/plots/study.py", out}, folder);
  EXPECT_EQ(draw.status, 0) << draw.errors;
  EXPECT_GT(std::filesystem::file_size(folder / "out/study.png"), 10000U);
}

TEST(TruthFile, ReadsBackWhatItWrote) {
  StudyReference r;
  r.method = "truth";
  r.trajectory = {{0.5}, {{{1, 2, 3}, {4, 5, 6}}}, {{{7, 8, 9}, {1, 0, 1}}}};
  r.probes = {{0.5}, {{{3, 2, 1}}}, {{{0, 0, 7}}}};
  r.truth = Truth{{"nodal", {{10, 1e-3, 2, 0.1}, {80, 5e-4, 30, 0.03}}, 1.9, 1.9, 0.02, 0.003},
                  {"linear", {}, {}, 2, 1, 1},
                  0.01,
                  1e-5};
  r.meshes = {{"nodal", 0, 1e-5, 0.02, r.trajectory}, {"linear", 1, 1e-4, 0.3, r.trajectory}};
  const auto back = parse_reference(reference_bytes(r, 7), 7);
  ASSERT_TRUE(back && back->truth);
  EXPECT_EQ(truth_columns().json(*back->truth), truth_columns().json(*r.truth));
  EXPECT_EQ(mesh_columns().json(back->meshes), mesh_columns().json(r.meshes));
  EXPECT_EQ(back->probes.u, r.probes.u);
  EXPECT_EQ(back->meshes[1].trajectory.v, r.trajectory.v);
  EXPECT_FALSE(parse_reference(reference_bytes(r, 7).substr(0, 900), 7));
}

// Time as 1/error^2: four times the time for half the error
TEST(TimeForError, IsMeasuredOrExtrapolated) {
  TruthFamily family;
  family.meshes = {{1, 1, 1, 0.4}, {8, 1, 16, 0.1}};
  EXPECT_TRUE(time_for(family, 0.2)->measured);
  EXPECT_EQ(time_for(family, 0.2)->seconds, 16);
  EXPECT_FALSE(time_for(family, 0.05)->measured);
  EXPECT_NEAR(time_for(family, 0.05)->seconds, 64, 1e-9);
  family.meshes[1].error = 0.5;
  EXPECT_FALSE(time_for(family, 0.05)) << "it does not fall";
}

}  // namespace
}  // namespace plica::app::test
