// SPDX-License-Identifier: BSD-3-Clause
#include <fstream>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/files/mesh_files.hpp>

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

// Onto the disk; what was left out
std::vector<std::string> store(const WrittenMesh& written) {
  for (const MemoryFile& file : written.files) std::ofstream(file.name, std::ios::binary) << file.bytes;
  return written.left_out;
}

TEST(WriteMesh, MshKeepsEverything) {
  const Folder folder;
  for (const std::string format : {"", "msh22", "msh41"})
    for (const auto& [named, binary] : {std::pair{true, false}, {false, false}, {true, true}, {false, true}}) {
      SCOPED_TRACE(format + (binary ? " binary" : " text"));
      TetMesh mesh = awkward();
      if (!named) mesh.region.clear(), mesh.region_names.clear(), mesh.vertex_sets.clear();
      EXPECT_TRUE(store(write_mesh(folder / "m.msh", mesh, format, binary)).empty());
      MeshReport report;
      expect_same(read_mesh(folder / "m.msh", &report), mesh);
      EXPECT_EQ(report.format,
                std::string(format == "msh22" ? "Gmsh MSH 2.2 " : "Gmsh MSH 4.1 ") + (binary ? "binary" : "ASCII"));
    }
}

TEST(WriteMesh, OtherFormatsTellWhatTheyLeaveOut) {
  const Folder folder;
  struct Form {
    std::string name, prefix;
    bool binary;
  };
  const std::vector<Form> forms = {{"m.vtk", "region_", false},
                                   {"m.vtk", "region_", true},
                                   {"m.vtu", "region_", true},
                                   {"m.ele", "attribute_", false},
                                   {"m.node", "attribute_", false}};
  for (const auto& [name, prefix, binary] : forms) {
    SCOPED_TRACE(name);
    TetMesh mesh = awkward();
    EXPECT_GE(store(write_mesh(folder / name, mesh, "", binary)).size(), 2u + mesh.vertex_sets.size());
    const TetMesh read = read_mesh(folder / name);
    EXPECT_EQ(read.vertices, mesh.vertices);
    EXPECT_EQ(read.tets, mesh.tets);
    EXPECT_EQ(read.region, mesh.region);
    EXPECT_EQ(read.region_names, (std::vector<std::string>{prefix + "1", prefix + "2"}));
    EXPECT_TRUE(store(write_mesh(folder / name, read, "", binary)).empty());  // nothing more is lost
    expect_same(read_mesh(folder / name), read);
    mesh.region.clear(), mesh.region_names.clear(), mesh.vertex_sets.clear();
    EXPECT_TRUE(store(write_mesh(folder / name, mesh, "", binary)).empty());
    expect_same(read_mesh(folder / name), mesh);
  }
}

TEST(WriteMesh, TetGenHasOneMarkerPerVertex) {
  const Folder folder;
  TetMesh mesh = read_mesh(sample("blocks_22.msh"));
  mesh.vertex_sets = {{"marker_3", {0, 1}}, {"marker_7", {1, 2}}};
  mesh.region_names = {"attribute_4", "attribute_9"};
  EXPECT_EQ(store(write_mesh(folder / "m.ele", mesh)),
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
  expect_refused([&] { write_mesh("m.ele", mesh, "", true); }, "m.ele", {"no binary form"});
  expect_refused([&] { write_surface("m.vtk", {}); }, "m.vtk", {"unknown surface file extension 'vtk'", "obj, stl"});
  TetMesh lines = mesh;
  lines.region_names[0] = "two\nlines";
  expect_refused([&] { write_mesh("m.msh", lines); }, "m.msh", {"'two?lines'", "cannot be written"});
}

TEST(WriteSurface, IsReadAgain) {
  const TriangleSurface surface = read_surface(sample("blocks.obj"));
  for (const char* name : {"s.obj", "s.stl"}) {
    const WrittenMesh written = write_surface(name, surface);
    const TriangleSurface again = read_surface(written.files.at(0));
    EXPECT_EQ(again.triangles.size(), surface.triangles.size()) << name;
    EXPECT_NEAR(enclosed_volume(again), enclosed_volume(surface), 1e-15) << name;
    EXPECT_TRUE(written.left_out.empty());
  }
  EXPECT_EQ(read_surface(write_surface("s.obj", surface).files.at(0)).vertices, surface.vertices);
  const WrittenMesh binary = write_surface("s.stl", surface, "stl", true);
  SurfaceReport report;
  const TriangleSurface again = read_surface(binary.files.at(0), &report);
  EXPECT_EQ(report.format, "STL binary");
  EXPECT_TRUE(report.closed());
  EXPECT_EQ(again.triangles.size(), surface.triangles.size());
  EXPECT_NEAR(enclosed_volume(again), enclosed_volume(surface), 1e-6 * enclosed_volume(surface));
  EXPECT_EQ(binary.left_out.size(), 1);
  TriangleSurface far = surface;
  far.vertices[0].x() = 1e39;
  expect_refused([&] { write_surface("s.stl", far, "", true); }, "s.stl", {"too large"});
}

TEST(ReadAny, TellsMeshesFromSurfaces) {
  const auto holds_surface = [](const char* name) {
    return std::holds_alternative<ReadSurface>(
        read_any(std::filesystem::path(PLICA_SOURCE_DIR) / "meshes/data/formats" / name));
  };
  for (const char* name : {"blocks.obj", "blocks.stl", "blocks_binary.stl"}) EXPECT_TRUE(holds_surface(name)) << name;
  for (const char* name : {"blocks_22.msh", "blocks_51.vtk", "blocks.ele"}) EXPECT_FALSE(holds_surface(name)) << name;
  const Folder folder;
  std::ofstream(folder / "s.msh") << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n"
                                     "$EndNodes\n$Elements\n1\n1 2 2 0 1 1 2 3\n$EndElements\n";
  EXPECT_TRUE(std::holds_alternative<ReadSurface>(read_any(folder / "s.msh")));
  expect_refused([&] { read_any("m.mesh"); }, "m.mesh", {"unknown mesh or surface file extension 'mesh'", "obj, stl"});
}

}  // namespace
