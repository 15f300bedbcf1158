// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <chrono>
#include <map>
#include <nlohmann/json.hpp>
#include <random>

#include <plica/core/backend.hpp>

#include "unit/app/child.hpp"

// Runs that stop, in whatever way, and go on.
namespace plica::app::test {
namespace {

constexpr const char* bouncing_block = R"(duration: 1 s
gravity: [0, 0, -9.81]
body:
  levels:
    - {box: {size: [0.1, 0.1, 0.1], cells: [3, 3, 3]}}
    - {box: {size: [0.1, 0.1, 0.1], cells: [2, 2, 2]}}
  surface: {sphere: {radius: 4 cm, subdivisions: 1}}
  initial: {position: [0, 0, 0.055]}
integration: {cycle: rsv, macro_step: 1 ms, integrator: implicit_euler}
contact: {stiffness_scale: 0.0625, obstacles: [{plane: {point: [0, 0, 0.01]}, friction: 0.2}]}
output: {every: 20 steps, volume: all, probes: {tip: [0.1, 0.02, 0.02], middle: [5 cm, 5 cm, 5 cm]}}
)";

class Resume : public ProgramTest {
 protected:
  Resume() : ProgramTest(bouncing_block) {}

  Child begin(const std::string& into, const std::vector<std::string>& more = {},
              const std::function<bool(pid_t)>& meanwhile = {}) {
    return plica({"run", scene, "-o", folder / into, "--quiet", "--threads", "1"}, more, meanwhile);
  }
  Child go_on(const std::string& into, const std::vector<std::string>& more = {},
              const std::function<bool(pid_t)>& meanwhile = {}) {
    return plica({"run", "--resume", folder / into, "--quiet", "--threads", "1"}, more, meanwhile);
  }

  /// All of a run that must not depend on how often it was interrupted.
  std::map<std::string, std::string> results(const std::string& into) const {
    std::map<std::string, std::string> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder / into))
      if (entry.is_regular_file() && entry.path().filename() != "checkpoint.bin")
        files[std::filesystem::relative(entry.path(), folder / into).string()] =
            content_of(entry.path());
    Json summary = Json::parse(files.at("summary.json"));
    for (const char* changing :
         {"arguments", "wall_time", "setup_time", "peak_memory", "stages", "wait_share"})
      summary.erase(changing);
    files["summary.json"] = summary.dump();
    return files;
  }
  void expect_same_results(const std::string& a, const std::string& b) const {
    const auto first = results(a), second = results(b);
    for (const auto& [file, content] : first) {
      ASSERT_TRUE(second.contains(file)) << file;
      EXPECT_TRUE(second.at(file) == content)
          << file << (file == "summary.json" ? content + second.at(file) : "");
    }
    EXPECT_EQ(first.size(), second.size());
  }
};

TEST_F(Resume, SurvivesFiftyKills) {
  ASSERT_EQ(begin("whole").status, 0);
  // the same in every run of this test; what mt19937 gives is fixed by the standard
  std::mt19937 moments(20240117);
  constexpr unsigned latest = 40000;
  int kills = 0;
  for (int lives = 0; kills < 50 && lives < 500; ++lives) {
    const auto end =
        std::chrono::steady_clock::now() + std::chrono::microseconds(moments() % latest);
    const auto strike = [&](pid_t id) {
      std::this_thread::sleep_until(end);
      return kill(id, SIGKILL) == 0;
    };
    const bool anew = !std::filesystem::exists(folder / "killed/checkpoint.bin") ||
                      std::filesystem::exists(folder / "killed/summary.json");
    const Child life = anew ? begin("killed", {"--checkpoint", "every=17", "--force"}, strike)
                            : go_on("killed", {}, strike);
    ASSERT_TRUE(life.status == 128 + SIGKILL || life.status == 0) << life.errors;
    kills += life.status == 0 ? 0 : 1;
  }
  EXPECT_EQ(kills, 50);
  if (!std::filesystem::exists(folder / "killed/checkpoint.bin")) {
    ASSERT_EQ(begin("killed", {"--checkpoint", "every=17", "--force"}).status, 0);
  }
  const Child last = go_on("killed");
  ASSERT_EQ(last.status, 0) << last.errors;
  expect_same_results("whole", "killed");
}

TEST_F(Resume, InterruptedRunGoesOn) {
  const std::string precision = is_built<float> ? "float" : "double";
  ASSERT_EQ(begin("whole", {"--precision", precision}).status, 0);
  // Newton's method ends where what is left of the forces is rounding of displacements, in float,
  // too
  EXPECT_EQ(Json::parse(content_of(folder / "whole/summary.json"))["counters"]["newton_misses"], 0);
  const auto has_frames = [&] {
    return std::filesystem::exists(folder / "stopped/frames/surface_0003.vtu");
  };
  const Child stopped = begin(
      "stopped", {"--precision", precision, "--checkpoint", "every=100 s", "--duration", "40 s"},
      [&](pid_t id) { return has_frames() && kill(id, SIGINT) == 0; });
  ASSERT_EQ(stopped.status, 130);
  const long done = Json::parse(content_of(folder / "stopped/summary.json"))["macro_steps"];
  if (done >= 1000) GTEST_SKIP() << "it was past the end before it could be stopped";
  const Child rest = go_on("stopped", {"--duration", "1 s"});
  ASSERT_EQ(rest.status, 0) << rest.errors;
  expect_same_results("whole", "stopped");
}

TEST_F(Resume, FromTheVeryStart) {
  const std::vector<std::string> diverging = {"--set", "integration.integrator=symplectic_euler",
                                              "--set", "body.element=linear"};
  ASSERT_EQ(begin("whole", diverging).status, 3);
  ASSERT_EQ(begin("again", {diverging[0], diverging[1], diverging[2], diverging[3], "--checkpoint",
                            "every=100 s"})
                .status,
            3);
  EXPECT_EQ(go_on("again").status, 3) << "nothing is saved after it went wrong";
  expect_same_results("whole", "again");
}

TEST_F(Resume, LongerThanItWas) {
  ASSERT_EQ(begin("whole").status, 0);
  ASSERT_EQ(begin("longer", {"--duration", "0.33 s", "--checkpoint", "every=0.1 s"}).status, 0);
  ASSERT_EQ(
      plica({"run", scene, "--resume", folder / "longer", "--quiet", "--threads", "1"}).status, 0);
  expect_same_results("whole", "longer");
}

// The shorter step that ended the first run is no part of the longer one
TEST_F(Resume, LongerThanItWasInAutomaticSteps) {
  const std::vector<std::string> automatic = {"--set", "integration.macro_step=auto", "--set",
                                              "integration.integrator=symplectic_euler",
                                              "--duration"};
  const auto lasting = [&](const std::string& duration, std::vector<std::string> more) {
    more.insert(more.begin(), automatic.begin(), automatic.end());
    more.insert(more.begin() + 5, duration);
    return more;
  };
  ASSERT_EQ(begin("whole", lasting("50 ms", {})).status, 0);
  ASSERT_EQ(begin("longer", lasting("21 ms", {"--checkpoint", "every=1 s"})).status, 0);
  ASSERT_EQ(go_on("longer").status, 0) << "to the same end again";
  ASSERT_EQ(go_on("longer", {"--duration", "50 ms"}).status, 0);
  expect_same_results("whole", "longer");
}

TEST_F(Resume, RefusesWhatIsNotTheRun) {
  ASSERT_EQ(begin("run", {"--duration", "20 ms", "--checkpoint", "every=10"}).status, 0);
  const auto refusal = [&](const std::vector<std::string>& more) {
    const Child child = go_on("run", more);
    EXPECT_EQ(child.status, 2);
    return child.errors;
  };
  EXPECT_EQ(refusal({"--precision", "float"}),
            "error: cannot resume in float: the run is in double\n");
  EXPECT_EQ(
      refusal({"--set", "body.material.density=900"}),
      "error: cannot resume another scene: body.material: is new; only the duration may change\n");
  EXPECT_EQ(refusal({"--set", "body.levels.1.box.cells.2=1"}),
            "error: cannot resume another scene: body.levels.1.box.cells.2: '2' became '1'; only "
            "the duration may "
            "change\n");
  std::ofstream(scene) << std::string(bouncing_block).replace(0, 13, "duration: 1 s\nname: other");
  EXPECT_EQ(plica({"run", scene, "--resume", folder / "run"}).status, 2);
  EXPECT_NE(refusal({"-o", folder / "elsewhere"}).find("excludes"), std::string::npos);
  EXPECT_EQ(go_on("nowhere").status, 2);
  EXPECT_EQ(go_on("run").status, 0) << "refusals have left it as it was";
}

TEST_F(Resume, RefusesAnotherMesh) {
  std::filesystem::copy(PLICA_SOURCE_DIR "/meshes/data/liver_coarse.msh", folder / "body.msh");
  std::ofstream(scene) << "duration: 1 ms\nbody: {levels: [{file: body.msh}]}\n";
  ASSERT_EQ(begin("run", {"--checkpoint", "every=1"}).status, 0);
  EXPECT_EQ(go_on("run").status, 0);
  std::filesystem::copy(PLICA_SOURCE_DIR "/meshes/data/liver_medium.msh", folder / "body.msh",
                        std::filesystem::copy_options::overwrite_existing);
  const Child child = go_on("run");
  EXPECT_EQ(child.status, 2);
  EXPECT_NE(child.errors.find("has a mesh file changed?"), std::string::npos) << child.errors;
}

TEST_F(Resume, RefusesDamage) {
  ASSERT_EQ(begin("run", {"--duration", "10 ms", "--checkpoint", "every=10"}).status, 0);
  const std::string file = folder / "run/checkpoint.bin", sound = content_of(file);
  const auto expect_refused = [&](const std::string& content) {
    std::ofstream(file, std::ios::binary) << content;
    const Child child = go_on("run");
    EXPECT_EQ(child.status, 2);
    EXPECT_NE(child.errors.find("checkpoint.bin: "), std::string::npos) << child.errors;
  };
  for (const std::size_t size :
       {std::size_t(0), std::size_t(5), std::size_t(20), std::size_t(300), sound.size() - 1})
    expect_refused(sound.substr(0, size));
  for (const std::size_t at :
       {std::size_t(3), std::size_t(18), std::size_t(25), std::size_t(200), sound.size() - 9}) {
    std::string damaged = sound;
    damaged[at] = static_cast<char>(damaged[at] ^ 1);
    expect_refused(damaged);
  }
  expect_refused(sound + "x");
  std::ofstream(file, std::ios::binary) << sound;
  EXPECT_EQ(go_on("run").status, 0);
}

TEST_F(Resume, RefusesFilesThatWereCut) {
  ASSERT_EQ(begin("run", {"--duration", "0.2 s", "--checkpoint", "every=10"}).status, 0);
  std::filesystem::resize_file(folder / "run/probes.csv", 60);
  EXPECT_NE(go_on("run").errors.find("probes.csv was changed since the checkpoint"),
            std::string::npos);
}

// Runs that a signal, a full disk or a kill ends.

TEST_F(Program, CtrlCEndsWithWholeFiles) {
  for (const int signal : {SIGINT, SIGTERM}) {
    std::filesystem::remove_all(out);
    const Child run =
        plica(endless(), [&](pid_t id) { return has_frames() && kill(id, signal) == 0; });
    EXPECT_EQ(run.status, 130) << run.errors;
    EXPECT_EQ(summary()["status"], "interrupted");
    EXPECT_EQ(summary()["frames"], lines("out/frames.pvd") - 5);
    EXPECT_EQ(summary()["frames"], lines("out/history.csv") - 1);
    EXPECT_EQ(summary()["last_good_time"], summary()["simulated_time"]);
  }
}

// Set-up that takes long: the inertia of a large mesh
TEST_F(Program, SetUpSaysWhatItDoesAndCanBeInterrupted) {
  const std::vector<std::string> slow = {
      "run",   scene,
      "-o",    out,
      "--set", "body.levels=[{box: {size: [1, 1, 1], cells: [60, 60, 60]}}]",
      "--set", "integration={cycle: him}"};
  const auto spoken = [&] {
    return content_of(folder / "stderr.txt").find("set-up, ") != std::string::npos;
  };
  for (const int signal : {SIGINT, SIGTERM}) {
    const Child run = plica(slow, [&](pid_t id) { return spoken() && kill(id, signal) == 0; });
    EXPECT_EQ(run.status, 130) << run.errors;
    EXPECT_NE(run.errors.find(" s: "), std::string::npos) << run.errors;
    EXPECT_NE(run.errors.find("interrupted during the set-up; nothing was written"),
              std::string::npos)
        << run.errors;
    EXPECT_FALSE(std::filesystem::exists(out));
  }
}

// A macro step of hundreds of thousands of sub-steps
std::vector<std::string> one_long_step(const std::string& scene, const std::string& out) {
  return {"run",        scene,
          "-o",         out,
          "--duration", "500 s",
          "--set",      "integration.macro_step=500 s",
          "--set",      "body.levels.0.box.cells=[8, 8, 8]",
          "--set",      "output.every=1 step"};
}

TEST_F(Program, CtrlCEndsWithinAMacroStep) {
  const auto begun = [&] {
    return content_of(folder / "out/history.csv").find("\n0,") != std::string::npos;
  };
  for (const int signal : {SIGINT, SIGTERM}) {
    std::filesystem::remove_all(out);
    const Child run = plica(one_long_step(scene, out), [&](pid_t id) {
      if (!begun()) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(200));  // it steps by now
      return kill(id, signal) == 0;
    });
    EXPECT_EQ(run.status, 130) << run.errors;
    EXPECT_NE(run.output.find("block: interrupted"), std::string::npos) << run.output;
    EXPECT_EQ(summary()["status"], "interrupted");
    EXPECT_EQ(summary()["macro_steps"], 0);
    EXPECT_EQ(summary()["frames"], 1);
    EXPECT_EQ(lines("out/history.csv"), 2);
  }
}

TEST_F(Program, SecondCtrlCEndsAtOnce) {
  const Child run = plica(one_long_step(scene, out), [&](pid_t id) {
    return std::filesystem::exists(folder / "out/frames.pvd") && kill(id, SIGINT) == 0 &&
           kill(id, SIGTERM) == 0;
  });
  EXPECT_EQ(run.status, 130);
  EXPECT_FALSE(std::filesystem::exists(folder / "out/summary.json"));
}

// A file may not grow beyond some kB, as on a disk that is full
TEST_F(Program, FullDiskIs1) {
  const std::string words = std::string("trap '' XFSZ; ulimit -f 8; exec ") + PLICA_EXECUTABLE +
                            " run " + scene + " -o " + out +
                            " --duration 10s --set output.every='1 step' --checkpoint every=1";
  const Child run = run_child({"bash", "-c", words}, folder);
  if (run.status == 127 || run.status < 0) GTEST_SKIP() << "no bash";
  EXPECT_EQ(run.status, 1) << run.errors;
  EXPECT_NE(run.errors.find("error: cannot write " + out + "/"), std::string::npos) << run.errors;
  EXPECT_FALSE(std::filesystem::exists(folder / "out/summary.json"));
  EXPECT_TRUE(content_of(folder / "out/history.csv").ends_with("\n"));
  EXPECT_TRUE(content_of(folder / "out/frames.pvd").ends_with("</VTKFile>\n"));
  for (const auto& entry : std::filesystem::recursive_directory_iterator(out))
    EXPECT_NE(entry.path().extension(), ".part") << entry.path();
}

TEST_F(Program, NoMemoryIs1) {
  const std::string words =
      std::string("ulimit -v 400000; exec ") + PLICA_EXECUTABLE + " check " + scene +
      " --set 'body.levels=[{box: {size: [0.1, 0.1, 0.1], cells: [100, 100, 100]}}]'";
  const Child check = run_child({"bash", "-c", words}, folder);
  if (check.status == 127 || check.status < 0) GTEST_SKIP() << "no bash";
  EXPECT_EQ(check.status, 1) << check.errors;
  EXPECT_TRUE(check.errors.starts_with("error: memory ran out, of which the process had "))
      << check.errors;
}

TEST_F(Program, KilledRunLeavesWholeFiles) {
  const Child run =
      plica(endless(), [&](pid_t id) { return has_frames() && kill(id, SIGKILL) == 0; });
  EXPECT_EQ(run.status, 128 + SIGKILL);
  EXPECT_FALSE(std::filesystem::exists(folder / "out/summary.json"));
  const std::string collection = content_of(folder / "out/frames.pvd");
  EXPECT_TRUE(collection.ends_with("</VTKFile>\n"));
  EXPECT_TRUE(content_of(folder / "out/history.csv").ends_with("\n"));
  for (const auto& frame : std::filesystem::directory_iterator(folder / "out/frames"))
    if (frame.path().extension() == ".vtu") {
      EXPECT_TRUE(content_of(frame.path()).ends_with("</VTKFile>\n")) << frame.path();
    }
}

}  // namespace
}  // namespace plica::app::test
