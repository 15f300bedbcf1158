// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <plica/drivers/app/report/frames_of_cuts.hpp>
#include <plica/drivers/app/report/read_files.hpp>

#include "unit/app/child.hpp"
#include "unit/app/scene_text.hpp"

// Runs of scenes with cuts: their files, and how they go on.
namespace plica::app::test {
namespace {

// A slab that is held at both ends, and a blade that comes down through its middle from 2 to 12 ms
constexpr const char* cut_slab = R"(duration: 20 ms
gravity: [0, 0, -9.81]
body:
  levels: [{box: {size: [0.12, 0.06, 0.02], cells: [8, 4, 2]}}]
  material: {young_modulus: 10 kPa}
  fixed: [{half_space: {normal: [1, 0, 0]}}, {half_space: {point: [0.12, 0, 0], normal: [-1, 0, 0]}}]
cuts:
  - blade:
      segment: [[6 cm, -1 cm, 3 cm], [6 cm, 7 cm, 3 cm]]
      curve: [{time: 2 ms, displacement: [0, 0, 0]}, {time: 12 ms, displacement: [0, 0, -5 cm]}]
    from: 2 ms
    to: 12 ms
integration: {cycle: single, macro_step: 0.2 ms}
output: {every: 2 ms, volume: all, probes: {left: [55 mm, 3 cm, 1 cm], right: [65 mm, 3 cm, 1 cm]}}
)";

class Cutting : public ProgramTest {
 protected:
  Cutting() : ProgramTest(cut_slab) {}
  FrameFile frame(const std::string& run, const std::string& name) const {
    return read_frame(folder / (run + "/frames/" + name + ".vtu"));
  }
};

// The plane x = 6 cm is one of the mesh's: 4 x 2 squares of two triangles, 5 x 3 vertices
TEST_F(Cutting, IsInTheFiles) {
  const Child child = plica({"run", scene, "-o", out, "--quiet", "--threads", "1"});
  ASSERT_EQ(child.status, 0) << child.errors;
  const Json cuts = json_of("out/summary.json").at("cuts");
  EXPECT_EQ(cuts.at("opened_faces"), 16);
  EXPECT_EQ(cuts.at("new_vertices"), 15);
  EXPECT_EQ(cuts.at("pieces"), 2);
  const FrameFile first = frame("out", "volume_0000"), last = frame("out", "volume_0010");
  EXPECT_EQ(first.points.size(), 9u * 5u * 3u);
  EXPECT_EQ(last.points.size(), 10u * 5u * 3u);
  EXPECT_EQ(last.tets.size(), first.tets.size());
  double mass = 0;
  for (const double m : last.find("mass")->values) mass += m;
  EXPECT_NEAR(mass, 1000 * 0.12 * 0.06 * 0.02, 1e-12);
  // both sides of the cut are in the surface, and the files' rest shapes fit
  EXPECT_EQ(frame("out", "surface_0010").triangles.size(),
            frame("out", "surface_0000").triangles.size() + 2u * 16u);
  const FrameArray* moved = last.find("displacement");
  for (std::size_t i = 0; i < last.points.size(); ++i) {
    const double x = last.points[i].x() - moved->values[3 * i];
    EXPECT_NEAR(x / 0.015, std::round(x / 0.015), 1e-9) << "a plane of the mesh";
  }
}

TEST_F(Cutting, IsInAReport) {
  ASSERT_EQ(plica({"run", scene, "-o", out, "--quiet", "--threads", "1"}).status, 0);
  const Child child = plica({"report", out});
  EXPECT_EQ(child.status, 0);
  EXPECT_EQ(child.errors.find("left out"), std::string::npos) << child.errors;
  FrameFile first = frame("out", "volume_0000");
  const FrameFile last = frame("out", "volume_0010");
  take_mesh_of_last(first, last);
  EXPECT_EQ(first.points.size(), last.points.size());
  EXPECT_EQ(first.tets, last.tets);
  const FrameArray* moved = last.find("displacement");
  for (std::size_t i = 0; i < last.points.size(); ++i) {
    const Point rest = last.points[i] - Point(&moved->values[3 * i]);
    EXPECT_LE((first.points[i] - rest).norm(), 1e-12) << "at first, nothing has moved";
  }
}

TEST_F(Cutting, GoesOnFromACheckpoint) {
  ASSERT_EQ(plica({"run", scene, "-o", folder / "whole", "--quiet", "--threads", "1"}).status, 0);
  ASSERT_EQ(plica({"run", scene, "-o", out, "--quiet", "--threads", "1", "--duration", "8 ms",
                   "--checkpoint", "every=1 steps"})
                .status,
            0);
  const Json before = json_of("out/summary.json").at("cuts");
  EXPECT_GT(before.at("opened_faces"), 0);
  const Child child =
      plica({"run", "--resume", out, "--quiet", "--threads", "1", "--duration", "20 ms"});
  ASSERT_EQ(child.status, 0) << child.errors;
  EXPECT_EQ(json_of("out/summary.json").at("cuts"), json_of("whole/summary.json").at("cuts"));
  for (const char* file :
       {"frames/volume_0010.vtu", "frames/surface_0010.vtu", "frames/volume_0005.vtu"})
    EXPECT_TRUE(content_of(folder / (std::string("out/") + file)) ==
                content_of(folder / (std::string("whole/") + file)))
        << file;
  EXPECT_EQ(content_of(folder / "out/probes.csv"), content_of(folder / "whole/probes.csv"));
}

TEST_F(Cutting, IsRefusedWhereItCannotBeFollowed) {
  const Child study = plica({"study", scene, "-o", folder / "study", "--quiet"});
  EXPECT_EQ(study.status, 2);
  EXPECT_NE(study.errors.find("cuts: a study compares states of one mesh"), std::string::npos)
      << study.errors;
}

TEST(CutKeys, AreChecked) {
  const auto said = [](const std::string& piece, const std::string& replacement) {
    std::string text = cut_slab;
    return error_of(text.replace(text.find(piece), piece.size(), replacement));
  };
  const auto has = [](const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos ? part : text;
  };
  const std::string ends = "[[6 cm, -1 cm, 3 cm], [6 cm, 7 cm, 3 cm]]";
  for (const auto& [piece, replacement, expected] :
       {std::array<std::string, 3>{ends, "[[6 cm, -1 cm, 3 cm], [6 cm, -1 cm, 3 cm]]",
                                   "cuts.0.blade.segment has no length"},
        {ends, "[[6 cm, -1 cm, 3 cm]]", "cuts.0.blade.segment has 1 point; expected two"},
        {"from: 2 ms", "from: 12 ms", "cuts.0.to is 0.012 s; expected a time after from, 0.012 s"},
        {"cycle: single", "cycle: rsv",
         "cuts: integration.cycle is rsv, whose levels cannot follow a cut; expected single or "
         "him"},
        {"segment:", "segments:", "segment"}})
    EXPECT_EQ(has(said(piece, replacement), expected), expected);
  EXPECT_EQ(said("duration: 20 ms", "duration: 21 ms"), "no error");
}

}  // namespace
}  // namespace plica::app::test
