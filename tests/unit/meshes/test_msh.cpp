// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <fstream>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/files/mesh_files.hpp>
#include <plica/meshes/mesh_quality.hpp>

#include "mesh_input.hpp"
#include "support/refusal.hpp"
#include "support/tolerance.hpp"

namespace {

using namespace plica;
using namespace plica::test;

TEST(ReadMsh, TakesVerticesTetrahedraRegionsAndSets) {
  MeshReport report;
  const TetMesh mesh = read_text(two_tets, &report);
  ASSERT_EQ(mesh.vertices.size(), 5u);
  EXPECT_EQ(mesh.vertices[4], Point(1, 1, 1));
  EXPECT_EQ(mesh.tets, (std::vector<std::array<int, 4>>{{0, 1, 2, 3}, {1, 2, 3, 4}}));
  EXPECT_EQ(mesh.region, (std::vector<int>{0, 1}));
  EXPECT_EQ(mesh.region_names, (std::vector<std::string>{"tissue", "large tumour"}));
  EXPECT_EQ(mesh.vertex_sets, (std::map<std::string, std::vector<int>>{{"base", {0, 1, 2}}}));
  EXPECT_EQ(report.format, "Gmsh MSH 2.2 ASCII");
  EXPECT_EQ(report.flipped, 0);
  EXPECT_EQ(report.unreferenced, 0);
  EXPECT_EQ(report.vertex_tags, (std::vector<std::int64_t>{1, 2, 3, 10, 11}));
  EXPECT_EQ(report.tet_tags, (std::vector<std::int64_t>{7, 8}));
  EXPECT_EQ(report.other_elements, (std::map<std::string, int>{{"triangle", 1}}));
}

TEST(ReadMsh, CarriageReturnsTabsAndPlusSignsMakeNoDifference) {
  std::string windows;
  for (const char c : two_tets) windows += c == '\n' ? "\r\n" : std::string(1, c);
  expect_same(read_text(windows), read_text(two_tets));
  expect_same(read_text(with(two_tets, "2 1 0 0", "\t2  +1.0e0\t0 0 ")), read_text(two_tets));
}

TEST(ReadMsh, SectionsMayComeInAnotherOrder) {
  const std::size_t names = two_tets.find("$PhysicalNames"), nodes = two_tets.find("$Nodes");
  expect_same(read_text(two_tets.substr(0, names) + two_tets.substr(nodes) +
                        two_tets.substr(names, nodes - names)),
              read_text(two_tets));
}

TEST(ReadMsh, TurnsInsideOutTetrahedra) {
  MeshReport report;
  const TetMesh mesh = read_text(with(two_tets, "1 1 1 2 3 10", "1 1 2 1 3 10"), &report);
  EXPECT_EQ(report.flipped, 1);
  const auto& [a, b, c, d] = mesh.tets[0];
  const auto at = [&](int v) { return mesh.vertices[static_cast<std::size_t>(v)]; };
  EXPECT_DOUBLE_EQ(tet_volume(at(a), at(b), at(c), at(d)), 1.0 / 6.0);
}

TEST(ReadMsh, DropsUnreferencedVerticesAlsoFromSets) {
  MeshReport report;
  std::string text = with(two_tets, "$Nodes\n5\n1 0 0 0", "$Nodes\n7\n40 5 5 5\n1 0 0 0\n41 6 6 6");
  text = with(text, "$Elements\n3", "$Elements\n4\n5 2 2 4 1 1 40 41");
  const TetMesh mesh = read_text(text, &report);
  EXPECT_EQ(report.unreferenced, 2);
  EXPECT_EQ(report.vertex_tags, (std::vector<std::int64_t>{1, 2, 3, 10, 11}));
  expect_same(mesh, read_text(two_tets));
}

TEST(ReadMsh, NamelessGroupsAreNamedAfterTheirTag) {
  std::string text = with(two_tets, "3\n2 4 \"base\"\n3 1 \"tissue\"\n", "1\n");
  TetMesh mesh = read_text(text);
  EXPECT_EQ(mesh.region_names, (std::vector<std::string>{"physical_1", "large tumour"}));
  EXPECT_TRUE(mesh.vertex_sets.contains("physical_4"));
  mesh = read_text(with(text, "large tumour", "physical_1"));
  EXPECT_EQ(mesh.region_names, (std::vector<std::string>{"physical_1"}));
  EXPECT_EQ(mesh.region, (std::vector<int>{0, 0}));
}

TEST(ReadMsh, WithoutGroupsThereIsOneNamelessRegion) {
  std::string text = with(with(two_tets, "7 4 2 1 1", "7 4 2 0 1"), "6 2 2 4 1", "6 2 0");
  EXPECT_EQ(read_text(text).region_names, (std::vector<std::string>{"physical_0", "large tumour"}));
  text = with(text, "8 4 2 2 2", "8 4 0");
  const TetMesh mesh = read_text(text);
  EXPECT_TRUE(mesh.region.empty());
  EXPECT_TRUE(mesh.region_names.empty());
  EXPECT_TRUE(mesh.vertex_sets.empty());
}

TEST(ReadMsh, SetsOfOneNameAreOneSetAndMinusSignsAreOrientations) {
  const std::string text =
      with(with(two_tets, "$PhysicalNames\n3", "$PhysicalNames\n4\n0 9 \"base\""), "$Elements\n3",
           "$Elements\n5\n1 15 2 9 1 11\n2 1 2 -9 1 10 11");
  const TetMesh mesh = read_text(text);
  EXPECT_EQ(mesh.vertex_sets.at("base"), (std::vector<int>{0, 1, 2, 4}));
  EXPECT_EQ(mesh.vertex_sets.at("physical_9"), (std::vector<int>{3, 4}));
}

TEST(ReadMsh, SkipsSectionsForOtherUses) {
  MeshReport report;
  const std::string comment = "$Comments\nfree text 1 2 nan\n$Nodes\n$EndComments\n";
  const TetMesh mesh = read_text(
      with(two_tets, "$Nodes", comment + "$Nodes") + "$ElementNodeData\n1\n$EndElementNodeData\n",
      &report);
  expect_same(mesh, read_text(two_tets));
  EXPECT_EQ(report.skipped_sections, (std::vector<std::string>{"$Comments", "$ElementNodeData"}));
}

TEST(ReadMsh, CutAtAnyByteIsRefused) {
  for (const std::string& text : {two_tets, two_tets_4})
    expect_whole({"m.msh", text}, 1,
                 [](const FileBytes& file) { expect_same(read_mesh(file), read_text(two_tets)); });
}

TEST(ReadMsh, AnyByteChangedIsRefusedOrSound) {
  for (const std::string& text : {two_tets, two_tets_4})
    change_every_byte(
        {"m.msh", text}, [](const FileBytes& file) { return read_mesh(file); },
        [](const TetMesh& mesh) { EXPECT_GT(mesh_quality(mesh).volume, 0.0); });
}

TEST(ReadMesh, ChoosesTheFormatByExtension) {
  expect_same(read_mesh(FileBytes{"liver.MSH", two_tets}), read_text(two_tets));
  expect_refused([] { read_mesh("liver.mshh"); }, "liver.mshh",
                 {"unknown mesh file extension 'mshh'; did you mean 'msh'? (choices: msh, "});
  EXPECT_THROW(read_mesh("no_extension"), InputError);
}

TEST(ReadMesh, MissingFilesAndFoldersAreNamed) {
  EXPECT_EQ(refusal([] { read_mesh("no/such/file.msh"); }),
            "no/such/file.msh: cannot be opened: No such file or directory");
  EXPECT_THROW(load_file(testing::TempDir()), InputError);
}

// What Gmsh wrote, in every variant of its format
TetMesh read(const FileBytes& file) { return read_mesh(file); }

struct Variant {
  const char* file;
  const char* format;
  bool partitioned;  // has another order of nodes, and groups for the partitions
};
const Variant variants[] = {{"blocks_22.msh", "Gmsh MSH 2.2 ASCII", false},
                            {"blocks_22_binary.msh", "Gmsh MSH 2.2 binary", false},
                            {"blocks_41.msh", "Gmsh MSH 4.1 ASCII", false},
                            {"blocks_41_binary.msh", "Gmsh MSH 4.1 binary", false},
                            {"blocks_41_parametric.msh", "Gmsh MSH 4.1 ASCII", false},
                            {"blocks_41_parametric_binary.msh", "Gmsh MSH 4.1 binary", false},
                            {"blocks_41_partitioned.msh", "Gmsh MSH 4.1 ASCII", true},
                            {"blocks_41_partitioned_binary.msh", "Gmsh MSH 4.1 binary", true}};

TEST(SampleMsh, EveryVariantHoldsTheSameBlocks) {
  const TetMesh first = read(sample("blocks_22.msh"));
  for (const Variant& variant : variants) {
    SCOPED_TRACE(variant.file);
    MeshReport report;
    const TetMesh mesh = read_mesh(sample(variant.file), &report);
    EXPECT_EQ(report.format, variant.format);
    EXPECT_EQ(mesh.vertices.size(), first.vertices.size());
    EXPECT_EQ(mesh.tets.size(), first.tets.size());
    EXPECT_EQ(mesh.region_names, (std::vector<std::string>{"tissue", "large tumour"}));
    if (!variant.partitioned) {
      EXPECT_LE(largest_difference(mesh.vertices, first.vertices), 1e-17);  // Gmsh writes 16 digits
      EXPECT_EQ(mesh.vertex_sets, first.vertex_sets);
    }
    for (const auto& [name, set] : first.vertex_sets)
      EXPECT_EQ(mesh.vertex_sets.at(name).size(), set.size()) << name;
    const MeshQuality quality = mesh_quality(mesh);
    EXPECT_NEAR(quality.volume, 2 * 8e-6, 1e-15);
    EXPECT_NEAR(quality.regions[1].volume, 8e-6, 1e-15);
    EXPECT_EQ(report.flipped, 0);
  }
}

TEST(SampleMsh, GroupsOfEveryDimensionAreSets) {
  const TetMesh mesh = read(sample("blocks_41_binary.msh"));
  std::map<std::string, std::size_t> sizes;
  for (const auto& [name, set] : mesh.vertex_sets) sizes[name] = set.size();
  EXPECT_EQ(sizes, (std::map<std::string, std::size_t>{
                       {"base", 5}, {"lower half of the side", 12}, {"edge", 3}, {"corner", 1}}));
  for (const int v : mesh.vertex_sets.at("base"))
    EXPECT_EQ(mesh.vertices[static_cast<std::size_t>(v)].z(), 0.0);
}

// The last line feed may be missing; where a section follows that is skipped, a cut there is still
// a whole mesh
TEST(SampleMsh, CutAtAnyByteIsRefused) {
  for (const Variant& variant : variants) {
    SCOPED_TRACE(variant.file);
    if (!variant.partitioned) expect_whole(sample(variant.file), 1, read);
  }
}

TEST(SampleMsh, AnyByteChangedIsRefusedOrSound) {
  for (const char* name : {"blocks_22_binary.msh", "blocks_41.msh", "blocks_41_binary.msh"}) {
    SCOPED_TRACE(name);
    change_every_byte(sample(name), read,
                      [](const TetMesh& mesh) { EXPECT_GT(mesh_quality(mesh).volume, 0.0); },
                      {'\0', '\x01', '9', '\xff'});
  }
}

std::string swapped(std::string bytes, std::size_t at, std::size_t size) {
  std::reverse(bytes.begin() + static_cast<long>(at), bytes.begin() + static_cast<long>(at + size));
  return bytes;
}

// Two tetrahedra of two_tets as a machine of the other order of bytes writes them
std::string other_order() {
  std::string text = "$MeshFormat\n2.2 1 8\n";
  const auto put = [&text](auto value) {
    text.append(reinterpret_cast<const char*>(&value), sizeof(value));
    text = swapped(text, text.size() - sizeof(value), sizeof(value));
  };
  put(1);
  text += "\n$EndMeshFormat\n$Nodes\n5\n";
  const double points[5][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  const int tags[5] = {1, 2, 3, 10, 11};
  for (int i = 0; i < 5; ++i) {
    put(tags[i]);
    for (const double x : points[i]) put(x);
  }
  text += "\n$EndNodes\n$Elements\n3\n";
  for (const int x :
       {2, 1, 2, 6, 4, 1, 1, 2, 3, 4, 2, 2, 7, 1, 1, 1, 2, 3, 10, 8, 2, 2, 2, 3, 10, 11})
    put(x);
  return text + "\n$EndElements\n";
}

TEST(SampleMsh, EitherOrderOfBytes) {
  TetMesh mesh = read_text(other_order());
  TetMesh same = read_text(two_tets);
  EXPECT_EQ(mesh.region_names, (std::vector<std::string>{"physical_1", "physical_2"}));
  mesh.region_names = same.region_names;
  mesh.vertex_sets = {{"base", mesh.vertex_sets.at("physical_4")}};
  expect_same(mesh, same);
}

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
  Folder() : path_(std::filesystem::path(testing::TempDir()) / unique()) {
    std::filesystem::create_directories(path_);
  }
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
  for (const FileBytes& file : written.files)
    std::ofstream(file.name, std::ios::binary) << file.bytes;
  return written.left_out;
}

TEST(WriteMesh, MshKeepsEverything) {
  const Folder folder;
  for (const std::string format : {"", "msh22", "msh41"})
    for (const auto& [named, binary] :
         {std::pair{true, false}, {false, false}, {true, true}, {false, true}}) {
      SCOPED_TRACE(format + (binary ? " binary" : " text"));
      TetMesh mesh = awkward();
      if (!named) mesh.region.clear(), mesh.region_names.clear(), mesh.vertex_sets.clear();
      EXPECT_TRUE(store(write_mesh(folder / "m.msh", mesh, format, binary)).empty());
      MeshReport report;
      expect_same(read_mesh(folder / "m.msh", &report), mesh);
      EXPECT_EQ(report.format, std::string(format == "msh22" ? "Gmsh MSH 2.2 " : "Gmsh MSH 4.1 ") +
                                   (binary ? "binary" : "ASCII"));
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
    EXPECT_GE(store(write_mesh(folder / name, mesh, "", binary)).size(),
              2u + mesh.vertex_sets.size());
    const TetMesh read = read_mesh(folder / name);
    EXPECT_EQ(read.vertices, mesh.vertices);
    EXPECT_EQ(read.tets, mesh.tets);
    EXPECT_EQ(read.region, mesh.region);
    EXPECT_EQ(read.region_names, (std::vector<std::string>{prefix + "1", prefix + "2"}));
    // nothing more is lost
    EXPECT_TRUE(store(write_mesh(folder / name, read, "", binary)).empty());
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
  EXPECT_EQ(
      store(write_mesh(folder / "m.ele", mesh)),
      (std::vector<std::string>{
          "the vertex set 'marker_7' loses 1 vertices to others: this format has one per vertex"}));
  mesh.vertex_sets.at("marker_7") = {2};
  expect_same(read_mesh(folder / "m.ele"), mesh);
}

TEST(WriteMesh, WrongNamesAreRefused) {
  const TetMesh mesh = awkward();
  expect_refused([&] { write_mesh("m.mssh", mesh); }, "m.mssh", {"'mssh'", "did you mean 'mesh'"});
  expect_refused([&] { write_mesh("m.msh", mesh, "msh40"); }, "m.msh", {"'msh40'", "msh41, msh22"});
  expect_refused([&] { write_mesh("m.msh", mesh, "vtk"); }, "m.msh", {"'vtk'", "msh41, msh22"});
  expect_refused([&] { write_mesh("m.ele", mesh, "", true); }, "m.ele", {"no binary form"});
  expect_refused([&] { write_surface("m.vtk", {}); }, "m.vtk",
                 {"unknown surface file extension 'vtk'", "obj, ply, off, stl"});
  TetMesh lines = mesh;
  lines.region_names[0] = "two\nlines";
  expect_refused([&] { write_mesh("m.msh", lines); }, "m.msh",
                 {"'two?lines'", "cannot be written"});
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
  for (const char* name : {"blocks.obj", "blocks.stl", "blocks_binary.stl"})
    EXPECT_TRUE(holds_surface(name)) << name;
  for (const char* name : {"blocks_22.msh", "blocks_51.vtk", "blocks.ele"})
    EXPECT_FALSE(holds_surface(name)) << name;
  const Folder folder;
  std::ofstream(folder / "s.msh")
      << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n"
         "$EndNodes\n$Elements\n1\n1 2 2 0 1 1 2 3\n$EndElements\n";
  EXPECT_TRUE(std::holds_alternative<ReadSurface>(read_any(folder / "s.msh")));
  expect_refused([&] { read_any("m.mssh"); }, "m.mssh",
                 {"unknown mesh or surface file extension 'mssh'", "obj, stl, ply, off, vtp"});
}

}  // namespace
