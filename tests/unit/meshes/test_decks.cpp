// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/meshes/mesh_quality.hpp>

#include "mesh_input.hpp"

// Meshes in input decks of finite-element programs: Abaqus, CalculiX and FEBio.
namespace {

using namespace plica;
using namespace plica::test;
using Names = std::vector<std::string>;
using Set = std::vector<int>;

FileBytes deck(const std::string& format, const std::string& name) {
  return {"m." + format,
          load_file(std::filesystem::path(PLICA_SOURCE_DIR) / "tests/fuzz/corpus" / format / name)
              .bytes};
}

bool has_note(const MeshReport& report, const std::string& part) {
  return std::ranges::any_of(
      report.notes, [&](const std::string& note) { return note.find(part) != std::string::npos; });
}

void expect_two_tets(const TetMesh& mesh, const MeshReport& report) {
  EXPECT_EQ(mesh.tets, (std::vector<std::array<int, 4>>{{0, 1, 2, 3}, {1, 2, 3, 4}}));
  ASSERT_EQ(mesh.vertices.size(), 5u);
  EXPECT_EQ(mesh.vertices[1], Point(1, 0, 0));
  EXPECT_EQ(mesh.vertices[4], Point(1, 1, 1));
  EXPECT_EQ(report.vertex_tags, (std::vector<std::int64_t>{1, 2, 30, 40, 500}));
  EXPECT_EQ(report.tet_tags, (std::vector<std::int64_t>{7, 9}));
  EXPECT_EQ(mesh.region_names, (Names{"soft", "hard"}));
  EXPECT_EQ(mesh.region, (Set{0, 1}));
  EXPECT_EQ(mesh.vertex_sets.at("base"), (Set{0, 1, 2}));
  EXPECT_EQ(mesh.vertex_sets.at("face"), (Set{2, 3, 4}));
}

// A tetrahedron of side 2 with the nodes 5 to 10 on its edges
void expect_ten_nodes(const TetMesh& mesh, const MeshReport& report) {
  EXPECT_EQ(report.split, 1);
  EXPECT_EQ(mesh.vertices.size(), 10u);
  EXPECT_EQ(mesh.tets.size(), 8u);
  EXPECT_NEAR(mesh_quality(mesh).volume, 8.0 / 6, 1e-15);
  EXPECT_EQ(mesh.vertex_sets.at("side"), (Set{0, 1, 2, 4, 5, 6}));
}

TEST(Inp, SetsBecomeRegionsAndVertexSets) {
  MeshReport report;
  const TetMesh mesh = read_mesh(deck("inp", "two"), &report);
  expect_two_tets(mesh, report);
  EXPECT_EQ(mesh.vertex_sets.at("Nall"), (Set{0, 1}));
  EXPECT_EQ(mesh.vertex_sets.at("top"), (Set{0, 1, 2, 3}));
  EXPECT_EQ(mesh.vertex_sets.at("of_hard"), (Set{1, 2, 3, 4}));
  EXPECT_EQ(mesh.vertex_sets.at("skin"), (Set{0, 1, 2}));
  EXPECT_TRUE(has_note(report, "not *ELASTIC, *MATERIAL"));
  EXPECT_EQ(read_surface(deck("inp", "two")).triangles.size(), 1u) << "its shell";
}

TEST(Inp, OnePartInAnAssembly) {
  MeshReport report;
  const TetMesh mesh = read_mesh(deck("inp", "part"), &report);
  expect_ten_nodes(mesh, report);
  EXPECT_EQ(mesh.region_names, Names{"all"});
  EXPECT_EQ(mesh.vertex_sets.at("mids"), (Set{4, 5, 6}));
  EXPECT_FALSE(mesh.vertex_sets.contains("reference"));
}

TEST(Inp, CellsOfNoSetAreARegion) {
  const FileBytes file = deck("inp", "two");
  MeshReport report;
  const TetMesh mesh =
      read_mesh(FileBytes{"m.inp", with(file.bytes, "\"hard\"\n9", "\"hard\"\n20")}, &report);
  EXPECT_EQ(mesh.region_names, (Names{"unassigned", "soft"}));
  const TetMesh shared =
      read_mesh(FileBytes{"m.inp", with(file.bytes, "\"hard\"\n9", "\"hard\"\n9, 7")}, &report);
  EXPECT_EQ(shared.region_names, (Names{"unassigned", "soft"}));
  EXPECT_TRUE(has_note(report, "are no regions: 'hard'"));
}

TEST(Inp, BadLinesAreRefused) {
  const std::string text = deck("inp", "two").bytes;
  const auto refused = [&](const char* from, const char* to, int line, const Names& parts) {
    expect_refused(FileBytes{"m.inp", with(text, from, to)}, "m.inp:" + std::to_string(line),
                   parts);
  };
  refused("*Heading", "Heading", 1, {"expected a keyword like *NODE"});
  refused("2, 1.D0", "2, 1.X0", 6, {"coordinate x is '1.X0'", "number"});
  refused("2, 1.D0", "2.5, 1.D0", 6, {"the number of a node is '2.5'", "integer"});
  refused("TYPE=C3D4,", "TYPE=C3D44,", 11, {"'C3D44'; did you mean 'C3D4'?"});
  refused("TYPE=C3D4, ", "", 11, {"TYPE=C3D4"});
  refused("7, 1, 2, 30, 40", "7, 1, 2, 30", 12, {"element 7, a tetrahedron, has 3 nodes"});
  refused("7, 1, 2, 30, 40", "9, 1, 2, 30, 40", 15, {"element 9 is defined again", "line 12"});
  refused("7, 1, 2, 30, 40", "7, 1, 2, 30, 41", 12, {"tetrahedron 7 names node 41"});
  refused("soft\n7", "soft\n8", 20, {"the element set 'soft' names element 8"});
  refused("BASE, 40", "bade, 40", 26, {"the node set 'top'", "'bade'; did you mean 'base'?"});
  refused("BASE, 40", "top, 40", 26, {"the node set 'top'", "'top'"});
  refused("1, 30, 1\n", "1, 30, 0\n", 24, {"'base'", "increment 0"});
  refused("hard, S3", "hard, S5", 29, {"'face'", "'S5' of element 9", "S1 to S4"});
  refused("hard, S3", "herd, S3", 29, {"'face'", "did you mean 'hard'?"});
  refused("*MATERIAL, NAME=m", "*INCLUDE, INPUT=m.inp", 31, {"*INCLUDE is not read"});
  refused("*node\n", "*node, SYSTEM=C\n", 7, {"SYSTEM=C", "rectangular"});
}

TEST(Feb, PartsBecomeRegions) {
  MeshReport report;
  const TetMesh mesh = read_mesh(deck("feb", "two_25"), &report);
  expect_two_tets(mesh, report);
  EXPECT_EQ(report.format, "FEBio 2.5");
  for (const char* version : {"3.0", "4.0"}) {
    std::string text =
        with(deck("feb", "two_25").bytes, "\"2.5\"", "\"" + std::string(version) + "\"");
    text = with(with(text, "<Geometry>", "<Mesh>"), "</Geometry>", "</Mesh>");
    expect_two_tets(read_mesh(FileBytes{"m.feb", text}, &report), report);
  }
}

TEST(Feb, TenNodesAndListsOfNumbers) {
  MeshReport report;
  const TetMesh mesh = read_mesh(deck("feb", "ten_40"), &report);
  expect_ten_nodes(mesh, report);
  EXPECT_EQ(mesh.region_names, Names{"Part1"});
  EXPECT_EQ(mesh.vertex_sets.at("corners"), (Set{0, 1, 2, 3}));
  EXPECT_EQ(mesh.vertex_sets.at("axis"), (Set{0, 1, 4}));
}

TEST(Feb, BadElementsAreRefused) {
  const std::string text = deck("feb", "two_25").bytes;
  const auto refused = [&](const char* from, const char* to, int line, const Names& parts) {
    expect_refused(FileBytes{"m.feb", with(text, from, to)}, "m.feb:" + std::to_string(line),
                   parts);
  };
  refused("\"2.5\"", "\"1.2\"", 2, {"version is '1.2'", "2.0 to 4.0"});
  refused("\"2.5\"", "\"4.0\"", 2, {"no <Mesh>"});
  refused("0,1,0", "0,1", 9, {"node 30 has 2 coordinates"});
  refused("0,1,0", "0,1,z", 9, {"a coordinate is 'z'", "number"});
  refused("\"tet4\"", "\"tet44\"", 13, {"'tet44'; did you mean 'tet4'?"});
  refused("1,2,30,40", "1,2,30", 13, {"element 7, a tetrahedron, has 3 nodes; expected 4"});
  refused("1,2,30,40", "1,2,30,41", 13, {"tetrahedron 7 names node 41"});
  refused("<node id=\"30\"/>", "<node id=\"31\"/>", 5, {"the node set 'base' names node 31"});
  refused("tri3 id=\"1\">30,40", "tri3 id=\"1\">30", 15, {"'face' has 2 nodes; expected 3"});
  refused("</Geometry>", "</Geometrie>", 16, {"malformed"});
}

TEST(Decks, AnyByteChangedIsRefusedOrSound) {
  const auto read = [](const FileBytes& file) { return read_mesh(file); };
  const auto check = [](const TetMesh& mesh) { EXPECT_GT(mesh_quality(mesh).volume, 0.0); };
  for (const char* name : {"two", "part"})
    change_every_byte(deck("inp", name), read, check, {',', '9', '*'});
  for (const char* name : {"two_25", "ten_40"})
    change_every_byte(deck("feb", name), read, check, {',', '9', '<'});
}

}  // namespace
