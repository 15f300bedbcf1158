// SPDX-License-Identifier: BSD-3-Clause
#include <plica/meshes/write_mesh.hpp>

#include "mesh_input.hpp"

namespace {

using namespace plica;
using namespace plica::test;

// Coordinates that need all their digits, regions in turn, sets that overlap
TetMesh awkward() {
  TetMesh mesh = read_mesh(sample("blocks_41_binary.msh"));
  for (Point& p : mesh.vertices) p = p / 3.0 + Point(1e-300, 4.9e-324, 0.1);
  mesh.vertices[0].x() = -0.1 / 3.0;
  for (std::size_t t = 0; t < mesh.tets.size(); t += 2) mesh.region[t] = 1 - mesh.region[t];
  return mesh;
}

// A folder that lasts as long as this, one per test
class Folder {
 public:
  Folder() : path_(std::filesystem::path(testing::TempDir()) / unique()) { std::filesystem::create_directories(path_); }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  static std::string unique() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    return std::string("plica_") + test->test_suite_name() + "_" + test->name();
  }
  std::filesystem::path path_;
};

TEST(WriteMesh, MshKeepsEverything) {
  const Folder folder;
  for (const std::string format : {"", "msh22", "msh41"})
    for (const bool named : {true, false}) {
      SCOPED_TRACE(format);
      TetMesh mesh = awkward();
      if (!named) mesh.region.clear(), mesh.region_names.clear(), mesh.vertex_sets.clear();
      EXPECT_TRUE(write_mesh(folder / "m.msh", mesh, format).empty());
      MeshReport report;
      expect_same(read_mesh(folder / "m.msh", &report), mesh);
      EXPECT_EQ(report.format, format == "msh22" ? "Gmsh MSH 2.2 ASCII" : "Gmsh MSH 4.1 ASCII");
    }
}

TEST(WriteMesh, OtherFormatsTellWhatTheyLeaveOut) {
  const Folder folder;
  const std::map<std::string, std::string> prefixes = {
      {"m.vtk", "region_"}, {"m.vtu", "region_"}, {"m.ele", "attribute_"}, {"m.node", "attribute_"}};
  for (const auto& [name, prefix] : prefixes) {
    SCOPED_TRACE(name);
    TetMesh mesh = awkward();
    EXPECT_GE(write_mesh(folder / name, mesh).size(), 2u + mesh.vertex_sets.size());
    const TetMesh read = read_mesh(folder / name);
    EXPECT_EQ(read.vertices, mesh.vertices);
    EXPECT_EQ(read.tets, mesh.tets);
    EXPECT_EQ(read.region, mesh.region);
    EXPECT_EQ(read.region_names, (std::vector<std::string>{prefix + "1", prefix + "2"}));
    EXPECT_TRUE(write_mesh(folder / name, read).empty());  // nothing more is lost
    expect_same(read_mesh(folder / name), read);
    mesh.region.clear(), mesh.region_names.clear(), mesh.vertex_sets.clear();
    EXPECT_TRUE(write_mesh(folder / name, mesh).empty());
    expect_same(read_mesh(folder / name), mesh);
  }
}

TEST(WriteMesh, TetGenHasOneMarkerPerVertex) {
  const Folder folder;
  TetMesh mesh = read_mesh(sample("blocks_22.msh"));
  mesh.vertex_sets = {{"marker_3", {0, 1}}, {"marker_7", {1, 2}}};
  mesh.region_names = {"attribute_4", "attribute_9"};
  EXPECT_EQ(write_mesh(folder / "m.ele", mesh),
            (std::vector<std::string>{
                "the vertex set 'marker_7' loses 1 vertices to others: this format has one per vertex"}));
  mesh.vertex_sets.at("marker_7") = {2};
  expect_same(read_mesh(folder / "m.ele"), mesh);
}

TEST(WriteMesh, WrongNamesAreRefused) {
  const TetMesh mesh = awkward();
  expect_refused([&] { write_mesh("m.mesh", mesh); }, "m.mesh", {"'mesh'", "did you mean 'msh'"});
  expect_refused([&] { write_mesh("m.msh", mesh, "msh40"); }, "m.msh", {"'msh40'", "msh41, msh22"});
  expect_refused([&] { write_mesh("m.msh", mesh, "vtk"); }, "m.msh", {"'vtk'", "msh41, msh22"});
  expect_refused([&] { write_mesh("no/such/folder/m.msh", mesh); }, "no/such/folder/m.msh", {"cannot be written"});
  TetMesh lines = mesh;
  lines.region_names[0] = "two\nlines";
  expect_refused([&] { write_mesh("m.msh", lines); }, "m.msh", {"'two?lines'", "cannot be written"});
}

}  // namespace
