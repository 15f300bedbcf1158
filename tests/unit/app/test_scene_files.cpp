// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <plica/drivers/app/output/run_files.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/files/mesh_files.hpp>

#include "unit/app/child.hpp"
#include "unit/app/scene_text.hpp"

// Scenes whose meshes and surfaces come from files
namespace plica::app::test {
namespace {

const std::filesystem::path samples = std::filesystem::path(PLICA_SOURCE_DIR) / "meshes" / "data" / "formats";

std::string of_files(const std::string& level, const std::string& surface = "") {
  return "duration: 1\nbody:\n  levels: [{file: " + level + "}]\n" +
         (surface.empty() ? "" : "  surface: {file: " + surface + "}\n") + "output: {volume: true}\n";
}

std::string sample(const char* name) { return (samples / name).string(); }

bool mentions(const std::vector<std::string>& sentences, const std::string& piece) {
  return std::ranges::any_of(sentences, [&](const std::string& s) { return s.find(piece) != std::string::npos; });
}

TEST(SceneFiles, KeepTheNumbersOfTheFile) {
  for (const char* name : {"blocks_41.msh", "blocks.ele", "blocks_51_binary.vtk", "../liver_coarse.msh"}) {
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
      const auto at = std::ranges::find(report.vertex_tags, input_number(numbering.vertex_ids, static_cast<int>(v)));
      EXPECT_EQ(mesh.vertices[v], input.vertices[static_cast<std::size_t>(at - report.vertex_tags.begin())]);
    }
    const TetMesh back = in_input_order(mesh, numbering);
    EXPECT_EQ(back.vertices, input.vertices);
    EXPECT_EQ(back.tets, input.tets);
    EXPECT_EQ(back.region, input.region);
    EXPECT_EQ(back.vertex_sets, input.vertex_sets);
    EXPECT_EQ(input_number(numbering.tet_ids, -1), -1);
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
  snapshot.volumes = {{0, snapshot.positions, snapshot.velocities, {ones, ones}}};
  files.write(snapshot);
  const TetMesh volume = read_mesh(folder / "frames/volume_0000.vtu");
  EXPECT_EQ(volume.vertices, input.vertices);
  EXPECT_EQ(volume.tets, input.tets);
  const std::string skin = content_of(folder / "frames/surface_0000.vtu");
  std::string expected;
  for (const Point& p : boundary_surface(input).surface.vertices)
    expected.append(reinterpret_cast<const char*>(p.data()), sizeof(Point));
  EXPECT_NE(skin.find(expected), std::string::npos);
}

TEST(SceneFiles, TheBoundaryIsInTheOrderOfTheFile) {
  const Scene scene = scene_of("duration: 1\nbody: {levels: [{file: " + sample("../liver_coarse.msh") +
                               "}], surface: {boundary: true}}\n");
  const TriangleSurface expected = boundary_surface(read_mesh(samples / "../liver_coarse.msh")).surface;
  EXPECT_EQ(scene.problem.body.surface->vertices, expected.vertices);
  EXPECT_EQ(scene.problem.body.surface->triangles, expected.triangles);
}

TEST(SceneFiles, SurfaceIsScaled) {
  const TriangleSurface metres =
      *scene_of(of_files(sample("blocks_41.msh"), sample("blocks.obj"))).problem.body.surface;
  const Scene scene = scene_of(of_files(sample("blocks_41.msh"), sample("blocks.obj") + ", scale: 0.5"));
  const TriangleSurface& half = *scene.problem.body.surface;
  ASSERT_EQ(half.triangles, metres.triangles);
  for (std::size_t v = 0; v < half.vertices.size(); ++v) EXPECT_EQ(half.vertices[v], metres.vertices[v] / 2);
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
  EXPECT_NE(error_of(of_files(mesh, mesh + "2")).find("there is no surface file"), std::string::npos);
  EXPECT_NE(error_of(of_files(mesh, sample("README.md"))).find("unknown surface file extension 'md'"),
            std::string::npos);
  EXPECT_EQ(error_of(of_files(mesh, sample("blocks.obj") + ", sphere: {radius: 1}")).substr(0, 47),
            "a.yaml:4: body.surface: expected only one of sp");
}

// Two tetrahedra side by side that share no vertex, a millimetre apart, one inside out; a vertex too many
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
  EXPECT_TRUE(mentions(apart.warnings, "1 inverted element turned"));
  EXPECT_TRUE(mentions(apart.warnings, "1 unused point dropped"));
  EXPECT_TRUE(mentions(apart.warnings, "in 2 parts"));
  const Scene glued = scene_of(of_files(file + ", merge_duplicates: 2 mm"));
  EXPECT_EQ(glued.problem.body.levels[0].vertices.size(), 5);
  EXPECT_TRUE(mentions(glued.warnings, "merged 3 duplicate vertices"));
  EXPECT_FALSE(mentions(glued.warnings, "parts"));
  EXPECT_EQ(in_input_order(glued.numbering[0].vertex_ids, glued.numbering[0].input.vertices),
            (std::vector<int>{10, 20, 30, 40, 80}));
  EXPECT_EQ(in_input_order(glued.numbering[0].tet_ids, glued.numbering[0].input.tets), (std::vector<int>{5, 6}));
  EXPECT_EQ(scene_of(of_files(file + ", scale: 10, merge_duplicates: 2 mm")).problem.body.levels[0].vertices.size(), 8)
      << "the distance is one after scaling";
  EXPECT_EQ(error_of(of_files(file + ", merge_duplicates: -1")),
            "a.yaml:3: body.levels.0.merge_duplicates: expected a length (m) >= 0, got '-1'");
  EXPECT_NE(error_of(of_files(file + ", merge_duplicates: 2 m")).find("names a node twice"), std::string::npos);
}

TEST(SceneFiles, TheProgramSpeaksInTheirNumbers) {
  const TemporaryFolder folder;
  std::ofstream(folder / "torn.msh") << torn;
  std::ofstream(folder / "s.yaml") << of_files("torn.msh")
                                   << "integration: {macro_step: 1 s, allow_unstable: true, substeps: 1}\n";
  const Child run =
      run_child({PLICA_EXECUTABLE, "run", folder / "s.yaml", "-o", folder / "out", "--duration", "20 s", "--set",
                 "body.material.model=neo_hookean", "--set", "body.initial={angular_velocity: [9, 0, 0]}"},
                folder);
  ASSERT_EQ(run.status, 3) << run.errors;
  EXPECT_NE(run.errors.find("warning: " + (folder / "torn.msh").string() + ": 1 inverted element"), std::string::npos)
      << run.errors;
  const auto diagnosis = nlohmann::json::parse(content_of(folder / "out/summary.json"))["diagnosis"];
  const TetMesh volume = read_mesh(folder / "out/frames/volume_0000.vtu");
  EXPECT_EQ(volume.tets.size(), 2);
  EXPECT_TRUE(volume.region_names.empty()) << "the elements' numbers are no regions";
  const int element = diagnosis["element"];
  EXPECT_TRUE(element == 5 || element == 6) << diagnosis;
}

}  // namespace
}  // namespace plica::app::test
