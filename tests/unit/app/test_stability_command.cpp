// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <plica/drivers/app/commands/commands.hpp>
#include <plica/drivers/app/output/stability_table.hpp>
#include <plica/drivers/app/output/verify_table.hpp>
#include <set>
#include <sstream>

#include "unit/app/child.hpp"

namespace plica::app::test {
namespace {

class StabilityCommand : public ProgramTest {
 protected:
  StabilityCommand()
      : ProgramTest(small_beam(
            "linear",
            "study: {methods: [single/symplectic_euler, single/implicit_euler, coarse/1, "
            "cycle/rs/equal, cycle/rv/equal, cycle/him]}\n")) {}
  Child stability(const std::vector<std::string>& more = {},
                  const std::function<bool(pid_t)>& meanwhile = {}) {
    return plica({"stability", scene, "-o", out}, more, meanwhile);
  }
  Json json() const { return json_of("out/stability.json"); }
  Json row(const std::string& method) const {
    const Json all = json();
    for (const Json& one : all["rows"])
      if (one["method"] == method) return one;
    return {};
  }
};

TEST_F(StabilityCommand, SaysWhatItPredictedAndMeasured) {
  const Child run = stability();
  ASSERT_EQ(run.status, 0) << run.errors;
  EXPECT_EQ(json()["status"], "completed");
  EXPECT_EQ(json()["tets"], Json({192, 24}));
  EXPECT_TRUE(json()["machine"]["cpu"].is_string());
  for (const char* method : {"single/symplectic_euler", "coarse/1", "cycle/rs", "cycle/him"}) {
    const Json one = row(method);
    EXPECT_EQ(one["status"], "limited") << method;
    EXPECT_NEAR(one["ratio"].get<double>(), 1, one["integrator"].is_string() ? 0.02 : 0.1)
        << method;
    EXPECT_DOUBLE_EQ(one["ratio"], one["measured"].get<double>() / one["predicted"].get<double>());
    EXPECT_NE(run.output.find(method), std::string::npos);
  }
  EXPECT_EQ(row("cycle/rs")["distribution"], "equal");
  EXPECT_EQ(row("cycle/rv")["status"], "growing");
  EXPECT_EQ(row("cycle/rv")["predicted"], 0);
  EXPECT_GT(row("cycle/rv")["growth_per_second"], 0);
  EXPECT_EQ(row("single/implicit_euler")["status"], "unlimited");
  EXPECT_TRUE(row("single/implicit_euler")["predicted"].is_null() &&
              row("single/implicit_euler")["measured"].is_null());
  EXPECT_NE(run.output.find("none up to"), std::string::npos);
}

TEST_F(StabilityCommand, RowsOfJsonAndCsvHaveTheSameFields) {
  ASSERT_EQ(
      stability({"--quiet", "--set", "study.methods=[single/symplectic_euler, cycle/rv/equal]",
                 "--set", "body.material.model=st_venant_kirchhoff"})
          .status,
      0);
  std::istringstream csv(content_of(folder / "out/stability.csv"));
  std::string names, line;
  std::getline(csv, names);
  const std::set<std::string> fields = {"method",
                                        "distribution",
                                        "variant",
                                        "integrator",
                                        "status",
                                        "reason",
                                        "critical_step",
                                        "predicted",
                                        "measured",
                                        "ratio",
                                        "stable_up_to",
                                        "growth_step",
                                        "spectral_radius",
                                        "growth_per_second",
                                        "scene_measured",
                                        "scene_failed_step",
                                        "scene_failed_time",
                                        "scene_reason",
                                        "scene_kind",
                                        "scene_region",
                                        "scene_level",
                                        "scene_element",
                                        "scene_vertex",
                                        "scene_J"};
  std::set<std::string> columns;
  std::istringstream split(names);
  for (std::string name; std::getline(split, name, ',');) columns.insert(name);
  EXPECT_EQ(columns, fields);
  int lines = 0;
  while (std::getline(csv, line)) ++lines;
  EXPECT_EQ(lines, 2);
  const Json all = json();
  for (const Json& one : all["rows"]) {
    std::set<std::string> members;
    for (const auto& [name, value] : one.items()) members.insert(name);
    EXPECT_EQ(members, fields);
    EXPECT_TRUE(one["scene_measured"].is_number()) << "it is not linear: its own runs too";
  }
}

TEST_F(StabilityCommand, BadInputIs2) {
  const auto refuses = [&](const std::vector<std::string>& words, const std::string& text) {
    const Child run = plica({"stability"}, words);
    EXPECT_EQ(run.status, 2);
    EXPECT_NE(run.errors.find(text), std::string::npos) << run.errors;
  };
  refuses({scene, "-o", out, "--set", "study.methods=cycle/rvs"}, "did you mean 'cycle/rsv'");
  refuses({scene, "-o", out, "--set", "study.methods=single/euller"},
          "did you mean 'single/euler'");
  refuses({scene, "-o", out, "--budget", "soon"}, "--budget");
  refuses({scene, "-o", out, "--budgte", "1s"}, "--budgte");
  refuses({}, "SCENE, or --matrix");
  refuses({"--matrix", scene}, "--matrix has its own bodies");
  refuses({"--matrix", "--set", "gravity=[0, 0, 0]"}, "--matrix has its own bodies");
  EXPECT_FALSE(std::filesystem::exists(folder / "out/stability.json"));
}

TEST_F(StabilityCommand, HelpsWithAnExample) {
  const Child help = plica({"stability", "--help"});
  EXPECT_EQ(help.status, 0);
  for (const char* word : {"--matrix", "--budget", "Exit status", "plica stability beam.yaml"})
    EXPECT_NE(help.output.find(word), std::string::npos) << word;
}

TEST_F(StabilityCommand, StopsWithItsBudgetAndAtCtrlCWithWholeFiles) {
  const Child late = plica({"stability", "--matrix", "-o", out, "--budget", "200ms"});
  EXPECT_EQ(late.status, 0) << late.output << late.errors;
  EXPECT_GT(json()["left_out"], 0);
  EXPECT_GT(json()["rows"].size(), 0U);
  const Json all = json();
  for (const Json& one : all["rows"]) {
    EXPECT_TRUE(one["ok"]) << one;
    for (const char* name : {"case", "method", "expected", "outcome"})
      EXPECT_TRUE(one[name].is_string()) << name;
  }
  std::filesystem::remove_all(out);
  const Child run = plica({"stability", "--matrix", "-o", out}, [&](pid_t id) {
    return std::filesystem::exists(out + "/stability.json") && kill(id, SIGINT) == 0;
  });
  EXPECT_EQ(run.status, 130) << run.errors;
  EXPECT_EQ(json()["status"], "interrupted");
  EXPECT_TRUE(content_of(folder / "out/stability.csv").starts_with("case,method,expected,"));
}

// Whoever reads a table while it is made finds its head at once.
TEST(StabilityMatrix, TablesHaveAHeadWithoutRows) {
  EXPECT_EQ(stability_texts({"cpu", 2, "Serial", 1}, MatrixResult{}, "unfinished").csv,
            "case,method,expected,outcome,ok,detail,why\n");
  EXPECT_EQ(stability_texts(Scene{}, {"cpu", 2, "Serial", 1}, StabilityResult{}, "unfinished")
                .csv.find("method,distribution,variant,integrator,status,"),
            0U);
  EXPECT_EQ(verify_csv({}),
            "problem,quantity,unit,element,mesh,accepted,source,size,value,limit,order,judged,"
            "tolerance,outcome,ok,note\n");
}

TEST(StabilityMatrix, AWrongRowIsSaidAndFails) {
  MatrixResult result;
  result.rows = {{"a", "single/rk4", "completed", "completed", true, ""}};
  EXPECT_EQ(status_of(result), ExitStatus::done);
  result.rows.push_back(
      {"b", "cycle/him", "completed", "stopped: energy", false, "too much \"of\" it"});
  EXPECT_EQ(status_of(result), ExitStatus::failed);
  const std::string text = stability_text(result, "out");
  EXPECT_NE(text.find("Wrong, 1"), std::string::npos);
  EXPECT_NE(text.find("b, cycle/him: stopped: energy; expected completed"), std::string::npos);
  const StabilityTexts files = stability_texts({"cpu", 2, "Serial", 1}, result, "completed");
  EXPECT_FALSE(Json::parse(files.json)["ok"].get<bool>());
  EXPECT_NE(files.csv.find("\"too much \"\"of\"\" it\""), std::string::npos) << files.csv;
}

TEST_F(StabilityCommand, CanBeDrawn) {
  if (run_child({python(), "-c", "import matplotlib"}, folder).status != 0)
    GTEST_SKIP() << "no Python with Matplotlib";
  ASSERT_EQ(stability({"--quiet", "--set", "study.methods=[single, cycle/rv/equal]"}).status, 0);
  const Child draw =
      run_child({python(), PLICA_SOURCE_DIR "/drivers/plots/stability.py", out}, folder);
  EXPECT_EQ(draw.status, 0) << draw.errors;
  EXPECT_GT(std::filesystem::file_size(folder / "out/stability.png"), 10000U);
}

class VerifyCommand : public ProgramTest {
 protected:
  VerifyCommand() : ProgramTest("") {}
  Child verify(const std::vector<std::string>& more,
               const std::function<bool(pid_t)>& meanwhile = {}) {
    return plica({"verify", "-o", out}, more, meanwhile);
  }
};

TEST_F(VerifyCommand, WritesTheTable) {
  const Child run = verify({"--small", "uniaxial_tension", "rigid_motion"});
  ASSERT_EQ(run.status, 0) << run.errors;
  const Json json = Json::parse(content_of(folder / "out/verify.json"));
  EXPECT_EQ(json["status"], "completed");
  EXPECT_EQ(json["ok"], true);
  for (const char* name : {"cpu", "backend", "threads", "compiler", "version", "git_revision"})
    EXPECT_TRUE(json["machine"].contains(name)) << name;
  ASSERT_EQ(json["rows"].size(), 4U);
  for (const Json& row : json["rows"]) {
    EXPECT_EQ(row["ok"], true);
    for (const char* name : {"problem", "quantity", "unit", "source", "judged", "outcome"})
      EXPECT_TRUE(row.at(name).is_string()) << name;
    for (const char* name : {"accepted", "limit", "order", "note", "tolerance"})
      EXPECT_TRUE(row.contains(name)) << name;
    EXPECT_FALSE(row["ours"].empty());
    for (const Json& value : row["ours"])
      EXPECT_TRUE(value["mesh"].is_string() && value["size"].is_number() &&
                  value["value"].is_number());
  }
  EXPECT_EQ(json["rows"][2]["problem"], "uniaxial_tension");
  EXPECT_NEAR(double(json["rows"][2]["ours"][0]["value"]), 1e-3, 1e-12);
  const std::string csv = content_of(folder / "out/verify.csv"),
                    table = content_of(folder / "out/verify.md");
  EXPECT_EQ(csv.find("problem,quantity,unit,element,mesh,accepted,"), 0U);
  EXPECT_NE(
      table.find("| uniaxial_tension | strain along | linear | regular | 0.001 | p/E (Hooke) |"),
      std::string::npos)
      << table;
  for (const char* words : {"uniaxial_tension", "strain along", "4 rows, 0 not ok", "verify.md"})
    EXPECT_NE(run.output.find(words), std::string::npos) << run.output;
}

TEST_F(VerifyCommand, RefusesWhatItDoesNotKnow) {
  const Child wrong = verify({"uniaxial_tensoin"});
  EXPECT_EQ(wrong.status, 2);
  EXPECT_NE(wrong.errors.find("did you mean 'uniaxial_tension'?"), std::string::npos)
      << wrong.errors;
  EXPECT_FALSE(std::filesystem::exists(out));
  EXPECT_EQ(verify({"--budget", "1s"}).status, 2);
  EXPECT_EQ(verify({"--threads", "0"}).status, 2);
}

TEST_F(VerifyCommand, InterruptedLeavesWholeFiles) {
  const Child run = verify({"--quiet"}, [&](pid_t id) {
    if (!std::filesystem::exists(folder / "out/verify.md")) return false;
    kill(id, SIGINT);
    return true;
  });
  EXPECT_EQ(run.status, 130) << run.errors;
  const Json json = Json::parse(content_of(folder / "out/verify.json"));
  EXPECT_EQ(json["status"], "interrupted");
  EXPECT_FALSE(json["rows"].empty());
  EXPECT_TRUE(run.output.empty()) << run.output;
}

TEST_F(VerifyCommand, HelpNamesEveryProblem) {
  const Child help = run_child({PLICA_EXECUTABLE, "verify", "--help"}, folder);
  EXPECT_EQ(help.status, 0);
  for (const std::string& name : names(verify_problems()))
    EXPECT_NE(help.output.find("  " + name + " "), std::string::npos) << name;
}

TEST(VerifyTable, SaysWhatIsWrong) {
  VerifyRow row;
  row.problem = "p", row.quantity = "q", row.unit = "m", row.judged = Judged::finest,
  row.accepted = 1;
  row.tolerance = 0.01, row.source = "s", row.note = "n", row.add("2x2x2", 1, 1.5);
  judge(row);
  VerifyResult result;
  result.rows = {row};
  VerifyHead head;
  head.status = "completed";
  EXPECT_NE(verify_markdown(head, result)
                .find("| p | q [m] | linear | regular | 1 m | s | 2x2x2: 1.5 |  |  | finest within "
                      "1 % | not ok | n |"),
            std::string::npos)
      << verify_markdown(head, result);
  EXPECT_NE(verify_text(result, "out").find("1 row, 1 not ok"), std::string::npos);
}

}  // namespace
}  // namespace plica::app::test
