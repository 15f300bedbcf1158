// SPDX-License-Identifier: BSD-3-Clause
#include <plica/meshes/files/vtu_arrays.hpp>
#include <plica/meshes/mesh_quality.hpp>

#include "mesh_input.hpp"

namespace {

using namespace plica;
using namespace plica::test;

// Line 4 is <Piece>, 7 and 8 are points, 13 the cells' points
const std::string two_tets =
    "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" byte_order=\"LittleEndian\">\n<UnstructuredGrid>\n"
    "<Piece NumberOfPoints=\"5\" NumberOfCells='2'>\n<Points>\n"
    "<DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">\n0 0 0 1 0 0 0 1 0\n0 0 1 1 1 1\n"
    "</DataArray>\n</Points>\n<Cells>\n"
    "<DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">\n0 1 2 3 1 2 3 4\n</DataArray>\n"
    "<DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">4 8</DataArray>\n"
    "<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">10 10</DataArray>\n</Cells>\n"
    "<CellData>\n<DataArray type=\"Int32\" Name=\"region\" format=\"ascii\">5 2</DataArray>\n</CellData>\n"
    "<!-- a > comment --></Piece>\n</UnstructuredGrid>\n</VTKFile>\n";

TetMesh read(const MemoryFile& file) { return read_mesh(file); }
TetMesh read_text(const std::string& text) { return read_mesh(MemoryFile{"m.vtu", text}); }

void expect_refused_with(const std::string& from, const std::string& to, int line,
                         const std::vector<std::string>& parts) {
  expect_refused(MemoryFile{"m.vtu", with(two_tets, from, to)}, "m.vtu:" + std::to_string(line), parts);
}

const char* const variants[] = {"blocks_ascii.vtu", "blocks_base64.vtu",     "blocks_base64_32_big.vtu",
                                "blocks_raw.vtu",   "blocks_raw_32_big.vtu", "blocks_appended_base64.vtu"};

TEST(Vtu, TakesTetrahedraAndRegions) {
  const TetMesh mesh = read_text(two_tets);
  ASSERT_EQ(mesh.vertices.size(), 5u);
  EXPECT_EQ(mesh.vertices[3], Point(0, 0, 1));
  EXPECT_EQ(mesh.tets, (std::vector<std::array<int, 4>>{{0, 1, 2, 3}, {1, 2, 3, 4}}));
  EXPECT_EQ(mesh.region_names, (std::vector<std::string>{"region_2", "region_5"}));
}

TEST(Vtu, EveryVariantHoldsTheSameBlocks) {
  const TetMesh legacy = read(sample("blocks_51_binary.vtk"));
  for (const char* name : variants) {
    SCOPED_TRACE(name);
    const TetMesh mesh = read(sample(name));
    if (std::string(name) == "blocks_ascii.vtu")
      EXPECT_EQ(mesh.tets, legacy.tets);
    else
      expect_same(mesh, legacy);
  }
}

TEST(Vtu, LengthsMayBeEncodedApart) {
  const auto with_types = [](const std::string& text) {
    return with(two_tets, "\"types\" format=\"ascii\">10 10", "\"types\" format=\"binary\"> " + text + "\n");
  };
  expect_same(read_text(with_types("AgAAAAoK")), read_text(two_tets));      // together
  expect_same(read_text(with_types("AgAAAA==Cgo=")), read_text(two_tets));  // apart
  for (const char* bad : {"AgAAAAo", "AgAAAA==", "AgAAAAoKCgo=", "AwAAAAoK", "!gAAAAoK", "", "AgAA", "//////8="})
    EXPECT_THROW(read_text(with_types(bad)), InputError) << bad;
}

TEST(Vtu, CutAtAnyByteIsRefused) {
  for (const char* name : variants) {
    SCOPED_TRACE(name);
    expect_whole(sample(name), 1, read);
  }
}

TEST(Vtu, AnyByteChangedIsRefusedOrSound) {
  const auto check = [](const TetMesh& mesh) { EXPECT_GT(mesh_quality(mesh).volume, 0.0); };
  change_every_byte({"m.vtu", two_tets}, read, check);
  for (const char* name : {"blocks_base64.vtu", "blocks_raw.vtu"})
    change_every_byte(sample(name), read, check, {'<', '\xff'});
}

TEST(MalformedVtu, Files) {
  expect_refused(sample("blocks_zlib.vtu"), sample("blocks_zlib.vtu").name + ":2",
                 {"compressed by 'vtkZLibDataCompressor'", "supported are ascii, base64 and raw"});
  expect_refused(MemoryFile{"m.vtu", ""}, "m.vtu:1", {"XML tag", "the file ends"});
  expect_refused(MemoryFile{"m.vtu", "$MeshFormat\n"}, "m.vtu:1", {"XML tag", "'$MeshFormat?'"});
  expect_refused_with("\"UnstructuredGrid\"", "\"PolyData\"", 2, {"'PolyData'", "UnstructuredGrid"});
  expect_refused_with("\"LittleEndian\"", "\"Middle\"", 2, {"byte_order is 'Middle'"});
  expect_refused_with(" byte_order=\"LittleEndian\"", " byte_order=\"LittleEndian\" header_type=\"Int8\"", 2,
                      {"header_type is 'Int8'"});
  expect_refused_with("</Piece>", "</Piece><Piece/>", 21, {"second <Piece>"});
}

TEST(MalformedVtu, Xml) {
  expect_refused_with("</Points>", "</Pionts>", 10, {"malformed", "tags mismatch", "'</Pionts>"});
  expect_refused_with("<Points>", "<Points", 6, {"malformed", "start element tag", "'<DataArray"});
  expect_refused_with("'2'", "2", 4, {"malformed", "element attribute", "NumberOfCells=2"});
  expect_refused_with("'2'", "'2", 4, {"malformed", "element attribute", "NumberOfCells='2"});
  expect_refused_with("'2'", "'2' NumberOfPoints='5'", 4, {"second attribute 'NumberOfPoints'"});
  expect_refused_with("'2'", "'&two;'", 4, {"NumberOfCells is '&two;'"});
  expect_refused_with("<!-- a > comment -->", "<![CDATA[x]]>", 21, {"CDATA", "not supported"});
  expect_refused_with("-->", "", 21, {"malformed", "comment", "'<!-- a > comment"});
  expect_refused(MemoryFile{"m.vtu", two_tets + "<VTKFile/>"}, "m.vtu:24", {"second outermost"});
  std::string deep;
  for (int i = 0; i < 1000; ++i) deep += "<a>";
  expect_refused(MemoryFile{"m.vtu", two_tets.substr(0, two_tets.find("<Piece")) + deep}, "m.vtu:4",
                 {"malformed", "tags mismatch"});
}

TEST(MalformedVtu, Arrays) {
  expect_refused_with("NumberOfPoints=\"5\"", "NumberOfPoints=\"6\"", 6, {"NumberOfPoints is 6", "room for 5"});
  expect_refused_with("NumberOfPoints=\"5\"", "NumberOfPoints=\"4\"", 8, {"too much", "1 1 1"});
  expect_refused_with("NumberOfPoints=\"5\"", "NumberOfPoints=\"99999999999\"", 6, {"99999999999", "room for"});
  expect_refused_with("NumberOfPoints=\"5\"", "", 4, {"<Piece> has no NumberOfPoints"});
  expect_refused_with("NumberOfComponents=\"3\"", "NumberOfComponents=\"2\"", 6, {"'2'", "must be 3"});
  expect_refused_with("0 0 1 1 1 1", "0 0 1 1 inf 1", 8, {"coordinate y is 'inf'"});
  expect_refused_with("\"Float64\"", "\"Float46\"", 6, {"'Float46'", "did you mean 'Float64'"});
  expect_refused_with("\"ascii\"", "\"hex\"", 6, {"'hex'", "ascii, binary or appended"});
  expect_refused_with("\"ascii\"", "\"appended\" offset=\"0\"", 6, {"no <AppendedData>"});
  expect_refused_with("\"offsets\"", "\"offset\"", 4, {"no array 'offsets'"});
  expect_refused_with("\"offsets\"", "\"types\"", 16, {"second array of <Cells>"});
  expect_refused_with("4 8", "4 9", 13, {"points of cells", "it ends here"});
  expect_refused_with("10 10", "10 12", 16, {"cell 1 has type 12, a hexahedron"});
  expect_refused_with("1 2 3 4\n", "1 2 3 9\n", 13, {"tetrahedron 1 names node 9"});
  expect_refused_with("5 2", "5", 19, {"NumberOfCells is 2", "room for 1"});
}

TEST(MalformedVtu, Appended) {
  const MemoryFile file = sample("blocks_raw.vtu");
  const auto changed = [&](const std::string& from, const std::string& to) {
    return MemoryFile{file.name, with(file.bytes, from, to)};
  };
  const std::size_t begin = file.bytes.find("\n   _") + 5;
  const std::string at = file.name + ": byte ";
  EXPECT_THROW(read(changed("\n   _", "\n   -")), InputError);
  EXPECT_THROW(read(changed("\"raw\"", "\"rot\"")), InputError);
  expect_refused(changed("</AppendedData>", "</AppendedDate>"), at + std::to_string(file.bytes.size()),
                 {"expected </AppendedData>"});
  MemoryFile huge = file;
  const std::size_t points = std::stoul(file.bytes.substr(file.bytes.find("offset=", file.bytes.find("<Points>")) + 8));
  huge.bytes[begin + points + 6] = '\x7f';
  expect_refused(huge, at + std::to_string(begin + points), {"the array 'Points' has", "are left"});
}

TEST(Base64, DecodesWhatRfc4648Encodes) {
  EXPECT_EQ(decode_base64(""), "");
  EXPECT_EQ(decode_base64("Zg=="), "f");
  EXPECT_EQ(decode_base64("Zm8="), "fo");
  EXPECT_EQ(decode_base64("Zm9vYmFy"), "foobar");
  for (const char* bad : {"Z", "Zm9", "Zm9=v", "Z===", "====", "Zm9-", "=Zm9"}) EXPECT_FALSE(decode_base64(bad)) << bad;
}

}  // namespace
