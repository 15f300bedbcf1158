// SPDX-License-Identifier: BSD-3-Clause
#include <cstring>
#include <limits>
#include <plica/meshes/files/list.hpp>
#include <plica/meshes/files/validated_mesh.hpp>
#include <plica/meshes/mesh_quality.hpp>

#include "mesh_input.hpp"

namespace {

using namespace plica;
using namespace plica::test;

// What is replaced by what, on which line that is refused, and what the message has
struct Change {
  const char *from, *to;
  int line;
  std::vector<std::string> parts;
};

const Change changes_2[] = {
    {"2.2 0 8", "4.0 0 8", 2, {"version is '4.0'", "2.0 to 2.2 and 4.1", "-format msh41"}},
    {"2.2 0 8", "2.2 2 8", 2, {"'2'", "0 (text) or 1 (binary)"}},
    {"2.2 0 8", "2.2 0 4", 2, {"'4'", "expected 8"}},
    {"2.2 0 8", "2.2", 2, {"'2.2'", "4.1 0 8"}},
    {"$EndMeshFormat", "$End", 3, {"$EndMeshFormat", "'$End'"}},
    {"$Nodes", "Nodes", 11, {"'Nodes'", "start of a section"}},
    {"$Nodes", "$Points", 24, {"'$EndPoints'", "the file ends"}},
    {"$Nodes", "$ParametricNodes", 11, {"$ParametricNodes", "parametric"}},
    {"$Nodes\n5", "$Nodes\n4", 17, {"$EndNodes after 4 nodes", "'11 1 1 1'"}},
    {"$Nodes\n5", "$Nodes\n6", 18, {"node 6 of 6", "'$EndNodes'"}},
    {"$Elements\n3",
     "$Elements\n2",
     23,
     {"$EndElements after 2 elements", "'8 4 2 2 2 2 3 10 11'"}},
    {"$Elements\n3", "$Elements\n4", 24, {"element 4 of 4", "'$EndElements'"}},
    {"$Nodes\n5", "$Nodes\n99999999999", 12, {"99999999999", "room for"}},
    {"$Elements\n3", "$Elements\n2147483648", 20, {"2147483648", "room for"}},
    {"$Nodes\n5", "$Nodes\n99999999999999999999", 12, {"'99999999999999999999'", "integer"}},
    {"$Nodes\n5", "$Nodes\n-5", 12, {"-5", "number of nodes"}},
    {"$Nodes\n5", "$Nodes\nfive", 12, {"'five'", "integer"}},
    {"10 0 0 1", "10 0 nan 1", 16, {"coordinate y is 'nan'", "finite"}},
    {"10 0 0 1", "10 -inf 0 1", 16, {"coordinate x is '-inf'", "finite"}},
    {"10 0 0 1", "10 0 0 1e999", 16, {"coordinate z is '1e999'", "finite"}},
    {"10 0 0 1", "10 0 0,5 1", 16, {"'0,5'", "number"}},
    {"10 0 0 1", "10 0 0", 16, {"'10 0 0'", "coordinate z"}},
    {"10 0 0 1", "10 0 0 1 7", 16, {"'10 0 0 1 7'", "three coordinates"}},
    {"10 0 0 1", "1.5 0 0 1", 16, {"'1.5'", "integer"}},
    {"10 0 0 1", "0 0 0 1", 16, {"node is 0", "1 or more"}},
    {"10 0 0 1", "3 0 0 1", 16, {"node 3 is defined again", "line 15"}},
    {"1 1 1 2 3 10", "1 1 1 2 3 12", 22, {"tetrahedron 7", "node 12"}},
    {"2 4 1 1 2 3", "2 4 1 1 2 99", 21, {"node 99"}},
    {"6 2 2 4 1 1 2 3", "6 2 2 0 1 1 2 99", 21, {"node 99"}},
    {"1 1 1 2 3 10", "1 1 1 2 3 3", 22, {"tetrahedron 7", "names a node twice: 1 2 3 3"}},
    {"2 2 2 3 10 11", "2 2 10 3 2 1", 23, {"tetrahedron 8 repeats tetrahedron 7 on line 22"}},
    {"10 0 0 1", "10 1 1 0", 22, {"tetrahedron 7 (nodes 1 2 3 10) has no volume"}},
    {"10 0 0 1", "10 1 1 1e-12", 22, {"tetrahedron 7", "longest edge"}},
    {"6 2 2", "6 77 2", 21, {"element 6 has type 77;"}},
    {"7 4 2 1 1 1 2 3 10", "7 4 2 1 1 1 2 3", 22, {"line ends", "a node of an element"}},
    {"7 4 2 1 1 1 2 3 10", "7 4 3 1 1 1 2 3 10", 22, {"line ends", "a node of an element"}},
    {"7 4 2 1 1 1 2 3 10", "7 4 -1 1 1 1 2 3 10", 22, {"number of tags of an element is -1"}},
    {"7 4 2 1 1 1 2 3 10", "7 4", 22, {"line ends", "number of tags"}},
    {"7 4 2 1 1 1 2 3 10", "7 4 2 x 1 1 2 3 10", 22, {"'x'", "physical group"}},
    {"7 4 2 1 1", "7 4 2 -9223372036854775808 1", 22, {"-9223372036854775808", "32 bits"}},
    {"7 4 2 1 1", "7 4 2 1 ?", 22, {"'?'", "tag"}},
    {"2 4 \"base\"", "2 4 base", 6, {"name in quotes", "'2 4 base'"}},
    {"2 4 \"base\"", "2 4 \"base", 6, {"name in quotes"}},
    {"2 4 \"base\"", "2 4 \"\"", 6, {"name in quotes"}},
    {"2 4 \"base\"", "4 4 \"base\"", 6, {"dimension", "is 4", "0 to 3"}},
    {"3 2 \"large tumour\"", "3 2 \"tissue\"", 8, {"group 2 'tissue'", "group 1"}},
    {"3 2 \"large tumour\"", "3 1 \"other\"", 8, {"group 1 'other'", "'tissue' already"}},
};

const Change changes_4[] = {
    {"0 0 1 2\n", "0 0 1 3\n", 15, {"expected an entity", "'$EndEntities'"}},
    {"0 0 1 2\n", "0 0 1 1\n", 14, {"expected $EndEntities"}},
    {"0 0 1 2\n", "0 0 1 99999999999\n", 11, {"99999999999", "room for"}},
    {"0 0 1 2\n", "0 0 1\n", 11, {"line ends", "number of entities"}},
    {"2 0 0 0 1 1 1 1 2 0",
     "2 0 0 0 1 1 1 2 1 2 0",
     14,
     {"volume 2", "groups 1 and 2", "one group"}},
    {"2 0 0 0 1 1 1 1 2 0", "1 0 0 0 1 1 1 1 2 0", 14, {"volume 1 is defined again"}},
    {"2 0 0 0 1 1 1 1 2 0", "2 0 0 0 1 1 1 1 2 5", 14, {"boundary", "the line ends"}},
    {"2 0 0 0 1 1 1 1 2 0", "2 0 0 nan 1 1 1 1 2 0", 14, {"'nan'", "finite"}},
    {"2 0 0 0 1 1 1 1 2 0", "2 0 0 0 1 1 1 1 2 0 4", 14, {"'4' is too much"}},
    {"3 2 4 1\n", "3 9 4 1\n", 37, {"volume 9", "does not define"}},
    {"2 5 1 11", "2 6 1 11", 29, {"the blocks hold 5 nodes and not 6"}},
    {"2 5 1 11", "2 4 1 11", 25, {"of a block is 2", "0 to 1", "4 in all"}},
    {"2 5 1 11",
     "9223372036854775807 5 1 11",
     17,
     {"blocks of nodes is 9223372036854775807", "room"}},
    {"2 5 1 11", "2 5 1", 17, {"line ends"}},
    {"3 1 0 2", "3 1 2 2", 25, {"parametric is 2"}},
    {"3 1 0 2", "4 1 0 2", 25, {"dimension of an entity is 4"}},
    {"3 1 0 2", "3 1 1 2", 28, {"line ends", "parametric coordinate"}},
    {"3 3 6 8", "3 4 6 8", 38, {"the blocks hold 3 elements and not 4"}},
    {"3 1 4 1", "3 1 2 1", 35, {"elements of dimension 2", "entity of dimension 3"}},
    {"3\n0 0 0", "1\n0 0 0", 21, {"node 1 is defined again (first on line 19)"}},
    {"0 0 1\n1 1 1", "0 0 1\n1 inf 1", 29, {"coordinate y is 'inf'"}},
    {"7 1 2 3 10", "7 1 2 3 12", 36, {"tetrahedron 7 names node 12"}},
    {"7 1 2 3 10", "7 1 2 3 3", 36, {"names a node twice"}},
    {"8 2 3 10 11", "8 3 2 1 10", 38, {"tetrahedron 8 repeats tetrahedron 7 on line 36"}},
};

TEST(MalformedMsh, Changes) {
  for (const Change& c : changes_2) expect_refused(with(two_tets, c.from, c.to), c.line, c.parts);
  for (const Change& c : changes_4) expect_refused(with(two_tets_4, c.from, c.to), c.line, c.parts);
}

TEST(MalformedMsh, OtherFilesAndVersions) {
  expect_refused("", 0, {"$MeshFormat", "the file ends"});
  expect_refused("<?xml version=\"1.0\"?>\n", 1, {"$MeshFormat", "'<?xml version=\"1.0\"?>'"});
}

TEST(MalformedMsh, Sections) {
  expect_refused(two_tets + "$Nodes\n1\n1 0 0 0\n$EndNodes\n", 25, {"second section $Nodes"});
  expect_refused(two_tets.substr(0, two_tets.find("$Elements")), 18,
                 {"a section $Elements", "the file ends"});
}

TEST(MalformedMsh, Tetrahedra) {
  const std::string triangle_only =
      with(with(with(two_tets, "7 4 2 1 1 1 2 3 10\n", ""), "8 4 2 2 2 2 3 10 11\n", ""),
           "$Elements\n3", "$Elements\n1");
  expect_refused(triangle_only, 0, {"no tetrahedron"});
}

TEST(MalformedMsh, LongAndUnprintableInputIsCut) {
  expect_refused("\x01" + std::string(100000, 'x'), 1, {"'?" + std::string(59, 'x') + "...'"});
}

TEST(MalformedMsh4, EntitiesComeFirst) {
  const std::size_t begin = two_tets_4.find("$Entities"), end = two_tets_4.find("$Nodes");
  const std::string late =
      two_tets_4.substr(0, begin) + two_tets_4.substr(end) + two_tets_4.substr(begin, end - begin);
  expect_refused(late, 34, {"$Entities must come before $Elements"});
  const TetMesh mesh = read_text(two_tets_4.substr(0, begin) + two_tets_4.substr(end));
  EXPECT_TRUE(mesh.region_names.empty());  // no entities, no groups
}

// Bytes are named where there are no lines
TEST(MalformedMsh4, Binary) {
  const FileBytes file = sample("blocks_41_binary.msh");
  const std::size_t flag = file.bytes.find("\n4.1 1 8\n") + 9,
                    nodes = file.bytes.find("$Nodes\n") + 7;
  const auto changed = [&](std::size_t at, auto value) {
    FileBytes copy = file;
    std::memcpy(copy.bytes.data() + at, &value, sizeof(value));
    return copy;
  };
  const auto place = [&](std::size_t at) { return file.name + ": byte " + std::to_string(at); };
  expect_refused(changed(flag, 2), place(flag), {"order of bytes", "is 2"});
  expect_refused(changed(nodes, std::uint64_t{1} << 40), place(nodes),
                 {"1099511627776", "room for"});
  expect_refused(changed(nodes, ~std::uint64_t{0}), place(nodes),
                 {"18446744073709551615", "below 2^63"});
  const std::size_t first = nodes + 32 + 20;  // the counts; the head of the first block
  expect_refused(changed(first, std::uint64_t{0}), place(first), {"tag of a node is 0"});
  expect_refused(changed(first + 16, std::numeric_limits<double>::quiet_NaN()), place(first + 16),
                 {"coordinate y is nan"});
  // in the last element: 20 bytes for its last nodes and the end of the section
  FileBytes cut = file;
  cut.bytes.resize(file.bytes.find("\n$EndElements") - 4);
  expect_refused(cut, place(cut.bytes.size() - 4),
                 {"expected a node of an element, but the data end"});
}

// Every class of malformed mesh in every format that is written, text and binary: the same is said
// of all of them.

class Malformed : public testing::TestWithParam<MeshWriter> {
 protected:
  // Two tetrahedra with a face in common
  TetMesh mesh = [] {
    TetMesh two;
    two.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
    two.tets = {{0, 1, 2, 3}, {1, 2, 3, 4}};
    return two;
  }();

  TetMesh read(MeshReport& report) const {
    const std::vector<FileBytes> files =
        GetParam().write(std::string("m.") + GetParam().extension, mesh, {}).files;
    if (files.size() == 1) return read_mesh(files[0], &report);
    return validated_mesh(parse_tetgen(files[1], files[0], report), report);
  }
  TetMesh read() const {
    MeshReport report;
    return read(report);
  }
  // The message names the file and has every one of `parts`
  void refused(const std::vector<std::string>& parts) const {
    try {
      read();
      ADD_FAILURE() << "is read; expected " << parts.front();
    } catch (const InputError& error) {
      const std::string message = error.what();
      EXPECT_EQ(message.substr(0, 2), "m.") << message;
      for (const std::string& part : parts)
        EXPECT_NE(message.find(part), std::string::npos) << message;
    }
  }
  // VTK's formats count from 0, the others from 1
  std::string number(int index) const {
    const std::string_view extension = GetParam().extension;
    return std::to_string(extension == "vtk" || extension == "vtu" ? index : index + 1);
  }
};

TEST_P(Malformed, SoundOnesAreRead) {
  MeshReport report;
  expect_same(read(report), mesh);
  EXPECT_EQ(report.flipped + report.unreferenced, 0);
}

TEST_P(Malformed, Empty) {
  mesh.tets.clear();
  refused({"no tetrahedron"});
  mesh.vertices.clear();
  refused({"m."});
}

TEST_P(Malformed, NotFinite) {
  for (const double value :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    mesh.vertices[3].y() = value;
    refused({std::isnan(value) ? "nan" : "inf"});
  }
}

TEST_P(Malformed, OutOfRange) {
  for (const int v : {5, 1'000'000'000}) {
    mesh.tets[1][2] = v;
    refused({number(v)});
  }
  mesh.tets[1][2] = -2;
  refused({"m."});  // some formats have no sign there
}

TEST_P(Malformed, VertexTwice) {
  mesh.tets[1] = {1, 2, 2, 4};
  refused({"tetrahedron " + number(1), "names a node twice", number(2) + " " + number(2)});
}

TEST_P(Malformed, RepeatedTetrahedron) {
  mesh.tets.push_back({3, 0, 1, 2});
  refused({"tetrahedron " + number(2) + " repeats tetrahedron " + number(0)});
}

TEST_P(Malformed, ThreeTetrahedraOnAFace) {
  mesh.vertices.push_back({2, 2, 2});
  mesh.tets.push_back({1, 2, 3, 5});
  refused({"tetrahedron " + number(2) + " shares a face with tetrahedra " + number(0) + " and " +
           number(1)});
}

TEST_P(Malformed, NoVolume) {
  mesh.vertices[4] = Point(0.5, 0.5, 0);
  mesh.tets[1] = {0, 1, 2, 4};
  refused({"tetrahedron " + number(1), "has no volume"});
  mesh.vertices[4] = mesh.vertices[0];
  refused({"tetrahedron " + number(1), "has no volume"});
}

TEST_P(Malformed, InvertedAreTurnedAndCounted) {
  const TetMesh sound = mesh;
  for (auto& tet : mesh.tets) std::swap(tet[2], tet[3]);
  MeshReport report;
  expect_same(read(report), sound);
  EXPECT_EQ(report.flipped, 2);
}

TEST_P(Malformed, UnreferencedAreDroppedAndCounted) {
  const TetMesh sound = mesh;
  mesh.vertices.insert(mesh.vertices.begin(), 2, Point(7, 7, 7));
  for (auto& tet : mesh.tets)
    for (int& v : tet) v += 2;
  MeshReport report;
  expect_same(read(report), sound);
  EXPECT_EQ(report.unreferenced, 2);
  EXPECT_EQ(std::to_string(report.vertex_tags[0]), number(2));
}

TEST_P(Malformed, DuplicatesAndPartsAreCounted) {
  for (const int v : {1, 2, 3})
    mesh.vertices.push_back(Point(mesh.vertices[static_cast<std::size_t>(v)]));
  mesh.tets[1] = {5, 6, 7, 4};
  const TetMesh torn = read();
  EXPECT_EQ(count_duplicate_vertices(torn, 1e-9), 3);
  EXPECT_EQ(count_parts(torn), 2);
}

INSTANTIATE_TEST_SUITE_P(All, Malformed, testing::ValuesIn(mesh_writers), [](const auto& one) {
  return std::string(one.param.extension) + "_" + one.param.name +
         (one.param.binary ? "_binary" : "");
});

}  // namespace
