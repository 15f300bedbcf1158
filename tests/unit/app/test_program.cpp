// SPDX-License-Identifier: BSD-3-Clause
#include <plica/core/backend.hpp>
#include <plica/drivers/app/output/write_file.hpp>

#include "unit/app/child.hpp"

namespace plica::app::test {
namespace {

TEST_F(Program, RunsAndWrites) {
  const Child run = plica({"run", scene, "-o", out});
  ASSERT_EQ(run.status, 0) << run.errors;
  EXPECT_NE(run.output.find("block: completed"), std::string::npos) << run.output;
  EXPECT_EQ(run.errors.find('\r'), std::string::npos) << "progress where there is no terminal";
  EXPECT_EQ(run.errors.find('\033'), std::string::npos) << "colour where there is no terminal";
  const Json json = summary();
  EXPECT_EQ(json["status"], "completed");
  EXPECT_EQ(json["macro_steps"], 20);
  EXPECT_NEAR(json["simulated_time"], 0.02, 1e-12);
  EXPECT_TRUE(json["diagnosis"].is_null());
  EXPECT_EQ(json["frames"], 5);
  EXPECT_EQ(lines("out/history.csv"), 6);
}

// Every cycle writes the levels that it integrates.
TEST_F(Program, WritesTheVolumesOfAllLevelsThatHaveAState) {
  const std::string levels =
      "body.levels=[{box: {size: [0.1, 0.1, 0.1], cells: [2, 2, 2]}}, {box: {size: [0.1, 0.1, "
      "0.1], cells: [1, 1, 1]}}]";
  for (const auto& [cycle, volumes] :
       {std::pair{"single", 1}, {"rsv", 2}, {"him", 1}, {"auto", 1}}) {
    std::vector<std::string> words = {"run",
                                      scene,
                                      "-o",
                                      out + cycle,
                                      "--quiet",
                                      "--set",
                                      levels,
                                      "--set",
                                      "output.volume=all",
                                      "--set",
                                      std::string("integration.cycle=") + cycle};
    if (cycle == std::string("auto"))
      words.insert(words.end(), {"--set", "integration.macro_step=auto"});
    const Child run = plica(words);
    EXPECT_EQ(run.status, 0) << cycle << ": " << run.errors;
    EXPECT_TRUE(std::filesystem::exists(out + cycle + "/volume.pvd")) << cycle;
    EXPECT_EQ(std::filesystem::exists(out + cycle + "/volume_level1.pvd"), volumes == 2) << cycle;
  }
}

/// The narrowest precision of this build.
const std::string narrow = is_built<float> ? "float" : "double";

TEST_F(Program, RunsInThePrecisionsOfItsBuild) {
  const Child run = plica({"run", scene, "-o", out, "--duration", "2ms", "--precision", "float"});
  EXPECT_EQ(run.status, is_built<float> ? 0 : 2) << run.errors;
  EXPECT_EQ(run.errors.find("PLICA_BACKENDS=all") == std::string::npos, is_built<float>);
}

TEST_F(Program, QuietSaysNothing) {
  const Child run =
      plica({"run", scene, "-o", out, "--quiet", "--duration", "2ms", "--precision", narrow});
  EXPECT_EQ(run.status, 0);
  EXPECT_EQ(run.output + run.errors, "");
  EXPECT_EQ(summary()["precision"], narrow);
}

TEST_F(Program, DurationIsCoveredByWholeSteps) {
  ASSERT_EQ(plica({"run", scene, "-o", out, "--set", "integration.macro_step=3 ms"}).status, 0);
  EXPECT_EQ(summary()["macro_steps"], 7);
  EXPECT_NEAR(summary()["simulated_time"], 0.021, 1e-12);
}

TEST_F(Program, AutomaticStepsEndAtTheDuration) {
  for (const char* duration : {"0.1 ms", "20 ms"}) {  // the first is less than one step
    const Child run =
        plica({"run", scene, "-o", out, "--force", "--set", "integration.macro_step=auto",
               "--duration", duration, "--set", "output.every=1 s"});
    ASSERT_EQ(run.status, 0) << run.errors;
    const double end = std::stod(duration) / 1e3;
    EXPECT_EQ(summary()["simulated_time"], end);
    EXPECT_EQ(summary()["last_good_time"], end);
    EXPECT_GT(summary()["macro_steps"].get<double>() * summary()["macro_step"].get<double>(), end);
    EXPECT_NE(run.output.find(", the last one shorter"), std::string::npos) << run.output;
  }
}

TEST_F(Program, BadInputIs2) {
  EXPECT_EQ(plica({"run", folder / "none.yaml"}).status, 2);
  EXPECT_EQ(plica({"check", scene, "--set", "durtion=1"}).status, 2);
  EXPECT_EQ(plica({}).status, 2);
  EXPECT_EQ(plica({"rnu"}).status, 2);
  EXPECT_EQ(plica({"run"}).status, 2);
  EXPECT_EQ(plica({"run", scene, "--no-such-option"}).status, 2);
  EXPECT_EQ(plica({"run", scene, "--precision", "half"}).status, 2);
  EXPECT_EQ(plica({"run", scene, "--threads", "0"}).status, 2);
  EXPECT_EQ(plica({"check", scene, "--kokkos-num-threads=0"}).status, 2);
  EXPECT_EQ(plica({"check", scene, "--kokkos-num-threads=many"}).status, 2);
  for (const char* threads : {"KOKKOS_NUM_THREADS=abc", "KOKKOS_NUM_THREADS=-3"})
    EXPECT_EQ(
        run_child({"env", threads, std::string(PLICA_EXECUTABLE), "check", scene}, folder).status,
        2);
  EXPECT_EQ(plica({"mesh"}).status, 2);
  EXPECT_EQ(plica({"mesh", "info", folder / "none.msh"}).status, 2);
  EXPECT_EQ(plica({"list", "material"}).status, 2);
  for (const char* option : {"-o", "--resume", "--study"})
    EXPECT_EQ(plica({"run", scene, option, ""}).status, 2) << option;
}

TEST_F(Program, ErrorsNameTheNearest) {
  EXPECT_NE(plica({"rnu"}).errors.find("did you mean 'run'?"), std::string::npos);
  EXPECT_NE(plica({"list", "material"}).errors.find("did you mean 'materials'?"),
            std::string::npos);
  const Child check = plica({"check", scene, "--set", "durtion=1"});
  EXPECT_NE(
      check.errors.find("error: --set durtion=1: unknown key 'durtion'; did you mean 'duration'?"),
      std::string::npos)
      << check.errors;
  EXPECT_EQ(check.output, "");
  EXPECT_EQ(plica({"run", scene, "--thread", "2"})
                .errors.find("error: unknown option '--thread'; did you mean '--threads'?"),
            0);
  EXPECT_EQ(plica({"--threads", "1", "run", scene})
                .errors.find("error: '--threads' stands before the command; expected it "
                             "behind: plica run --threads"),
            0);
  EXPECT_EQ(
      plica({"mesh"}).errors,
      "error: expected a command: info, convert, repair, fill, coarsen\nsee plica mesh --help\n");
}

TEST_F(Program, RefusedStepIs2) {
  const Child run = plica({"run", scene, "-o", out, "--duration", "2 s", "--set",
                           "integration.macro_step=1 s", "--set", "integration.substeps=1"});
  EXPECT_EQ(run.status, 2);
  EXPECT_NE(run.errors.find("block.yaml"), std::string::npos) << run.errors;
  EXPECT_FALSE(std::filesystem::exists(out)) << "files of a run that was refused";
}

TEST_F(Program, FolderInTheWrongPlaceIs2) {
  std::ofstream(folder / "file") << "in the way";
  const Child run = plica({"run", scene, "-o", folder / "file/out"});
  EXPECT_EQ(run.status, 2);
  EXPECT_NE(run.errors.find("cannot make the folder " + (folder / "file/out").string() + ": " +
                            (folder / "file").string() + " is a file, not a folder"),
            std::string::npos)
      << run.errors;
  const Child nowhere = plica({"run", scene, "-o", "/proc/x"});
  EXPECT_EQ(nowhere.status, 2);
  EXPECT_NE(
      nowhere.errors.find(
          "cannot make the folder /proc/x: the system lets none be made in /proc (No such file or "
          "directory); expected a place to write to"),
      std::string::npos)
      << nowhere.errors;
}

TEST_F(Program, DivergedIs3) {
  const Child run =
      plica({"run", scene, "-o", out, "--duration", "1 s", "--set",
             "integration.allow_unstable=true", "--set", "integration.macro_step=20 ms", "--set",
             "integration.substeps=1", "--set", "body.initial.angular_velocity=[0, 3, 0]"});
  EXPECT_EQ(run.status, 3) << run.errors;
  EXPECT_NE(run.errors.find("diverged: "), std::string::npos);
  const Json json = summary();
  EXPECT_EQ(json["status"], "diverged");
  EXPECT_TRUE(json["diagnosis"]["remedy"].is_string());
  EXPECT_LE(json["last_good_time"], json["simulated_time"]);
  EXPECT_GE(lines("out/history.csv"), 2);
  EXPECT_EQ(content_of(folder / "out/history.csv").find("nan"), std::string::npos);
}

// That the run went on is said only where it did.
TEST_F(Program, WarnsOfUnsolvedStepsWhereTheRunWentOn) {
  for (const char* unsolved : {"accept", "stop"}) {
    const bool stops = unsolved == std::string("stop");
    const std::string implicit =
        "{newton_iterations: 2, newton_tolerance: 1e-12}, on_failure: {halvings: 0, unsolved: ";
    const Child run =
        plica({"run", scene, "-o", out, "--force", "--set",
               "integration={integrator: implicit_euler, macro_step: 20 ms, implicit: " + implicit +
                   unsolved + "}}",
               "--set", "body.initial.angular_velocity=[0, 0, 10]"});
    EXPECT_EQ(run.status, stops ? 3 : 0) << run.errors;
    EXPECT_EQ(summary()["warnings"].dump().find("the run went on") == std::string::npos, stops)
        << summary();
  }
}

// A law that does not stop there must not end without a word; what a resumed run says is what the
// whole one says.
TEST_F(Program, WarnsOfElementsThatTurnInsideOut) {
  const auto run = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words = {"run",
                                      PLICA_SOURCE_DIR "/drivers/scenes/smallest.yaml",
                                      "-o",
                                      out,
                                      "--force",
                                      "--set",
                                      "body.material.model=st_venant_kirchhoff",
                                      "--set",
                                      "body.material.young_modulus=3 kPa",
                                      "--set",
                                      "output.every=20 ms"};
    words.insert(words.end(), more.begin(), more.end());
    const Child child = plica(words);
    EXPECT_EQ(child.status, 0) << child.errors;
    return child.errors;
  };
  const std::string said = run({});
  EXPECT_NE(said.find("warning: body.material: elements turned inside out, first at "),
            std::string::npos)
      << said;
  const Json warnings = summary()["warnings"];
  ASSERT_FALSE(warnings.empty());
  EXPECT_NE(warnings.back().get<std::string>().find("turned inside out"), std::string::npos);
  run({"--checkpoint", "every=100", "--duration", "0.6 s"});
  ASSERT_EQ(plica({"run", "--resume", out, "--duration", "1 s"}).status, 0);
  EXPECT_EQ(summary()["warnings"], warnings);
  EXPECT_EQ(run({"--set", "body.material.allow_inversion=true"}).find("inside out"),
            std::string::npos);
  EXPECT_EQ(run({"--set", "body.material.young_modulus=200 kPa"}).find("inside out"),
            std::string::npos);
}

TEST_F(Program, ReplacesARunOnlyWhereToldTo) {
  const std::vector<std::string> again = {"run", scene,   "-o",
                                          out,   "--set", "output.probes={tip: [0, 0, 0]}"};
  const auto with = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words = again;
    words.insert(words.end(), more.begin(), more.end());
    return plica(words);
  };
  ASSERT_EQ(with({"--checkpoint", "every=5"}).status, 0);
  const std::string checkpoint = content_of(folder / "out/checkpoint.bin"),
                    probes = content_of(folder / "out/probes.csv");
  const Child refused = with({});
  EXPECT_EQ(refused.status, 2);
  EXPECT_EQ(refused.errors,
            "error: the folder " + out +
                " holds a run already (checkpoint.bin, summary.json, history.csv, probes.csv, "
                "frames.pvd); expected --force to replace it, --resume " +
                out + " to go on with it, or another folder with -o\n");
  EXPECT_EQ(content_of(folder / "out/checkpoint.bin"), checkpoint);
  EXPECT_EQ(content_of(folder / "out/probes.csv"), probes);
  EXPECT_EQ(plica({"run", "--resume", out, "--force"}).status, 2);
  EXPECT_EQ(plica({"run", "--resume", out}).status, 0);
  EXPECT_NE(with({"--duration", "5 kg"}).errors.find("duration: expected a time"),
            std::string::npos)
      << "what the scene says wrong comes first";
  ASSERT_EQ(plica({"report", out}).status, 0);
  EXPECT_TRUE(std::filesystem::exists(folder / "out/report.html"));
  {
    const FolderLock other(out);
    const Child second = with({"--force"});
    EXPECT_EQ(second.status, 2);
    EXPECT_NE(second.errors.find("another run is writing to the folder"), std::string::npos)
        << second.errors;
  }
  EXPECT_EQ(with({"--force"}).status, 0);
  for (const char* file : {"checkpoint.bin", "report.html"})
    EXPECT_FALSE(std::filesystem::exists(folder / "out" / file)) << file;
  EXPECT_EQ(with({}).errors.find("--resume"), std::string::npos)
      << "there is no checkpoint to go on from";
}

TEST_F(Program, HelpAndVersionAreResults) {
  for (const char* command :
       {"run", "explain", "check", "report", "mesh", "list", "schema", "completion"}) {
    const Child help = plica({command, "--help"});
    EXPECT_EQ(help.status, 0);
    EXPECT_NE(help.output.find("Usage"), std::string::npos);
    EXPECT_EQ(help.errors, "");
  }
  EXPECT_EQ(plica({"help"}).output, plica({"--help"}).output);
  EXPECT_EQ(plica({"help", "run"}).output, plica({"run", "--help"}).output);
  const Child version = plica({"--version"});
  EXPECT_EQ(version.status, 0);
  for (const char* part : {"plica", "Kokkos", "back ends", "compiler", "git"})
    EXPECT_NE(version.output.find(part), std::string::npos) << part;
}

TEST_F(Program, ExplainsForPeopleAndPrograms) {
  const Child text = plica({"explain", scene});
  ASSERT_EQ(text.status, 0) << text.errors;
  std::istringstream rows(text.output);
  for (std::string row; std::getline(rows, row);)
    if (row.find(scene) == std::string::npos) {
      EXPECT_LE(row.size(), 100) << row;
    }
  const Json json = Json::parse(plica({"explain", scene, "--json"}).output);
  EXPECT_EQ(json["levels"][0]["tets"], 48);
  EXPECT_EQ(json["macro_steps"], 20);
  EXPECT_FALSE(json["parts"].empty());
  EXPECT_TRUE(json["parts"][0].contains("bytes"));
}

// A space for slivers lies between the meshes: tables and files number it like them
TEST_F(Program, ExplainsTheSpaceForSliversAboveAGivenMesh) {
  const std::string organ = PLICA_SOURCE_DIR "/meshes/data/organs/liver.vtk",
                    coarse = folder / "coarse.vtk";
  ASSERT_EQ(plica({"mesh", "coarsen", organ, "-o", coarse, "--vertices", "300"}).status, 0);
  const auto explain = [&](std::vector<std::string> more) {
    std::vector<std::string> words = {
        "explain", scene,
        "--set",   "integration={cycle: him}",
        "--set",   "body.levels=[{file: " + organ + "}, {file: " + coarse + "}]"};
    words.insert(words.end(), more.begin(), more.end());
    const Child child = plica(words);
    EXPECT_EQ(child.status, 0) << child.errors;
    return child.output;
  };
  const std::string text = explain({});
  EXPECT_NE(text.find("slivers follow"), std::string::npos) << text;
  EXPECT_NE(text.find("0 - 2"), std::string::npos) << text;
  const Json levels = Json::parse(explain({"--json"}))["levels"];
  ASSERT_EQ(levels.size(), 3u);
  EXPECT_EQ(levels[1]["kind"], "slivers");
  EXPECT_EQ(levels[1]["tets"], 0);
  EXPECT_EQ(levels[2]["kind"], "mesh");
}

TEST_F(Program, ExplainsWhatRanksWouldHave) {
  const std::string organ = PLICA_SOURCE_DIR "/meshes/data/organs/liver.vtk";
  const auto explain = [&](const std::string& last) {
    return plica({"explain", scene, "--set", "integration={cycle: single}", "--set",
                  "body.levels=[{file: " + organ + "}]", "--ranks", "4", last});
  };
  const Json json = Json::parse(explain("--json").output);
  ASSERT_EQ(json["ranks"].size(), 4u);
  long tets = 0, sent = 0, received = 0;
  for (const Json& rank : json["ranks"])
    tets += rank["tets"].get<long>(), sent += rank["rows_sent"].get<long>(),
        received += rank["rows_received"].get<long>();
  EXPECT_EQ(tets, json["levels"][0]["tets"]);
  EXPECT_GT(sent, 0);
  EXPECT_EQ(sent, received);
  EXPECT_NE(explain("--set=duration=1ms").output.find("On 4 ranks, imbalance 1."),
            std::string::npos);
}

TEST_F(Program, ChecksWithoutRunning) {
  EXPECT_EQ(plica({"check", scene}).status, 0);
  EXPECT_EQ(Json::parse(plica({"check", scene, "--json"}).output)["sound"], true);
  const Child bad = plica({"check", scene, "--json", "--duration", "4 cm"});
  EXPECT_EQ(bad.status, 2);
  EXPECT_EQ(Json::parse(bad.output)["error"],
            "--duration 4 cm: duration: expected a time (s) > 0, got '4 cm', a length");
  EXPECT_FALSE(std::filesystem::exists(out));
}

// What a run refuses, the check refuses with the same words.
TEST_F(Program, ChecksTheNumberOfSteps) {
  for (const char* change : {"duration=1e18", "integration.macro_step=1e-30"}) {
    const Child check = plica({"check", scene, "--set", change}),
                run = plica({"run", scene, "-o", out, "--set", change});
    EXPECT_EQ(check.status, 2) << change;
    EXPECT_NE(check.errors.find("expected at most 1e+12"), std::string::npos) << check.errors;
    EXPECT_EQ(check.errors, run.errors);
  }
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST_F(Program, LoopsOfLinksAre2) {
  std::filesystem::create_symlink("loop.yaml", folder / "loop.yaml");
  const Child check = plica({"check", folder / "loop.yaml"});
  EXPECT_EQ(check.status, 2) << check.errors;
  EXPECT_EQ(check.errors.find("filesystem error"), std::string::npos) << check.errors;
}

TEST_F(Program, ListsFamilies) {
  const Json families = Json::parse(plica({"list", "--json"}).output);
  EXPECT_GE(families.size(), 10);
  const std::string text = plica({"list"}).output;
  for (const Json& one : families) {
    const std::string family = one["name"];
    EXPECT_NE(text.find("  " + family), std::string::npos) << family;
    EXPECT_NE(plica({"list", family}).output, "") << family;
    const Json members = Json::parse(plica({"list", family, "--json"}).output);
    EXPECT_FALSE(members.empty()) << family;
    for (const Json& member : members)
      EXPECT_FALSE(member[family == "keys" ? "help" : "summary"].empty()) << family;
  }
}

TEST_F(Program, PrintsTheSchema) {
  EXPECT_EQ(Json::parse(plica({"schema"}).output)["properties"]["body"]["required"],
            Json({"levels"}));
}

TEST_F(Program, CompletesCommandLines) {
  if (run_child({"bash", "-c", "true"}, folder).status != 0) GTEST_SKIP() << "no bash";
  std::ofstream(folder / "completion") << plica({"completion", "bash"}).output;
  const auto completed = [&](const std::string& line) {
    const std::string body =
        "source " + std::string(folder / "completion") + "; COMP_WORDS=(" + line +
        "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _plica; echo \"${COMPREPLY[*]}\"";
    return run_child({"bash", "-c", body}, folder).output;
  };
  EXPECT_EQ(completed("plica ru"), "run\n");
  EXPECT_EQ(completed("plica run a.yaml --ch"), "--checkpoint\n");
  EXPECT_EQ(completed("plica run --precision f"), "float\n");
  EXPECT_EQ(completed("plica list ma"), "materials\n");
  EXPECT_EQ(completed("plica list --j"), "--json\n");
  EXPECT_EQ(completed("plica mesh i"), "info\n");
  EXPECT_EQ(completed("plica rep"), "report\n");
  EXPECT_EQ(completed("plica report --f"), "--frames\n");
  EXPECT_EQ(completed("plica stab"), "stability\n");
  EXPECT_EQ(completed("plica stability --m"), "--matrix\n");
  EXPECT_EQ(completed("plica verify cook"), "cook_membrane cook_incompressible\n");
  EXPECT_EQ(plica({"completion", "fish"}).status, 2);
}

TEST_F(Program, ProbesFollowTheBody) {
  ASSERT_EQ(plica({"run", scene, "-o", out, "--set",
                   "output.probes={low: [0, 0, 0], out: [0.101, 0.05, 0.05]}"})
                .status,
            0);
  EXPECT_EQ(lines("out/probes.csv"), 22);
  const std::string text = content_of(folder / "out/probes.csv");
  EXPECT_TRUE(text.starts_with("time,low_x,low_y,low_z,low_vx,low_vy,low_vz,out_x,"))
      << text.substr(0, 80);
  std::istringstream last(text.substr(text.rfind('\n', text.size() - 2) + 1));
  std::vector<double> row;
  for (std::string field; std::getline(last, field, ',');) row.push_back(std::stod(field));
  const double fallen = -9.81 * 1e-6 * 20 * 21 / 2;  // symplectic Euler in free fall
  const std::vector<double> expected = {0.02,          0, 0, fallen, 0, 0, -0.1962, 0.1, 0.05,
                                        0.05 + fallen, 0, 0, -0.1962};
  ASSERT_EQ(row.size(), expected.size());
  for (std::size_t i = 0; i < row.size(); ++i) EXPECT_NEAR(row[i], expected[i], 1e-9) << i;
}

TEST_F(Program, WatchesWhatIsThere) {
  EXPECT_NE(plica({"check", scene, "--set", "output.probes.tip=[0.101, 0.05, 0.05]"})
                .errors.find("output.probes.tip: [0.101, 0.05, 0.05] is 0.001 m outside level 0 at "
                             "rest; the nearest point"),
            std::string::npos);
  const Child far = plica({"check", scene, "--set", "output.probes.tip=[10, 2, 2]"});
  EXPECT_EQ(far.status, 2);
  EXPECT_NE(
      far.errors.find("outside level 0 at rest, which lies in [0, 0, 0] to [0.1, 0.1, 0.1] m"),
      std::string::npos)
      << far.errors;
  EXPECT_EQ(plica({"check", scene, "--set", "output.volume=[1]"}).status, 2);
  EXPECT_EQ(plica({"check", scene, "--set", "output.probe_every=2 steps"}).status, 2);
}

TEST_F(Program, RunsCanBeDrawn) {
  if (run_child({python(), "-c", "import matplotlib"}, folder).status != 0)
    GTEST_SKIP() << "no Python with Matplotlib";
  ASSERT_EQ(plica({"run", scene, "-o", out}).status, 0);
  const Child plot = run_child({python(), PLICA_SOURCE_DIR "/drivers/plots/run.py", out}, folder);
  EXPECT_EQ(plot.status, 0) << plot.errors;
  EXPECT_GT(std::filesystem::file_size(folder / "out/run.png"), 10000);
}

// Where nobody has chosen how threads wait, the program has started itself again.
TEST_F(Program, WaitsPassively) {
  std::vector<std::string> words = endless();
  words.insert(words.begin(), {"env", "-u", "GOMP_SPINCOUNT", "-u", "OMP_WAIT_POLICY",
                               std::string(PLICA_EXECUTABLE)});
  std::string environment;
  const Child run = run_child(words, folder, [&](pid_t id) {
    if (!has_frames()) return false;
    environment = content_of("/proc/" + std::to_string(id) + "/environ");
    return kill(id, SIGTERM) == 0;
  });
  EXPECT_EQ(run.status, 130) << run.errors;
  EXPECT_NE(environment.find("GOMP_SPINCOUNT=1000"), std::string::npos);
}

TEST_F(Program, KokkosOptionsPassThrough) {
  ASSERT_EQ(plica({"run", scene, "-o", out, "--kokkos-num-threads=1"}).status, 0);
  EXPECT_EQ(summary()["threads"], 1);
}

}  // namespace
}  // namespace plica::app::test
