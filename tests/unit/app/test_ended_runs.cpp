// SPDX-License-Identifier: BSD-3-Clause
#include "unit/app/program_test.hpp"

// Runs that a signal, a full disk or a kill ends.
namespace plica::app::test {
namespace {

TEST_F(Program, CtrlCEndsWithWholeFiles) {
  for (const int signal : {SIGINT, SIGTERM}) {
    std::filesystem::remove_all(out);
    const Child run = plica(endless(), [&](pid_t id) { return has_frames() && kill(id, signal) == 0; });
    EXPECT_EQ(run.status, 130) << run.errors;
    EXPECT_EQ(summary()["status"], "interrupted");
    EXPECT_EQ(summary()["frames"], lines("out/frames.pvd") - 5);
    EXPECT_EQ(summary()["frames"], lines("out/history.csv") - 1);
    EXPECT_EQ(summary()["last_good_time"], summary()["simulated_time"]);
  }
}

// Set-up that takes minutes: trials on a large mesh
TEST_F(Program, SetUpSaysWhatItDoesAndCanBeInterrupted) {
  const std::vector<std::string> slow = {
      "run",
      scene,
      "-o",
      out,
      "--set",
      "body.levels=[{box: {size: [1, 1, 1], cells: [60, 60, 60]}}, {box: {size: [1, 1, 1], "
      "cells: [30, 30, 30]}}]",
      "--set",
      "integration={cycle: auto}"};
  const auto spoken = [&] { return content_of(folder / "stderr.txt").find("set-up, ") != std::string::npos; };
  for (const int signal : {SIGINT, SIGTERM}) {
    const Child run = plica(slow, [&](pid_t id) { return spoken() && kill(id, signal) == 0; });
    EXPECT_EQ(run.status, 130) << run.errors;
    EXPECT_NE(run.errors.find(" s: "), std::string::npos) << run.errors;
    EXPECT_NE(run.errors.find("interrupted during the set-up; nothing was written"), std::string::npos) << run.errors;
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
  const auto begun = [&] { return content_of(folder / "out/history.csv").find("\n0,") != std::string::npos; };
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
    return std::filesystem::exists(folder / "out/frames.pvd") && kill(id, SIGINT) == 0 && kill(id, SIGTERM) == 0;
  });
  EXPECT_EQ(run.status, 130);
  EXPECT_FALSE(std::filesystem::exists(folder / "out/summary.json"));
}

// A file may not grow beyond some kB, as on a disk that is full
TEST_F(Program, FullDiskIs1) {
  const std::string words = std::string("trap '' XFSZ; ulimit -f 8; exec ") + PLICA_EXECUTABLE + " run " + scene +
                            " -o " + out + " --duration 10s --set output.every='1 step' --checkpoint every=1";
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

TEST_F(Program, KilledRunLeavesWholeFiles) {
  const Child run = plica(endless(), [&](pid_t id) { return has_frames() && kill(id, SIGKILL) == 0; });
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
