// SPDX-License-Identifier: BSD-3-Clause
#include <plica/meshes/files/base64.hpp>

#include "unit/app/child.hpp"

namespace plica::app::test {
namespace {

class ReportCommand : public Program {
 protected:
  // The data of a page
  Json data() const {
    const std::string page = content_of(folder / "out/report.html"),
                      start = "type=\"application/json\">";
    const std::size_t from = page.find(start) + start.size();
    return Json::parse(page.substr(from, page.find("</script>", from) - from));
  }
  Child run(const std::vector<std::string>& sets = {}) const {
    std::vector<std::string> words = {"run", scene, "-o", out, "--quiet"};
    for (const std::string& set : sets) words.insert(words.end(), {"--set", set});
    return plica(words);
  }
  // What a page without a browser cannot tell
  void use(const std::string& where) const {
    const Child used =
        run_child({python(), PLICA_SOURCE_DIR "/tests/unit/app/show_report.py", where}, folder);
    if (used.status == 77) GTEST_SKIP() << used.output;
    EXPECT_EQ(used.status, 0) << used.errors;
  }
};

template <class T>
std::vector<T> decoded(const std::string& text) {
  const std::string bytes = decode_base64(text).value();
  std::vector<T> values(bytes.size() / sizeof(T));
  std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

TEST_F(ReportCommand, ShowsWhereTheBodyWas) {
  ASSERT_EQ(run({"output.volume=all", "output.probes={tip: [0, 0, 0]}"}).status, 0);
  const Child report = plica({"report", out});
  ASSERT_EQ(report.status, 0) << report.errors;
  EXPECT_TRUE(report.output.starts_with(out + "/report.html (5 frames, ")) << report.output;
  EXPECT_EQ(report.errors, "");
  const Json page = data();
  EXPECT_EQ(page["title"], "block");
  EXPECT_EQ(page["up"], Json({0, 0, 9.81}));
  ASSERT_EQ(page["films"].size(), 1) << "the surface is that of level 0, which says more";
  const Json& film = page["films"][0];
  EXPECT_EQ(film["level"], 0);
  EXPECT_FALSE(film["held"].get<bool>());
  const auto rest = decoded<float>(film["rest"]);
  const auto steps = decoded<std::uint16_t>(film["motion"]);
  ASSERT_EQ(rest.size(), 3 * 26) << "27 vertices, one of them inside";
  ASSERT_EQ(steps.size(), 5 * rest.size());
  for (const float x : rest) EXPECT_NEAR(x, x < 0.02 ? 0 : x < 0.07 ? 0.05 : 0.1, 1e-7);
  const double low = film["low"][2], high = film["high"][2];
  for (std::size_t frame = 0; frame < 5; ++frame) {
    // symplectic Euler
    const double n = 5.0 * static_cast<double>(frame), fallen = -9.81 * 1e-6 * n * (n + 1) / 2;
    const double found = low + (high - low) * steps[frame * rest.size() + 2] / 65535.0;
    EXPECT_NEAR(found, fallen, 2e-5 * (high - low)) << frame;
    EXPECT_NEAR(page["times"][frame], 1e-3 * n, 1e-12);
  }
  EXPECT_EQ(page["history"]["kinetic_energy"].size(), 5);
  EXPECT_EQ(page["probes"]["tip_z"].size(), 21);
}

TEST_F(ReportCommand, ThinsFramesEvenly) {
  ASSERT_EQ(run({"output.every=1 ms"}).status, 0);
  EXPECT_NE(plica({"report", out, "--frames", "3"}).output.find("(3 of 21 frames, "),
            std::string::npos);
  EXPECT_EQ(data()["times"], Json({0, 0.01, 0.02}));
  EXPECT_EQ(plica({"report", out, "--frames", "1"}).status, 2);
}

TEST_F(ReportCommand, UpIsAgainstGravity) {
  ASSERT_EQ(run({"gravity=[9.81, 0, 0]", "body.surface.boundary=true",
                 "contact.obstacles=[{plane: {point: [0.11, 0, 0], normal: [-1, 0, 0]}}]"})
                .status,
            0);
  ASSERT_EQ(plica({"report", out, "--quiet"}).status, 0);
  EXPECT_EQ(data()["up"][0], -9.81);
  use(out);
}

TEST_F(ReportCommand, DrawsObstaclesAsTheyTurn) {
  ASSERT_EQ(
      run({"body.surface.boundary=true",
           "contact.obstacles=[{name: quarter, box: {centre: [0.3, 0, 0], size: [0.2, "
           "0.02, 0.05]}, rotate: {curve: [{time: 0, angle: 0}, {time: 20 ms, angle: 90 deg}]}}]"})
          .status,
      0);
  ASSERT_EQ(plica({"report", out, "--quiet"}).status, 0);
  const Json turn = data()["summary"]["obstacles"][0]["turn"];
  EXPECT_EQ(turn["about"], Json({0.3, 0, 0}));
  EXPECT_NEAR(turn["path"][1]["angle"], 1.5707963, 1e-6);
  use(out);
}

TEST_F(ReportCommand, MarksTheElementOfTheDiagnosis) {
  ASSERT_EQ(run({"duration=1 s", "integration.allow_unstable=true", "integration.macro_step=20 ms",
                 "integration.substeps=1", "body.initial.angular_velocity=[0, 3, 0]",
                 "output.every=20 ms"})
                .status,
            3);
  ASSERT_EQ(plica({"report", out}).status, 0);
  const Json diagnosis = data()["summary"]["diagnosis"];
  ASSERT_TRUE(diagnosis["element"].is_number()) << diagnosis;
  ASSERT_EQ(diagnosis["corners"].size(), 4);
  for (const Json& corner : diagnosis["corners"]) EXPECT_EQ(corner.size(), 3);
  use(out);
}

TEST_F(ReportCommand, ShowsAStudy) {
  ASSERT_EQ(plica({"study", scene, "-o", out, "--quiet", "--set",
                   "study.methods=[single/symplectic_euler]", "--set",
                   "study.macro_steps=[0.5 ms, 1 ms]"})
                .status,
            0);
  const Child report = plica({"report", out});
  ASSERT_EQ(report.status, 0) << report.errors;
  EXPECT_EQ(data()["study"], json_of("out/study.json"));
  use(out);
}

TEST_F(ReportCommand, ShowsWhatAKilledRunLeft) {
  ASSERT_EQ(run().status, 0);
  std::filesystem::remove(folder / "out/summary.json");
  std::ofstream(folder / "out/frames/surface_0002.vtu") << "cut";
  const Child report = plica({"report", out});
  EXPECT_EQ(report.status, 0);
  EXPECT_NE(
      report.errors.find("warning: There is no summary.json: the run goes on, or was killed."),
      std::string::npos);
  EXPECT_NE(report.errors.find("warning: The frame at 0.01 s is left out: "), std::string::npos)
      << report.errors;
  EXPECT_EQ(data()["times"].size(), 4);
  EXPECT_EQ(data()["warnings"].size(), 2);
  use(out);
}

TEST_F(ReportCommand, ShowsARunWithoutFrames) {
  ASSERT_EQ(run().status, 0);
  std::filesystem::remove(folder / "out/frames.pvd");
  const Child report = plica({"report", out});
  EXPECT_EQ(report.status, 0);
  EXPECT_NE(report.errors.find("There are no frames: the body is not shown."), std::string::npos)
      << report.errors;
}

TEST_F(ReportCommand, SaysWhatIsNoRun) {
  const auto says = [&](const std::string& where, const std::string& words) {
    const Child report = plica({"report", where});
    EXPECT_EQ(report.status, 2);
    EXPECT_NE(report.errors.find(words), std::string::npos) << report.errors;
  };
  ASSERT_EQ(run().status, 0);
  says(folder / "ouf",
       "there is no folder " + std::string(folder / "ouf") + "; did you mean 'out'?");
  says(scene, "is a file; expected the folder of a run or a study");
  says(folder.path().string(), "(folders in it that do: out)");
  std::ofstream(folder / "out/history.csv") << "time,kinetic_energy\n0,1\n0.1\n";
  says(out, "history.csv:3: expected 2 values, found 1");
  std::ofstream(folder / "out/history.csv") << "time\n0\nx\n";
  says(out, "history.csv:3: expected a number, found 'x'");
  std::ofstream(folder / "out/summary.json") << "{";
  says(out, "summary.json: it is damaged: ");
  std::ofstream(folder / "out/summary.json") << R"({"name": "a", "status": "completed"})";
  says(out, "summary.json: it is not what plica wrote there: there is no 'levels'");
}

TEST_F(ReportCommand, NamesCannotBreakOutOfThePage) {
  ASSERT_EQ(run({"name='</script><script>alert(1)</script>'"}).status, 0);
  ASSERT_EQ(plica({"report", out}).status, 0);
  EXPECT_EQ(data()["title"], "</script><script>alert(1)</script>");
  EXPECT_EQ(content_of(folder / "out/report.html").find("<script>alert"), std::string::npos);
}

}  // namespace
}  // namespace plica::app::test
