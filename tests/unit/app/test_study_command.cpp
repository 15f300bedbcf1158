// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <plica/drivers/app/output/study_files.hpp>
#include <set>

#include "unit/app/child.hpp"

namespace plica::app::test {
namespace {

class StudyCommand : public ProgramTest {
 protected:
  StudyCommand()
      : ProgramTest(
            small_beam("neo_hookean",
                       "study:\n  methods: [single/symplectic_euler, coarse, cycle/rs/equal]\n"
                       "  macro_steps: [auto, 40 ms]\n  samples: 10\n")) {}

  Child study(const std::vector<std::string>& more = {},
              const std::function<bool(pid_t)>& meanwhile = {}) {
    return plica({"study", scene, "-o", out}, more, meanwhile);
  }
  Json json() const { return json_of("out/study.json"); }
};

void expect_number_or_null(const Json& row, const char* name, bool number) {
  ASSERT_TRUE(row.contains(name)) << name;
  EXPECT_TRUE(number ? row[name].is_number() : row[name].is_null()) << name << ": " << row[name];
}

void expect_row(const Json& row) {
  const std::string status = row.at("status");
  EXPECT_TRUE(std::set<std::string>({"completed", "diverged", "refused"}).contains(status))
      << status;
  const bool completed = status == "completed";
  for (const char* name :
       {"error", "error_velocity", "error_worst_vertex", "wall_time", "wall_time_spread"})
    expect_number_or_null(row, name, completed);
  EXPECT_TRUE(row.contains("energy_drift"));
  EXPECT_TRUE(row.at("method").is_string() && row.at("precision") == "double" &&
              row.at("threads").is_number_integer());
  EXPECT_TRUE(row.at("pareto").is_boolean() && (completed || !row.at("pareto")));
  EXPECT_EQ(row.at("reason").is_string(), !completed);
  expect_number_or_null(row, "macro_step", true);
  expect_number_or_null(row, "macro_step_over_critical", true);
  expect_number_or_null(row, "setup_time", status != "refused");
  expect_number_or_null(row, "work", status != "refused");
  EXPECT_TRUE(!completed || row.at("timed_runs") >= 3);
}

TEST_F(StudyCommand, WritesWhatTheInterfaceSays) {
  const Child run = study();
  ASSERT_EQ(run.status, 0) << run.errors;
  const Json study = json();
  for (const char* name : {"scene", "machine", "reference", "rows"})
    EXPECT_TRUE(study.contains(name)) << name;
  for (const char* name : {"cpu", "backend", "threads", "compiler", "git_revision"})
    EXPECT_TRUE(study["machine"].contains(name)) << name;
  EXPECT_GT(study["reference"].at("own_error"), 0);
  EXPECT_TRUE(study["reference"].at("good_enough"));
  EXPECT_EQ(study["status"], "completed");
  std::vector<std::string> methods;
  for (const Json& row : study["rows"]) {
    expect_row(row);
    methods.push_back(row["method"]);
  }
  EXPECT_EQ(methods, (std::vector<std::string>{"single/symplectic_euler", "single/symplectic_euler",
                                               "coarse/1", "cycle/rs", "cycle/rs"}));
  EXPECT_EQ(study["rows"][0]["work"], 1.0);
  EXPECT_EQ(study["rows"][4]["distribution"], "equal");
  for (const char* words :
       {"Reference: single/rk4", "Under 5 % error (interactive): ", "coarse/1", "plica report "})
    EXPECT_NE(run.output.find(words), std::string::npos) << run.output;
  const std::string csv = content_of(folder / "out/study.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 6);
  EXPECT_EQ(csv.find("method,distribution,variant,macro_step,"), 0U);
}

// Every field of a row, and what it is in a completed one: s text, n number, b boolean, m map, ?
// may be null
const std::vector<std::pair<std::string, std::string>> row_fields = {
    {"method", "s"},
    {"distribution", "s?"},
    {"variant", "s?"},
    {"macro_step", "n"},
    {"macro_step_over_critical", "n"},
    {"automatic", "b"},
    {"element", "s"},
    {"precision", "s"},
    {"threads", "n"},
    {"status", "s"},
    {"reason", "s?"},
    {"reached", "n?"},
    {"error", "n"},
    {"error_velocity", "n"},
    {"error_worst_vertex", "n"},
    {"total_error", "n?"},
    {"space_error", "n?"},
    {"error_finer", "n?"},
    {"error_probes", "m?"},
    {"energy_drift", "n?"},
    {"phase", "n?"},
    {"wall_time", "n"},
    {"wall_time_spread", "n"},
    {"timed_runs", "n"},
    {"setup_time", "n"},
    {"work", "n"},
    {"spectral_radius", "n?"},
    {"spectral_radius_uncertainty", "n?"},
    {"growth_per_second", "n?"},
    {"pareto", "b"},
    {"case", "s"}};

TEST_F(StudyCommand, RowsHaveTheDocumentedFieldsAndNoOthers) {
  const Child run = study(
      {"--set",
       "study.methods=[single/symplectic_euler, coarse, cycle/rsv/equal, cycle/rsv/equal+bold]",
       "--set", "study.variants={bold: {allow_unstable: true, substeps: 1, switch_threshold: 1}}",
       "--set", "study.macro_steps=[auto, 5 ms]", "--set", "output.probes={tip: [0.4, 0.05, 0.05]}",
       "--growth"});
  ASSERT_EQ(run.status, 0) << run.errors;
  const Json study_json = json();
  std::set<std::string> statuses, variants;
  for (const Json& row : study_json["rows"]) {
    ASSERT_EQ(row.size(), row_fields.size()) << row;
    const bool completed = row["status"] == "completed", cycle = row["distribution"].is_string();
    statuses.insert(row["status"]);
    if (row["variant"].is_string()) variants.insert(row["variant"]);
    for (const auto& [name, kind] : row_fields) {
      ASSERT_TRUE(row.contains(name)) << name;
      const Json& value = row[name];
      const char type = value.is_string()    ? 's'
                        : value.is_number()  ? 'n'
                        : value.is_boolean() ? 'b'
                        : value.is_object()  ? 'm'
                                             : '?';
      EXPECT_TRUE(kind.starts_with(type) || kind.ends_with(type) || (!completed && type == '?'))
          << name << row;
    }
    for (const char* name : {"error", "error_velocity", "error_worst_vertex", "error_probes",
                             "energy_drift", "phase", "wall_time", "wall_time_spread"})
      EXPECT_EQ(row[name].is_null(), !completed) << name << row;
    for (const char* name : {"spectral_radius", "growth_per_second"})
      EXPECT_EQ(row[name].is_number(), cycle) << name << row;
    EXPECT_TRUE(!completed || row["error_probes"].at("tip").is_number());
  }
  EXPECT_EQ(statuses, (std::set<std::string>{"completed", "diverged"}));
  EXPECT_EQ(variants, std::set<std::string>{"bold"});
  EXPECT_NE(run.output.find("Small motions about rest"), std::string::npos) << run.output;
  const std::string csv = content_of(folder / "out/study.csv"),
                    head = csv.substr(0, csv.find('\n'));
  std::string expected;
  for (const auto& [name, kind] : row_fields)
    expected += (expected.empty() ? "" : ",") + (name == "error_probes" ? name + ".tip" : name);
  EXPECT_EQ(head, expected);
  const Child again =
      study({"--force", "--set", "study.variants={bold: {allow_unstable: true, substeps: 2}}",
             "--set", "study.methods=[cycle/rsv/equal+bold]"});
  EXPECT_EQ(again.errors.find("going on"), std::string::npos)
      << "with rows of another variant of that name";
}

TEST_F(StudyCommand, GoesOnWithWhatIsThere) {
  const Child one = study({"--quiet"});
  ASSERT_EQ(one.status, 0);
  EXPECT_EQ(one.errors.find("replaces"), std::string::npos) << one.errors;
  const Json first = json();
  Json fewer = first;
  fewer["rows"].erase(1);
  std::ofstream(folder / "out/study.json") << fewer;
  const Child again = study();
  ASSERT_EQ(again.status, 0) << again.errors;
  EXPECT_NE(again.errors.find("4 rows there"), std::string::npos) << again.errors;
  const Json second = json();
  ASSERT_EQ(second["rows"].size(), 5U);
  EXPECT_EQ(second["rows"][0], first["rows"][0]) << "measured again";
  EXPECT_NE(second["rows"][1]["wall_time"], first["rows"][1]["wall_time"]);
  EXPECT_EQ(second["rows"][1]["error"], first["rows"][1]["error"]);
  const Child refused = study({"--set", "body.material.young_modulus=2 MPa"});
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(refused.errors.find("expected another folder, or --force"), std::string::npos)
      << refused.errors;
  EXPECT_EQ(json(), second);
  const Child other = study({"--force", "--set", "body.material.young_modulus=2 MPa"});
  EXPECT_EQ(other.status, 0) << other.errors;
  EXPECT_EQ(other.errors.find("going on"), std::string::npos) << "with another scene's rows";
  EXPECT_NE(json()["rows"][0]["error"], first["rows"][0]["error"]);
}

TEST_F(StudyCommand, CtrlCEndsWithWholeFiles) {
  const auto stop = [&](pid_t id) {
    return std::filesystem::exists(folder / "out/study.csv") && kill(id, SIGINT) == 0;
  };
  const Child run =
      study({"--set", "study.methods=[single, coarse, cycle]", "--duration", "1 s"}, stop);
  EXPECT_EQ(run.status, 130) << run.errors;
  EXPECT_EQ(json()["status"], "interrupted");
  EXPECT_FALSE(json()["left_out"].empty());
  const Json study_json = json();
  for (const Json& row : study_json["rows"]) expect_row(row);
}

TEST_F(StudyCommand, TheBudgetLeavesOutAndSaysSo) {
  const Child run = study({"--budget", "1us"});
  EXPECT_EQ(run.status, 0) << run.errors;
  ASSERT_EQ(json()["rows"].size(), 1U) << "the baseline, whatever it takes";
  EXPECT_EQ(json()["rows"][0]["method"], "single/symplectic_euler");
  EXPECT_EQ(json()["left_out"].size(), 4U);
  EXPECT_NE(run.output.find("Left out, 4 runs"), std::string::npos) << run.output;
}

// A thousandth of a second, so that the finer meshes are affordable; a file of a mesh cannot be
// made finer
TEST_F(StudyCommand, TheErrorInSpaceIsFoundForEverySceneWithoutFiles) {
  int made = 0, files = 0;
  for (const auto& file :
       std::filesystem::directory_iterator(PLICA_SOURCE_DIR "/drivers/scenes/study")) {
    const bool generated = content_of(file.path()).find("{file: ") == std::string::npos;
    ++(generated ? made : files);
    const std::string results = folder / file.path().stem();
    const Child run =
        run_child({PLICA_EXECUTABLE, "study", file.path(), "-o", results, "--space", "--duration",
                   "1ms", "--set", "study.samples=1", "--set", "study.timed_runs=0", "--set",
                   "study.methods=single/symplectic_euler"},
                  folder);
    EXPECT_EQ(run.status, generated ? 0 : 2) << file.path() << run.errors;
    if (generated) {
      const Json study = Json::parse(content_of(results + "/study.json"));
      EXPECT_TRUE(study["reference"]["space_error"].is_number()) << file.path();
      for (const Json& row : study["rows"])
        EXPECT_TRUE(row["error_finer"].is_number()) << file.path();
    } else {
      EXPECT_NE(run.errors.find("--space needs a finest level that can be made finer"),
                std::string::npos)
          << run.errors;
    }
  }
  EXPECT_EQ(made, 9);
  EXPECT_EQ(files, 1);
}

TEST_F(StudyCommand, BadInputIs2) {
  const auto refuses = [&](const std::vector<std::string>& more, const std::string& words) {
    const Child run = study(more);
    EXPECT_EQ(run.status, 2);
    EXPECT_NE(run.errors.find(words), std::string::npos) << run.errors;
  };
  refuses({"--set", "study.methods=cycle/rvs"}, "did you mean 'cycle/rsv'");
  refuses({"--set", "study.methods=[]"}, "study.methods");
  const std::string bold = "study.variants={bold: {substeps: 1}}";
  refuses({"--set", bold, "--set", "study.methods=cycle/rsv+blod"}, "did you mean 'bold'");
  refuses({"--set", "study.methods=cycle/rsv+bold"}, "study.variants");
  refuses({"--set", "study.variants={bold: {substep: 1}}"}, "did you mean 'substeps'");
  refuses({"--set", "study.variants={bold: {integrator: [rk4, rk4, rk4]}}"}, "study.variants.bold");
  refuses({"--set", "study.method=single"}, "did you mean 'methods'");
  refuses({"--set", "study.macro_steps=[1 kg]"}, "study.macro_steps.0");
  refuses({"--set", "study.precision=half"}, "precision 'half'");
  refuses({"--set", "study.threads=4096"}, "expected a whole number in [1, 512], got '4096'");
  refuses({"--set", "study.threads=500"}, "500 threads");
  refuses({"--set", "study.samples=0"}, "study.samples");
  refuses({"--budget", "soon"}, "--budget");
  refuses({"--set", "gravity=[0, 0, 0]"}, "nothing moves");
  EXPECT_FALSE(std::filesystem::exists(folder / "out/study.json"));
}

TEST_F(StudyCommand, CanBeDrawn) {
  if (run_child({python(), "-c", "import matplotlib"}, folder).status != 0)
    GTEST_SKIP() << "no Python with Matplotlib";
  ASSERT_EQ(study({"--quiet"}).status, 0);
  const Child draw = run_child({python(), PLICA_SOURCE_DIR "/drivers/plots/study.py", out}, folder);
  EXPECT_EQ(draw.status, 0) << draw.errors;
  EXPECT_GT(std::filesystem::file_size(folder / "out/study.png"), 10000U);
  EXPECT_EQ(
      run_child({python(), PLICA_SOURCE_DIR "/drivers/plots/study.py", folder / "none"}, folder)
          .status,
      1);
}

TEST(ReferenceFile, ReadsBackWhatItWroteAndNothingElse) {
  StudyReference r;
  r.method = "single/rk4", r.macro_step = 1e-3, r.own_error = 0.1 / 3,
  r.seconds_per_evaluation = 1e-8;
  r.trajectory = {{0.5, 1}, {{{1, 2, 3}}, {{4, 5, 6}}}, {{{7, 8, 9}}, {{1, 0, 1}}}};
  const std::string bytes = reference_bytes(r, 7);
  const auto back = parse_reference(bytes, 7);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->own_error, r.own_error);
  EXPECT_EQ(back->trajectory.times, r.trajectory.times);
  EXPECT_EQ(back->trajectory.u, r.trajectory.u);
  EXPECT_EQ(back->trajectory.v, r.trajectory.v);
  EXPECT_FALSE(back->finer);
  EXPECT_FALSE(parse_reference(bytes, 8)) << "of another problem";
  EXPECT_FALSE(parse_reference(bytes.substr(0, bytes.size() - 8), 7));
  EXPECT_FALSE(parse_reference({}, 7));
  std::string damaged = bytes;
  damaged.back() = static_cast<char>(damaged.back() ^ 1);
  EXPECT_FALSE(parse_reference(damaged, 7));
  r.finer = r.trajectory, r.space_error = 0.2;
  EXPECT_EQ(parse_reference(reference_bytes(r, 7), 7)->finer->u, r.trajectory.u);
}

}  // namespace
}  // namespace plica::app::test
