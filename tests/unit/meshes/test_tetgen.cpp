// SPDX-License-Identifier: BSD-3-Clause
#include <plica/meshes/files/list.hpp>
#include <plica/meshes/files/sound_mesh.hpp>
#include <plica/meshes/mesh_quality.hpp>

#include "mesh_input.hpp"

namespace {

using namespace plica;
using namespace plica::test;

const std::string nodes =
    "# made by hand\n5 3 1 1\n0 0 0 0  7.5  0\n1 1 0 0 7.5 2 # on the base\n\n2 0 1 0 7.5 2\n3 0 0 1 0 0\n4 1 1 1 0 "
    "-1\n";
const std::string tets = "2 4 1\n0 0 1 2 3 5\n1 1 2 3 4 2\n";

TetMesh read(const std::string& ele, const std::string& node, MeshReport* report = nullptr) {
  MeshReport found;
  const TetMesh mesh = sound_mesh(parse_tetgen({"m.ele", ele}, {"m.node", node}, found), found);
  if (report) *report = found;
  return mesh;
}

void expect_refused_ele(const std::string& from, const std::string& to, int line,
                        const std::vector<std::string>& parts) {
  expect_refused([&] { read(with(tets, from, to), nodes); }, "m.ele:" + std::to_string(line), parts);
}
void expect_refused_node(const std::string& from, const std::string& to, int line,
                         const std::vector<std::string>& parts) {
  expect_refused([&] { read(tets, with(nodes, from, to)); }, "m.node:" + std::to_string(line), parts);
}

TEST(TetGen, TakesTetrahedraRegionsAndMarkers) {
  MeshReport report;
  const TetMesh mesh = read(tets, nodes, &report);
  EXPECT_EQ(mesh.vertices[3], Point(0, 0, 1));
  EXPECT_EQ(mesh.tets, (std::vector<std::array<int, 4>>{{0, 1, 2, 3}, {1, 2, 3, 4}}));
  EXPECT_EQ(mesh.region_names, (std::vector<std::string>{"attribute_2", "attribute_5"}));
  EXPECT_EQ(mesh.vertex_sets, (std::map<std::string, std::vector<int>>{{"marker_-1", {4}}, {"marker_2", {1, 2}}}));
  EXPECT_EQ(report.format, "TetGen .node and .ele");
}

TEST(TetGen, ReadsEitherFileOfThePairFromZeroAndFromOne) {
  for (const char* name : {"blocks.ele", "blocks.node", "blocks_0.ele", "blocks_0.node"}) {
    SCOPED_TRACE(name);
    MeshReport report;
    const TetMesh mesh = read_mesh(std::filesystem::path(sample(name).name), &report);
    const MeshQuality quality = mesh_quality(mesh);
    EXPECT_EQ(mesh.vertices.size(), 12u);
    EXPECT_EQ(report.vertex_tags.front(), std::string(name).find("_0") == std::string::npos ? 1 : 0);
    EXPECT_NEAR(quality.volume, 1.6e-5, 1e-17);
    EXPECT_EQ(mesh.region_names, (std::vector<std::string>{"attribute_1", "attribute_2"}));
    EXPECT_NEAR(quality.regions[1].volume, 8e-6, 1e-17);
    EXPECT_EQ(mesh.vertex_sets.at("marker_1"), (std::vector<int>{0, 1, 2, 3}));
  }
  EXPECT_THROW(read_mesh("no/such.ele"), InputError);
  EXPECT_THROW(read_mesh(MemoryFile{"no/such.ele", tets}), InputError);
}

// But for the digits of the last number the lengths tell
TEST(TetGen, CutAtAnyByteIsRefused) {
  for (std::size_t bytes = 0; bytes + 2 < tets.size(); ++bytes)
    EXPECT_THROW(read(tets.substr(0, bytes), nodes), InputError) << bytes;
  for (std::size_t bytes = 0; bytes + 3 < nodes.size(); ++bytes)
    EXPECT_THROW(read(tets, nodes.substr(0, bytes)), InputError) << bytes;
}

TEST(TetGen, AnyByteChangedIsRefusedOrSound) {
  const auto check = [](const TetMesh& mesh) { EXPECT_GT(mesh_quality(mesh).volume, 0.0); };
  change_every_byte(
      {"m.ele", tets}, [](const MemoryFile& file) { return read(file.bytes, nodes); }, check);
  change_every_byte(
      {"m.node", nodes}, [](const MemoryFile& file) { return read(tets, file.bytes); }, check);
}

TEST(MalformedTetGen, Nodes) {
  expect_refused([] { read(tets, ""); }, "m.node", {"the number of nodes", "the file ends"});
  expect_refused_node("5 3 1 1", "6 3 1 1", 8, {"node 6 of 6", "the file ends"});
  expect_refused_node("5 3 1 1", "4 3 1 1", 8, {"end of the file after 4 nodes", "'4 1 1 1"});
  expect_refused_node("5 3 1 1", "5 2 1 1", 2, {"dimension is 2", "must be 3"});
  expect_refused_node("5 3 1 1", "5 3 0 1", 3, {"boundary marker", "'7.5'"});
  expect_refused_node("5 3 1 1", "5 3 2 1", 3, {"line ends", "boundary marker"});
  expect_refused_node("5 3 1 1", "5 3 1 2", 2, {"markers is 2", "0 to 1"});
  expect_refused_node("5 3 1 1", "99999999999 3 1 1", 2, {"99999999999", "room for"});
  expect_refused_node("5 3 1 1", "5 3 99999999999 1", 2, {"99999999999", "room for"});
  expect_refused_node("3 0 0 1 0 0", "3 0 nan 1 0 0", 7, {"coordinate y is 'nan'"});
  expect_refused_node("3 0 0 1 0 0", "2 0 0 1 0 0", 7, {"node 2 is defined again (first on line 6)"});
}

TEST(MalformedTetGen, Tetrahedra) {
  expect_refused_ele("2 4 1\n", "2 10 1\n", 1, {"second order", "supported are those with 4"});
  expect_refused_ele("1 1 2 3 4 2", "# 1 1 2 3 4 2", 3, {"tetrahedron 2 of 2", "the file ends"});
  expect_refused_ele("2 4 1\n", "1 4 1\n", 3, {"end of the file after 1 tetrahedra"});
  expect_refused_ele("2 4 1\n", "2 4 0\n", 2, {"'5' is too much"});
  expect_refused_ele("2 4 1\n", "2 4\n", 1, {"line ends", "number of attributes"});
  expect_refused_ele("3 5\n", "3 5.5\n", 2, {"'5.5'", "its region"});
  expect_refused_ele("1 1 2 3 4 2", "1 1 2 3 9 2", 3, {"tetrahedron 1 names node 9"});
  expect_refused_ele("1 1 2 3 4 2", "1 1 2 3 3 2", 3, {"names a node twice"});
  expect_refused_ele("1 1 2 3 4 2", "1 0 2 3 1 2", 3, {"tetrahedron 1 repeats tetrahedron 0 on line 2"});
}

}  // namespace
