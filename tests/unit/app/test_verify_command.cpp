// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <plica/drivers/app/output/verify_table.hpp>

#include "unit/app/child.hpp"

namespace plica::app::test {
namespace {

using Json = nlohmann::json;

class VerifyCommand : public testing::Test {
 protected:
  Child verify(std::vector<std::string> more, const std::function<bool(pid_t)>& meanwhile = {}) {
    std::vector<std::string> words = {PLICA_EXECUTABLE, "verify", "-o", out};
    words.insert(words.end(), more.begin(), more.end());
    return run_child(words, folder, meanwhile);
  }

  TemporaryFolder folder;
  std::string out = folder / "out";
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
      EXPECT_TRUE(value["mesh"].is_string() && value["size"].is_number() && value["value"].is_number());
  }
  EXPECT_EQ(json["rows"][2]["problem"], "uniaxial_tension");
  EXPECT_NEAR(double(json["rows"][2]["ours"][0]["value"]), 1e-3, 1e-12);
  const std::string csv = content_of(folder / "out/verify.csv"), table = content_of(folder / "out/verify.md");
  EXPECT_EQ(csv.find("problem,quantity,unit,accepted,"), 0U);
  EXPECT_NE(table.find("| uniaxial_tension | strain along | 0.001 | p/E (Hooke) |"), std::string::npos) << table;
  for (const char* words : {"uniaxial_tension", "strain along", "4 rows, 0 not ok", "verify.md"})
    EXPECT_NE(run.output.find(words), std::string::npos) << run.output;
}

TEST_F(VerifyCommand, RefusesWhatItDoesNotKnow) {
  const Child wrong = verify({"uniaxial_tensoin"});
  EXPECT_EQ(wrong.status, 2);
  EXPECT_NE(wrong.errors.find("did you mean 'uniaxial_tension'?"), std::string::npos) << wrong.errors;
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
  row.problem = "p", row.quantity = "q", row.unit = "m", row.judged = Judged::finest, row.accepted = 1;
  row.tolerance = 0.01, row.source = "s", row.note = "n", row.add("2x2x2", 1, 1.5);
  judge(row);
  VerifyResult result;
  result.rows = {row};
  VerifyHead head;
  head.status = "completed";
  EXPECT_NE(
      verify_markdown(head, result).find("| p | q [m] | 1 m | s | 2x2x2: 1.5 |  |  | finest within 1 % | not ok | n |"),
      std::string::npos)
      << verify_markdown(head, result);
  EXPECT_NE(verify_text(result, "out").find("1 row, 1 not ok"), std::string::npos);
}

}  // namespace
}  // namespace plica::app::test
