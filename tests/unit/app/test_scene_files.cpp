// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <plica/drivers/app/output/run_files.hpp>
#include <plica/drivers/app/report/read_files.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/files/mesh_files.hpp>

#include "unit/app/child.hpp"
#include "unit/app/scene_text.hpp"

// Scenes whose meshes and surfaces come from files
namespace plica::app::test {
namespace {

const std::filesystem::path samples =
    std::filesystem::path(PLICA_SOURCE_DIR) / "meshes" / "data" / "formats";

std::string of_files(const std::string& level, const std::string& surface = "") {
  return "duration: 1\nbody:\n  levels: [{file: " + level + "}]\n" +
         (surface.empty() ? "" : "  surface: {file: " + surface + "}\n") +
         "output: {volume: true}\n";
}

std::string sample(const char* name) { return (samples / name).string(); }

bool mentions(const std::vector<std::string>& sentences, const std::string& piece) {
  return std::ranges::any_of(
      sentences, [&](const std::string& s) { return s.find(piece) != std::string::npos; });
}

TEST(SceneFiles, KeepTheNumbersOfTheFile) {
  for (const char* name :
       {"blocks_41.msh", "blocks.ele", "blocks_51_binary.vtk", "../liver_coarse.msh"}) {
    MeshReport report;
    const TetMesh input = read_mesh(samples / name, &report);
    const Scene scene = scene_of(of_files(sample(name)));
    const TetMesh& mesh = scene.problem.body.levels[0];
    const Numbering& numbering = scene.numbering[0];
    EXPECT_LE(mean_vertex_span(mesh), mean_vertex_span(input));
    if (name[0] == '.') {
      EXPECT_LT(mean_vertex_span(mesh), 0.8 * mean_vertex_span(input));
    }
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
      const auto at = std::ranges::find(report.vertex_tags,
                                        input_number(numbering.vertex_ids, static_cast<int>(v)));
      EXPECT_EQ(mesh.vertices[v],
                input.vertices[static_cast<std::size_t>(at - report.vertex_tags.begin())]);
    }
    const TetMesh back = in_input_order(mesh, numbering);
    EXPECT_EQ(back.vertices, input.vertices);
    EXPECT_EQ(back.tets, input.tets);
    EXPECT_EQ(back.region, input.region);
    EXPECT_EQ(back.vertex_sets, input.vertex_sets);
    EXPECT_EQ(input_number(numbering.tet_ids, -1), -1);
  }
}

// body.order: hilbert depends on the mesh alone; numbers for users stay those of the input.
TEST(SceneFiles, AreOrderedAlongACurveOnRequest) {
  const auto expect_along_curve = [](const TetMesh& mesh) {
    const Reordering order = locality_order(mesh);
    EXPECT_TRUE(std::ranges::is_sorted(order.tets));
    EXPECT_TRUE(std::ranges::is_sorted(order.vertices));
  };
  for (const char* name : {"blocks_41.msh", "../liver_coarse.msh"}) {
    MeshReport report;
    const TetMesh input = read_mesh(samples / name, &report);
    const Scene scene = scene_of(of_files(sample(name)), {"body.order=hilbert"});
    const Numbering& numbering = scene.numbering[0];
    expect_along_curve(scene.problem.body.levels[0]);
    EXPECT_EQ(in_input_order(scene.problem.body.levels[0], numbering).tets, input.tets);
    for (std::size_t t = 0; t < input.tets.size(); ++t)
      EXPECT_EQ(numbering.tet_ids[static_cast<std::size_t>(numbering.input.tets[t])],
                static_cast<int>(report.tet_tags[t]));
  }
  const Scene made = scene_of(sound_scene, {"body.order=hilbert"});
  for (std::size_t i = 0; i < 2; ++i) {
    const TetMesh& mesh = made.problem.body.levels[i];
    expect_along_curve(mesh);
    const TetMesh given = scene_of(sound_scene).problem.body.levels[i],
                  back = in_input_order(mesh, made.numbering[i]);
    EXPECT_NE(mesh.tets, given.tets);
    EXPECT_EQ(back.tets, given.tets);
    EXPECT_EQ(back.vertices, given.vertices);
  }
}

TEST(SceneFiles, FramesAreInTheOrderOfTheFile) {
  const TemporaryFolder folder;
  const TetMesh input = read_mesh(samples / "../liver_coarse.msh");
  const Scene scene = scene_of(of_files(sample("../liver_coarse.msh")));
  ASSERT_NE(scene.problem.body.levels[0].tets, input.tets);
  RunFiles files(scene, folder.path());
  Snapshot snapshot;
  const std::vector<double> ones(input.tets.size(), 1);
  snapshot.positions = snapshot.velocities = scene.problem.body.levels[0].vertices;
  snapshot.volumes = {{0, snapshot.positions, snapshot.velocities, {false, ones, ones}}};
  files.write(snapshot);
  const TetMesh volume = read_mesh(folder / "frames/volume_0000.vtu");
  EXPECT_EQ(volume.vertices, input.vertices);
  EXPECT_EQ(volume.tets, input.tets);
  EXPECT_EQ(read_frame(folder / "frames/surface_0000.vtu").points,
            boundary_surface(input).surface.vertices);
}

TEST(SceneFiles, TheBoundaryIsInTheOrderOfTheFile) {
  const Scene scene =
      scene_of("duration: 1\nbody: {levels: [{file: " + sample("../liver_coarse.msh") +
               "}], surface: {boundary: true}}\n");
  const TriangleSurface expected =
      boundary_surface(read_mesh(samples / "../liver_coarse.msh")).surface;
  EXPECT_EQ(scene.problem.body.surface->vertices, expected.vertices);
  EXPECT_EQ(scene.problem.body.surface->triangles, expected.triangles);
}

TEST(SceneFiles, SurfaceIsScaled) {
  const TriangleSurface metres =
      *scene_of(of_files(sample("blocks_41.msh"), sample("blocks.obj"))).problem.body.surface;
  const Scene scene =
      scene_of(of_files(sample("blocks_41.msh"), sample("blocks.obj") + ", scale: 0.5"));
  const TriangleSurface& half = *scene.problem.body.surface;
  ASSERT_EQ(half.triangles, metres.triangles);
  for (std::size_t v = 0; v < half.vertices.size(); ++v)
    EXPECT_EQ(half.vertices[v], metres.vertices[v] / 2);
}

TEST(SceneFiles, SurfacesSayWhatIsWrong) {
  const TemporaryFolder folder;
  std::ofstream(folder / "open.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 5 5\nf 1 2 3\n";
  const std::string mesh = sample("blocks_41.msh");
  const Scene scene = scene_of(of_files(mesh, folder / "open.obj"));
  EXPECT_TRUE(mentions(scene.warnings, "open.obj: 3 open edges")) << scene.warnings.size();
  EXPECT_TRUE(mentions(scene.warnings, "open.obj: 1 unused point dropped"));
  EXPECT_EQ(error_of(of_files(mesh, "none.obj")),
            "a.yaml:4: there is no surface file 'none.obj' (its name is relative to the scene)");
  EXPECT_NE(error_of(of_files(mesh, mesh + "2")).find("there is no surface file"),
            std::string::npos);
  EXPECT_NE(
      error_of(of_files(mesh, sample("README.md"))).find("unknown surface file extension 'md'"),
      std::string::npos);
  EXPECT_EQ(error_of(of_files(mesh, sample("blocks.obj") + ", sphere: {radius: 1}")).substr(0, 47),
            "a.yaml:4: body.surface: expected only one of sp");
}

// Two tetrahedra side by side that share no vertex, a millimetre apart, one inside out; a vertex
// too many
constexpr const char* torn = R"($MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
9
10 0 0 0
20 1 0 0
30 0 1 0
40 0 0 1
50 0 0 -0.001
60 1 0 -0.001
70 0 1 -0.001
80 0 0 -1
90 9 9 9
$EndNodes
$Elements
2
5 4 2 0 1 10 20 30 40
6 4 2 0 1 50 60 70 80
$EndElements
)";

TEST(SceneFiles, DuplicatesAreMergedOnRequest) {
  const TemporaryFolder folder;
  std::ofstream(folder / "torn.msh") << torn;
  const std::string file = folder / "torn.msh";
  const Scene apart = scene_of(of_files(file));
  EXPECT_EQ(apart.problem.body.levels[0].vertices.size(), 8);
  EXPECT_TRUE(mentions(apart.warnings, "1 element inside out in the file: turned"));
  EXPECT_TRUE(mentions(apart.warnings, "1 unused point dropped"));
  EXPECT_TRUE(mentions(apart.warnings, "has 2 parts"));
  const Scene glued = scene_of(of_files(file + ", merge_duplicates: 2 mm"));
  EXPECT_EQ(glued.problem.body.levels[0].vertices.size(), 5);
  EXPECT_TRUE(mentions(glued.warnings, "merged 3 duplicate vertices"));
  EXPECT_FALSE(mentions(glued.warnings, "parts"));
  EXPECT_EQ(in_input_order(glued.numbering[0].vertex_ids, glued.numbering[0].input.vertices),
            (std::vector<int>{10, 20, 30, 40, 80}));
  EXPECT_EQ(in_input_order(glued.numbering[0].tet_ids, glued.numbering[0].input.tets),
            (std::vector<int>{5, 6}));
  EXPECT_EQ(scene_of(of_files(file + ", scale: 10, merge_duplicates: 2 mm"))
                .problem.body.levels[0]
                .vertices.size(),
            8)
      << "the distance is one after scaling";
  EXPECT_EQ(error_of(of_files(file + ", merge_duplicates: -1")),
            "a.yaml:3: body.levels.0.merge_duplicates: expected a length (m) >= 0, got '-1'");
  EXPECT_NE(error_of(of_files(file + ", merge_duplicates: 2 m")).find("names a node twice"),
            std::string::npos);
}

TEST(SceneFiles, MeshesAreRepairedOnRequest) {
  const TemporaryFolder folder;
  std::string text = torn;  // the third element repeats the first, the fourth has no volume
  text.replace(text.find("\n2\n5 4"), 6, "\n4\n5 4")
      .insert(text.find("$EndElements"), "7 4 2 0 1 10 20 30 40\n8 4 2 0 1 10 20 30 10\n");
  std::ofstream(folder / "torn.msh") << text;
  const std::string file = folder / "torn.msh";
  EXPECT_EQ(error_of(of_files(file)).substr(0, 10 + file.size()), "a.yaml:3: " + file)
      << "the scene, then the file";
  const Scene scene = scene_of(of_files(file + ", repair: true"));
  EXPECT_TRUE(mentions(scene.warnings, "repaired: 1 tetrahedron that repeated another dropped"));
  EXPECT_TRUE(
      mentions(scene.warnings, "repaired: 1 tetrahedron that named a vertex twice dropped"));
  EXPECT_EQ(scene.problem.body.levels[0].tets.size(), 2);
  EXPECT_EQ(in_input_order(scene.numbering[0].tet_ids, scene.numbering[0].input.tets),
            (std::vector<int>{5, 6}));
  EXPECT_NE(error_of("duration: 1\nbody: {levels: [{ball: {radius: 1, cells: 2}, repair: true}]}\n")
                .find("repair"),
            std::string::npos);
}

TEST(SceneFiles, SizesNoBodyHasAreWarnedOf) {
  const Scene scene = scene_of(of_files(sample("blocks_41.msh") + ", scale: 1000"));
  EXPECT_TRUE(mentions(scene.warnings,
                       "the body is 40 m long; is the file in mm? Then its scale is 0.001"));
  EXPECT_FALSE(mentions(scene_of(of_files(sample("blocks_41.msh"))).warnings, "long"));
  const auto box = [](const std::string& size) {
    return scene_of("duration: 1\nbody: {levels: [{box: {size: [" + size +
                    ", 1 m, 1 m], cells: [2, 2, 2]}}]}\n")
        .warnings;
  };
  EXPECT_TRUE(mentions(box("100"), "the body is 100 m long; are its numbers in mm?"));
  EXPECT_FALSE(mentions(box("100 cm"), "long"));
}

TEST(SceneFiles, TheProgramSpeaksInTheirNumbers) {
  const TemporaryFolder folder;
  std::ofstream(folder / "torn.msh") << torn;
  std::ofstream(folder / "s.yaml")
      << of_files("torn.msh")
      << "integration: {macro_step: 1 s, allow_unstable: true, substeps: 1}\n";
  const Child run = run_child({PLICA_EXECUTABLE, "run", folder / "s.yaml", "-o", folder / "out",
                               "--duration", "20 s", "--set", "body.material.model=neo_hookean",
                               "--set", "body.initial={angular_velocity: [9, 0, 0]}"},
                              folder);
  ASSERT_EQ(run.status, 3) << run.errors;
  EXPECT_NE(run.errors.find("warning: " + (folder / "torn.msh").string() +
                            ": 1 element inside out in the file"),
            std::string::npos)
      << run.errors;
  const auto diagnosis =
      nlohmann::json::parse(content_of(folder / "out/summary.json"))["diagnosis"];
  const TetMesh volume = read_mesh(folder / "out/frames/volume_0000.vtu");
  EXPECT_EQ(volume.tets.size(), 2);
  EXPECT_TRUE(volume.region_names.empty()) << "the elements' numbers are no regions";
  const int element = diagnosis["element"];
  EXPECT_TRUE(element == 5 || element == 6) << diagnosis;
}

// Names and files that are not in UTF-8, as older programs write them: the program runs, and what
// it writes is UTF-8.

const std::string latin =
                      "L\xE9"
                      "ber",
                  valid =
                      "L\xEF\xBF\xBD"
                      "ber";  // é in Latin-1; U+FFFD for it

// Two tetrahedra in two regions, a name of which ends in this
std::string mesh_with(const std::string& one, const std::string& other) {
  return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n3 1 \"" + one + "\"\n3 2 \"" +
         other + "\"\n2 3 \"" + one +
         "\"\n$EndPhysicalNames\n$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 1 "
         "1\n$EndNodes\n"
         "$Elements\n3\n1 2 2 3 3 1 2 3\n2 4 2 1 1 1 2 3 4\n3 4 2 2 2 2 3 4 5\n$EndElements\n";
}

class ForeignText : public ProgramTest {
 protected:
  ForeignText() : ProgramTest("") {
    std::ofstream(folder / "a.msh", std::ios::binary) << mesh_with(latin,
                                                                   "L\xE8"
                                                                   "ber");
  }

  std::string scene_file(const std::string& file, const std::string& body,
                         const std::string& more = {}) const {
    std::ofstream(folder / file, std::ios::binary)
        << "duration: 2 ms\nbody: {levels: [{file: a.msh}]" << body
        << "}\nintegration: {macro_step: 1 ms}\n"
        << more;
    return folder / file;
  }
  Json summary(const std::string& of = "out") const {
    return Json::parse(content_of(folder / of / "summary.json"));
  }
};

TEST_F(ForeignText, RegionsOfAMeshFile) {
  const std::string file = scene_file(
      "a.yaml", ", regions: {" + valid + ": {density: 900}, " + valid + " (2): {density: 950}}",
      "output: {volume: all}\n");
  const Child run = plica({"run", file, "-o", folder / "out"});
  ASSERT_EQ(run.status, 0) << run.errors;
  EXPECT_EQ(summary()["status"], "completed");
  EXPECT_EQ(summary()["levels"][0]["stiffest"][0]["region"].get<std::string>().substr(0, 8),
            valid.substr(0, 8));
  const Child unknown =
      plica({"check", file, "--json", "--set", "body.regions={" + latin + "x: {density: 1}}"});
  EXPECT_EQ(unknown.status, 2);
  EXPECT_NE(Json::parse(unknown.output)["error"].get<std::string>().find(valid + "x"),
            std::string::npos);
}

TEST_F(ForeignText, NamesOfAMeshFileStayDistinct) {
  const TetMesh mesh = read_mesh(folder / "a.msh");
  EXPECT_EQ(mesh.region_names, (std::vector<std::string>{valid, valid + " (2)"}));
  ASSERT_EQ(mesh.vertex_sets.size(), 1);
  EXPECT_EQ(mesh.vertex_sets.begin()->first, valid) << "a name of two groups stays one";
  const Json info = Json::parse(plica({"mesh", "info", folder / "a.msh", "--json"}).output);
  EXPECT_EQ(info["regions"][0]["name"], valid);
  EXPECT_EQ(plica({"mesh", "convert", folder / "a.msh", folder / "b.msh"}).status, 0);
  EXPECT_EQ(read_mesh(folder / "b.msh").vertex_sets.count(valid), 1);
}

TEST_F(ForeignText, SceneInLatin1) {
  const std::string file = scene_file(
      "a.yaml", "",
      "name: " + latin + "\noutput: {probes: {" + latin + ": [0.1, 0.1, 0.1]}}  # " + latin + "\n");
  const Child run = plica({"run", file, "-o", folder / "out", "--checkpoint", "every=1"});
  ASSERT_EQ(run.status, 0) << run.errors;
  EXPECT_EQ(summary()["name"], valid);
  EXPECT_TRUE(content_of(folder / "out/probes.csv").starts_with("time," + valid + "_x,"));
  EXPECT_EQ(plica({"run", file, "--resume", folder / "out"}).status, 0);
  EXPECT_EQ(plica({"explain", file, "--json"}).status, 0);
  const Child twice = plica({"check", file, "--set",
                             "output.probes={" + latin +
                                 ": [0, 0, 0], L\xE8"
                                 "ber: [0, 0, 0]}"});
  EXPECT_EQ(twice.status, 2) << "two keys that read the same";
  EXPECT_NE(twice.errors.find("duplicate key"), std::string::npos) << twice.errors;
}

TEST_F(ForeignText, FilesWithLatin1Names) {
  const std::string inside = "d\xE9pot";
  std::filesystem::create_directory(folder / inside);
  std::filesystem::copy(folder / "a.msh", folder / inside / "a.msh");
  const std::string file = scene_file(inside + "/sc\xE8ne.yaml", ""),
                    result = inside + "/r\xE9sultat";
  const Child run = plica({"run", file, "-o", folder / result, "--checkpoint", "every=1"});
  ASSERT_EQ(run.status, 0) << run.errors;
  EXPECT_EQ(summary(result)["name"], "sc\xEF\xBF\xBDne");
  EXPECT_TRUE(summary(result)["scene"].get<std::string>().ends_with("/sc\xEF\xBF\xBDne.yaml"));
  EXPECT_TRUE(std::filesystem::exists(folder / result / "frames/surface_0001.vtu"));
  const Child resumed = plica({"run", "--resume", folder / result, "--duration", "4 ms"});
  EXPECT_EQ(resumed.status, 0) << "the mesh beside the scene is found again: " << resumed.errors;
  const Child check = plica({"check", file, "--json"});
  EXPECT_EQ(Json::parse(check.output)["sound"], true);
}

}  // namespace
TEST(SceneFiles, RegionsAreTakenAndLeftOut) {
  const std::string file = sample("blocks_42.vtk");
  const Scene whole = scene_of(of_files(file));
  EXPECT_EQ(whole.problem.body.levels[0].region_names,
            (std::vector<std::string>{"region_1", "region_2"}));
  EXPECT_TRUE(mentions(whole.warnings, "regions are the array 'region'; not used: 'quality'"));
  const Scene part = scene_of(of_files(file + ", leave_out: 2"));
  EXPECT_EQ(part.problem.body.levels[0].region_names, std::vector<std::string>{"region_1"});
  EXPECT_TRUE(mentions(part.warnings, "of the region region_2 left out"));
  EXPECT_TRUE(
      scene_of(of_files(file + ", regions: none")).problem.body.levels[0].region_names.empty());
  EXPECT_NE(error_of(of_files(file + ", regions: regio")).find("did you mean 'region'?"),
            std::string::npos);
  EXPECT_NE(error_of(of_files(file + ", leave_out: [region_3]")).find("unknown region 'region_3'"),
            std::string::npos);
}

TEST(SceneFiles, SecondOrderIsSplitUnlessAskedOtherwise) {
  const std::string file = sample("blocks_order2.msh");
  const Scene split = scene_of(of_files(file));
  EXPECT_EQ(split.problem.body.levels[0].tets.size(), 384u);
  EXPECT_EQ(split.numbering[0].vertex_ids.size(), 113u);
  EXPECT_TRUE(mentions(split.warnings, "48 second-order tetrahedra split in eight"));
  EXPECT_EQ(scene_of(of_files(file + ", order: linear")).problem.body.levels[0].tets.size(), 48u);
}

TEST(SceneFiles, SurfacesAreWelded) {
  const TemporaryFolder folder;
  // A tetrahedron, each face with corners of its own
  std::ofstream(folder / "soup.obj")
      << "v 0 0 0\nv 0 1 0\nv 1 0 0\nv 0 0 0\nv 1 0 0\nv 0 0 1\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
         "v 0 0 0\nv 0 0 1\nv 0 1 0\nf 1 2 3\nf 4 5 6\nf 7 8 9\nf 10 11 12\n";
  const std::string soup = (folder / "soup.obj").string(),
                    lattice = "duration: 1\nbody:\n  levels: {surface: " + soup + ", sizes: [0.25]";
  EXPECT_TRUE(
      mentions(scene_of(lattice + "}\n").warnings, "8 points on open edges welded to another one"));
  EXPECT_NE(error_of(lattice + ", weld: 0}\n").find("has no inside: 12 open edges"),
            std::string::npos);
}

}  // namespace plica::app::test
