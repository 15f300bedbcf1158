// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <numeric>
#include <plica/core/error.hpp>
#include <plica/drivers/app/output/json_parts.hpp>
#include <plica/drivers/app/output/run_files.hpp>
#include <plica/drivers/app/output/summary.hpp>
#include <plica/drivers/app/output/terminal.hpp>
#include <plica/drivers/app/output/write_file.hpp>
#include <plica/drivers/app/report/read_files.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <sstream>

#include "support/three_constants.hpp"
#include "unit/app/child.hpp"
#include "unit/app/scene_text.hpp"

namespace plica::app::test {
namespace {

constexpr const char* block = R"(duration: 1
body:
  levels: [{box: {size: [1, 1, 1], cells: [2, 2, 2]}}]
  initial: {position: [0, 0, 1]}
output: {volume: true}
)";

// The block moved by its placement and a little more
Snapshot moved(const Scene& scene, double time, const Point& by) {
  Snapshot snapshot;
  snapshot.time = time;
  for (const Point& p : scene.problem.body.levels[0].vertices) {
    snapshot.positions.push_back(p + Point(-0.5, -0.5, 0.5) + by);
    snapshot.velocities.emplace_back(3, 0, 4);
  }
  const std::size_t tets = scene.problem.body.levels[0].tets.size();
  if (!scene.output.volume.levels.empty())
    snapshot.volumes = {{0,
                         snapshot.positions,
                         snapshot.velocities,
                         {false, std::vector(tets, 7.0), std::vector(tets, 0.9)}}};
  snapshot.energies = {.kinetic = 1, .elastic = 2, .potential = -4, .contact = 0.5};
  return snapshot;
}

TEST(WriteFile, ReplacesAsAWhole) {
  const TemporaryFolder folder;
  write_file(folder / "a", "one");
  write_file(folder / "a", "two");
  EXPECT_EQ(content_of(folder / "a"), "two");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(WriteFile, FailsWithTheName) {
  const TemporaryFolder folder;
  EXPECT_THROW(write_file(folder / "no/such/folder", "x"), FileError);
  write_file(folder / "a", "a file");
  EXPECT_THROW(make_folder(folder / "a/b"), FolderError);
  EXPECT_THROW(make_folder(folder / "a"), FolderError);
}

// a region that the scene selects weighs what it says, in every file
TEST(RunFiles, KnowTheSelectedRegions) {
  const TemporaryFolder folder;
  const Scene scene = scene_of(
      std::string(block) + "  # the upper half\n",
      {"body.regions={heavy: {where: {box: {min: [0, 0, 0.5], max: [1, 1, 1]}}, density: 3000}}"});
  RunFiles files(scene, folder.path());
  files.write(moved(scene, 0, Point::Zero()));
  EXPECT_NE(content_of(folder / "frames/volume_0000.vtu").find("\"region\""), std::string::npos);
  std::istringstream history(content_of(folder / "history.csv"));
  std::string head, row;
  std::getline(history, head), std::getline(history, row);
  std::vector<double> values;
  std::istringstream columns(row);
  for (std::string value; std::getline(columns, value, ',');) values.push_back(std::stod(value));
  // centres of the halves at 0.75 and 1.25 m weigh 500 and 1500 kg; lumping takes some of it across
  EXPECT_NEAR(values.at(8), 1.125, 0.03);
}

TEST(StepCount, CoversTheDuration) {
  EXPECT_EQ(steps_to_cover(3, 0.03), 100);
  EXPECT_EQ(steps_to_cover(3.0001, 0.03), 101);
  EXPECT_EQ(steps_to_cover(1e-300, 0.03), 1);
  EXPECT_THROW(steps_to_cover(1, 1e-300), InputError);
}

TEST(MaterialText, HasTheParametersThatTheMaterialDeclares) {
  MaterialOptions material;
  material.parameters = {{"c1", 5e3}};
  const MaterialInfo info = plica::test::three_constants();
  EXPECT_EQ(material_text(info, material),
            "three_constants, c1 5 kPa, c2 700 Pa, bulk 30 kPa, density 1000 kg/m^3");
  EXPECT_EQ(
      material_json(info, material).dump(),
      R"({"model":"three_constants","c1":5000.0,"c2":700.0,"bulk":30000.0,"density":1000.0})");
  EXPECT_EQ(material_text(*find_material("neo_hookean"), {}),
            "neo_hookean, young_modulus 20 kPa, poisson_ratio 0.4, density 1000 kg/m^3");
}

TEST(RunFiles, KeepOnlyThisRun) {
  const TemporaryFolder folder;
  make_folder(folder / "frames");
  for (const char* stale :
       {"summary.json", "frames/surface_0007.vtu", "frames/volume_0000.vtu", "frames/mine.vtu"})
    write_file(folder / stale, "old");
  const Scene scene = scene_of(block, {"output.volume=false"});
  RunFiles files(scene, folder.path());
  EXPECT_FALSE(std::filesystem::exists(folder / "summary.json"));
  files.write(moved(scene, 0, Point::Zero()));
  files.write(moved(scene, 0.5, Point::Zero()));
  EXPECT_EQ(files.frames(), 2);
  EXPECT_EQ(files.last_time(), 0.5);
  EXPECT_TRUE(std::filesystem::exists(folder / "frames/surface_0001.vtu"));
  EXPECT_FALSE(std::filesystem::exists(folder / "frames/surface_0007.vtu"));
  EXPECT_FALSE(std::filesystem::exists(folder / "frames/volume_0000.vtu"));
  EXPECT_TRUE(std::filesystem::exists(folder / "frames/mine.vtu"));
  EXPECT_NE(content_of(folder / "frames.pvd")
                .find("timestep=\"0.5\" part=\"0\" file=\"frames/surface_0001.vtu\""),
            std::string::npos);
}

TEST(RunFiles, LeaveAPageThatShowsSomethingElse) {
  const TemporaryFolder folder;
  const Scene scene = scene_of(block);
  write_file(folder / "report.html", "of a study");
  EXPECT_TRUE(former_run(folder.path()).empty());
  { RunFiles files(scene, folder.path()); }
  EXPECT_TRUE(std::filesystem::exists(folder / "report.html"));
  EXPECT_EQ(former_run(folder.path()), std::vector<std::string>{"history.csv"});
  { RunFiles files(scene, folder.path()); }
  EXPECT_FALSE(std::filesystem::exists(folder / "report.html"));
}

TEST(RunFiles, HistoryHasItsColumns) {
  const TemporaryFolder folder;
  const Scene scene = scene_of(block);
  RunFiles files(scene, folder.path());
  files.write(moved(scene, 0.25, {0, 0, 0.5}));
  EXPECT_EQ(content_of(folder / "history.csv").substr(0, 71),
            "time,kinetic_energy,elastic_energy,potential_energy,contact_energy,tota");
  const std::string text = content_of(folder / "history.csv"),
                    row = text.substr(text.find('\n') + 1);
  std::vector<double> numbers;
  std::istringstream fields(row);
  for (std::string field; std::getline(fields, field, ',');) numbers.push_back(std::stod(field));
  const std::vector<double> expected = {0.25, 1, 2, -4, 0.5, -0.5, 0, 0, 1.5, 5, 5};
  ASSERT_EQ(numbers.size(), expected.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) EXPECT_NEAR(numbers[i], expected[i], 1e-9) << i;
}

TEST(RunFiles, HistoryHasTheObstaclesWrenches) {
  const TemporaryFolder folder;
  Scene scene = scene_of(block);
  scene.problem.contact.obstacles.push_back({PlaneOptions{}, {}, {}, "floor"});
  RunFiles files(scene, folder.path());
  Snapshot now = moved(scene, 0.25, {0, 0, 0.5});
  now.wrenches.assign(scene.problem.contact.obstacles.size(), {"", {1, 2, 3}, {4, 5, 6}});
  files.write(now);
  const std::string text = content_of(folder / "history.csv");
  EXPECT_NE(text.find(",floor.force_x,floor.force_y,floor.force_z,floor.torque_x,floor.torque_y,"
                      "floor.torque_z\n"),
            std::string::npos)
      << text;
  EXPECT_TRUE(text.ends_with(",1,2,3,4,5,6\n")) << text;
}

TEST(RunFiles, HistoryCountsHeldPoints) {
  const TemporaryFolder folder;
  Scene scene = scene_of(block);
  scene.problem.contact.obstacles.push_back({PlaneOptions{}, {}, {}, "floor"});
  scene.problem.contact.obstacles[0].grasp = GraspOptions{.from = {0.1, 0.4}, .until = {0.3}};
  RunFiles files(scene, folder.path());
  Snapshot now = moved(scene, 0.25, {0, 0, 0.5});
  now.wrenches.assign(1, {"", {1, 2, 3}, {4, 5, 6}});
  now.held = {{"floor", {7, 8, 9}}};
  files.write(now);
  const std::string text = content_of(folder / "history.csv");
  EXPECT_NE(text.find("floor.torque_z,floor.held\n"), std::string::npos) << text;
  EXPECT_TRUE(text.ends_with(",4,5,6,3\n")) << text;

  const auto warns = [&](double time, const std::vector<int>& points) {
    now.time = time, now.held[0].points = points;
    return !empty_handed(scene.problem.contact, now, 0.01).empty();
  };
  EXPECT_FALSE(warns(0.25, {7}));
  EXPECT_TRUE(warns(0.25, {}));
  EXPECT_TRUE(warns(1, {}));
  for (const double open : {0.05, 0.1, 0.35}) EXPECT_FALSE(warns(open, {})) << open;
}

// A column more, and only where bad macro steps are retried
TEST(RunFiles, HistoryCountsHalvings) {
  const TemporaryFolder folder;
  const Scene scene = scene_of(block, {"integration.on_failure.halvings=3"});
  RunFiles files(scene, folder.path());
  Snapshot snapshot = moved(scene, 0.25, {0, 0, 0.5});
  snapshot.step_halvings = 12;
  files.write(snapshot);
  const std::string text = content_of(folder / "history.csv");
  EXPECT_NE(text.find("rms_speed,step_halvings\n"), std::string::npos);
  EXPECT_TRUE(text.ends_with(",12\n")) << text;
}

TEST(RunFiles, VolumesHaveTheirFields) {
  const TemporaryFolder folder;
  const Scene scene = scene_of(block);
  RunFiles files(scene, folder.path());
  files.write(moved(scene, 0.25, {0, 0, 0.5}));
  const FrameFile frame = read_frame(folder / "frames/volume_0000.vtu");
  std::vector<std::string> names;
  for (const FrameArray& array : frame.arrays) names.push_back(array.name);
  ASSERT_EQ(names,
            (std::vector<std::string>{"displacement", "velocity", "mass", "von_mises", "J"}));
  EXPECT_EQ(frame.find("von_mises")->values, std::vector(48, 7.0));
  EXPECT_EQ(frame.find("J")->values, std::vector(48, 0.9));
  const std::vector<double>& mass = frame.find("mass")->values;
  ASSERT_EQ(mass.size(), 27);
  EXPECT_NEAR(std::accumulate(mass.begin(), mass.end(), 0.0), 1000, 1e-9);
  EXPECT_EQ(frame.find("displacement")->values.size(), 81);
  EXPECT_EQ(frame.find("velocity")->values.size(), 81);
}

// A value for each tetrahedron in the order of the simulation, and where the file has it
TEST(RunFiles, WriteTheFieldsThatAreAskedFor) {
  const TemporaryFolder folder;
  const Scene scene = scene_of(
      block, {"output.fields=[stress, pressure, principal_stretches, contact_pressure]",
              "body.surface.boundary=true", "contact.obstacles=[{plane: {point: [0, 0, 0]}}]"});
  RunFiles files(scene, folder.path());
  Snapshot now = moved(scene, 0.25, {0, 0, 0.5});
  ElementFields& fields = now.volumes[0].elements;
  for (int e = 0; e < 48; ++e) {
    for (const double s : {1, 2, 3, 4, 5, 6}) fields.stress.push_back(10 * e + s);
    fields.pressure.push_back(-10 * e - 2);
    for (const double l : {3, 2, 1}) fields.principal_stretches.push_back(e + l);
  }
  const std::size_t points = scene.problem.body.surface->vertices.size();
  now.surface.assign(points, Point::Zero()), now.surface_velocities = now.surface;
  for (std::size_t i = 0; i < points; ++i) now.contact_pressure.push_back(static_cast<double>(i));
  files.write(now);
  const FrameFile volume = read_frame(folder / "frames/volume_0000.vtu"),
                  surface = read_frame(folder / "frames/surface_0000.vtu");
  ASSERT_NE(volume.find("stress"), nullptr);
  EXPECT_EQ(volume.find("stress")->components, 6);
  EXPECT_TRUE(volume.find("stress")->of_cells);
  EXPECT_EQ(volume.find("principal_stretches")->components, 3);
  EXPECT_EQ(volume.find("pressure")->components, 1);
  const std::vector<int>& order = scene.numbering[0].input.tets;
  for (std::size_t row = 0; row < 48; ++row) {
    const int e = order.empty() ? static_cast<int>(row) : order[row];
    for (std::size_t k = 0; k < 6; ++k)
      EXPECT_EQ(volume.find("stress")->values[6 * row + k], 10 * e + static_cast<int>(k) + 1);
    EXPECT_EQ(volume.find("pressure")->values[row], -10 * e - 2);
    EXPECT_EQ(volume.find("principal_stretches")->values[3 * row], e + 3);
    EXPECT_EQ(volume.find("principal_stretches")->values[3 * row + 2], e + 1);
  }
  ASSERT_NE(surface.find("contact_pressure"), nullptr);
  EXPECT_FALSE(surface.find("contact_pressure")->of_cells);
  EXPECT_EQ(surface.find("contact_pressure")->values, now.contact_pressure);
  EXPECT_EQ(volume.find("contact_pressure"), nullptr);
}

TEST(RunFiles, RefuseFieldsThatNobodyWrites) {
  const auto refused = [](const std::vector<std::string>& sets) { return error_of(block, sets); };
  EXPECT_NE(
      refused({"output.fields=[stress, presure]"})
          .find("output.fields.1: unknown field 'presure'; did you mean 'pressure'? (choices: "
                "stress, pressure, principal_stretches, contact_pressure, normals, "
                "texture_coordinates)"),
      std::string::npos);
  EXPECT_NE(refused({"output.fields=stress", "output.volume=false"}).find("expected output.volume"),
            std::string::npos);
  EXPECT_NE(refused({"output.fields=contact_pressure"}).find("expected contact.obstacles"),
            std::string::npos);
  EXPECT_EQ(refused({"output.fields=stress"}), "no error");
}

TEST(RunFiles, GoOnFromTheirMark) {
  const TemporaryFolder folder;
  const Scene scene = scene_of(block);
  FilesMark mark;
  std::string kept;
  {
    RunFiles files(scene, folder.path());
    files.write(moved(scene, 0, Point::Zero()));
    files.write(moved(scene, 0.25, Point::Zero()));
    mark = files.mark();
    kept = content_of(folder / "history.csv") + content_of(folder / "frames.pvd") +
           content_of(folder / "volume.pvd");
    for (const double time : {0.5, 0.75}) files.write(moved(scene, time, {0, 0, 1}));
  }
  write_file(folder / "frames/surface_0004.vtu.part", "half a frame");
  const RunFiles files(scene, folder.path(), mark);
  EXPECT_EQ(content_of(folder / "history.csv") + content_of(folder / "frames.pvd") +
                content_of(folder / "volume.pvd"),
            kept);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder / "frames"), {}), 4);
  EXPECT_EQ(files.last_time(), 0.25);
}

TEST(VertexMasses, AddUpToTheBody) {
  Scene scene = scene_of(block, {"body.material.density=3"});
  Body& body = scene.problem.body;
  const auto total = [&] {
    const std::vector<double> masses = vertex_masses(body);
    return std::accumulate(masses.begin(), masses.end(), 0.0);
  };
  EXPECT_NEAR(total(), 3, 1e-12);
  body.levels[0].region.assign(body.levels[0].tets.size(), 0);
  for (std::size_t e = 0; e < body.levels[0].tets.size(); e += 2) body.levels[0].region[e] = 1;
  body.levels[0].region_names = {"soft", "heavy"};
  body.regions["heavy"].density = 5;
  EXPECT_NEAR(total(), 4, 1e-12);
}

TEST(Summary, IsJsonWithItsFields) {
  const Scene scene = scene_of(sound_scene);
  Summary summary;
  summary.status = "diverged";
  summary.levels.resize(2);
  Diagnosis& diagnosis = summary.diagnosis.emplace();
  diagnosis.kind = "inverted";
  diagnosis.element = 7;
  const auto json = nlohmann::json::parse(summary_json(scene, summary, {"plica", "run", "a.yaml"}));
  for (const char* key :
       {"status", "simulated_time", "macro_step", "macro_steps", "wall_time", "setup_time",
        "peak_memory", "precision", "backend", "threads", "cycle", "levels", "stages", "counters",
        "last_good_time", "diagnosis", "wrenches"})
    EXPECT_TRUE(json.contains(key)) << key;
  for (const char* key : {"vertices", "tets", "critical_step", "share", "substeps", "integrator"})
    EXPECT_TRUE(json["levels"][0].contains(key)) << key;
  EXPECT_EQ(json["diagnosis"]["element"], 7);
  EXPECT_TRUE(json["diagnosis"]["vertex"].is_null());
  EXPECT_EQ(json["obstacles"][0]["plane"]["point"][2], -0.1);
  summary.diagnosis.reset();
  EXPECT_TRUE(nlohmann::json::parse(summary_json(scene, summary, {}))["diagnosis"].is_null());
}

// What VTK reads from a file: points, cells, type of the cells, time, sums of the displacements and
// velocities; nothing where there is no VTK
std::vector<double> read_by_vtk(const std::filesystem::path& file, const TemporaryFolder& folder) {
  const Child child =
      run_child({python(), PLICA_SOURCE_DIR "/tests/unit/app/read_vtu.py", file.string()}, folder);
  std::vector<double> numbers;
  constexpr int no_vtk = 77, no_python = 127;
  if (child.status == no_vtk || child.status == no_python || child.status < 0) return numbers;
  EXPECT_EQ(child.status, 0) << child.errors;
  std::istringstream words(child.output);
  for (double value = 0; words >> value;) numbers.push_back(value);
  return numbers;
}

TEST(Vtu, IsReadByVtk) {
  const TemporaryFolder folder;
  const Scene scene = scene_of(block);
  RunFiles files(scene, folder.path());
  files.write(moved(scene, 0.125, {0, 0, 0.5}));
  const auto surface = read_by_vtk(folder / "frames/surface_0000.vtu", folder);
  if (surface.empty()) GTEST_SKIP() << "no Python with VTK here (cmake/setup vtk)";
  EXPECT_EQ(surface, (std::vector<double>{26, 48, 5, 0.125, 0, 0, 13, 78, 0, 104}));
  const auto volume = read_by_vtk(folder / "frames/volume_0000.vtu", folder);
  EXPECT_EQ(volume, (std::vector<double>{27, 48, 10, 0.125, 0, 0, 13.5, 81, 0, 108}));
}

// What is printed of elements that hold a step back, and of steps that were bad.
LevelReport level_with(double worst) {
  LevelReport level;
  level.element_bound = worst, level.typical_element = 1e-3, level.critical_step = 1.1 * worst;
  level.share = 1, level.substeps = 1;
  level.stiffest = {{71, "bone", 25, worst}, {8, "", 1.9, 0.6e-3}};
  return level;
}

TEST(PlanText, NamesElementsThatAreOutOfTheOrdinary) {
  const Scene scene = scene_of(sound_scene);
  Plan plan;
  plan.macro_step = 1e-3, plan.levels = {level_with(0.04e-3)};
  const std::string text = plan_text(scene, plan);
  EXPECT_NE(text.find("Elements that limit the step"), std::string::npos) << text;
  EXPECT_NE(text.find("71"), std::string::npos);
  EXPECT_NE(text.find("bone"), std::string::npos);
  EXPECT_EQ(text.find("0.6 ms"), std::string::npos) << text;  // more than half the median
  plan.levels = {level_with(0.55e-3)};
  EXPECT_EQ(plan_text(scene, plan).find("limit the step"), std::string::npos);
}

TEST(ManySteps, AreToldWithWhatTheSceneDoesNotHave) {
  Summary summary;
  summary.macro_step = 1e-7, summary.cycle = "single", summary.levels = {level_with(1e-6)};
  Scene scene = scene_of(block);
  const std::string
      begin = "integration.macro_step: the run takes 1e+07 macro steps of 100 ns; expected ",
      end =
          ", or a mesh without slivers (plica explain names them), or a poisson_ratio further from "
          "0.5";
  EXPECT_EQ(many_steps_text(scene, summary), begin + "an implicit integrator, or cycle: him" + end);
  summary.cycle = "him";
  EXPECT_EQ(many_steps_text(scene, summary), begin + "an implicit integrator" + end);
  summary.levels[0].explicit_integrator = false, scene.problem.integration.macro_step = 1e-7;
  EXPECT_EQ(many_steps_text(scene, summary), begin + "a longer one");
  summary.macro_step = 1e-3;
  EXPECT_EQ(many_steps_text(scene, summary), "");
}

TEST(LevelsJson, HaveTheStiffestElements) {
  const nlohmann::ordered_json levels = levels_json({level_with(0.04e-3)});
  EXPECT_EQ(levels[0]["typical_element"], 1e-3);
  ASSERT_EQ(levels[0]["stiffest"].size(), 2u);
  EXPECT_EQ(levels[0]["stiffest"][0],
            (nlohmann::ordered_json{
                {"element", 71}, {"region", "bone"}, {"height_ratio", 25}, {"step", 0.04e-3}}));
}

TEST(Keys, OfBadStatesAndSteps) {
  const Scene scene = scene_of(
      sound_scene, {"body.initial.stretch=[1, 0, -1]", "body.material.allow_inversion=true",
                    "integration.on_failure.halvings=3"});
  EXPECT_EQ(scene.problem.body.initial.stretch, Point(1, 0, -1));
  EXPECT_EQ(scene.problem.body.material.allow_inversion, true);
  EXPECT_EQ(scene.problem.integration.on_failure.halvings, 3);
  EXPECT_EQ(scene_of(sound_scene, {"body.initial.random=7"}).problem.body.initial.random, 7);
  EXPECT_FALSE(scene_of(sound_scene).problem.body.material.allow_inversion);
  EXPECT_NE(error_of(sound_scene, {"body.initial.random=seven"}).find("body.initial.random"),
            std::string::npos);
}

TEST(Text, NumbersInUnits) {
  EXPECT_EQ(in_units(0.00194, "s"), "1.94 ms");
  EXPECT_EQ(in_units(0.99999, "s"), "1 s");
  EXPECT_EQ(in_units(4500, "s"), "4.5e+03 s");
  EXPECT_EQ(in_units(50e3, "Pa"), "50 kPa");
  EXPECT_EQ(in_units(3e-6, "m"), "3 um");
  EXPECT_EQ(in_units(1.331, "kg"), "1.331 kg");
  EXPECT_EQ(in_units(0, "s"), "0 s");
  EXPECT_EQ(counted(1, "frame"), "1 frame");
  EXPECT_EQ(counted(0, "frame"), "0 frames");
  EXPECT_EQ(in_bytes(999), "999 B");
  EXPECT_EQ(in_bytes(12345678), "12.3 MB");
}

TEST(Text, TablesAlign) {
  EXPECT_EQ(text_table({{"a", "bb", "c"}, {"aaa", "b", ""}}, "<>>", ""), "a    bb  c\naaa   b\n");
  EXPECT_EQ(text_table({{"\xC3\xA4\xC3\xA4", "b"}, {"a", "b"}}, ">>", ""),
            "\xC3\xA4\xC3\xA4  b\n a  b\n")
      << "letters, not bytes";
}

TEST(Text, WordsOfAShell) {
  EXPECT_EQ(shell_word("o/p_1") + shell_word("my b's"), "o/p_1'my b'\\''s'");
}

TEST(Text, LinesWrap) { EXPECT_EQ(wrapped("one two three", 10, "  "), "  one two\n  three\n"); }

TEST(Text, ProgressFitsItsTerminal) {
  const std::string line = progress_line(0.62, 3, 500, 0.5, 100);
  EXPECT_EQ(line,
            "0.62 / 3.00 s [#####........................]  21 %   1000 steps/s   1.24 x real time "
            "   1.9 s left");
  for (int width = 1; width < 140; ++width)
    EXPECT_LT(progress_line(0.62, 3, 500, 0.5, width).size(), static_cast<std::size_t>(width))
        << width;
}

}  // namespace
}  // namespace plica::app::test
