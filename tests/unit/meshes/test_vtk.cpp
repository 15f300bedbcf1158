// SPDX-License-Identifier: BSD-3-Clause
#include <cstring>
#include <plica/meshes/files/base64.hpp>
#include <plica/meshes/mesh_quality.hpp>

#include "mesh_input.hpp"

namespace {

using namespace plica;
using namespace plica::test;

// Two tetrahedra on a common face and a triangle; line 6 is point 0, 11 cell 0, 15 its type
const std::string two_tets =
    "# vtk DataFile Version 3.0\n\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 double\n0 0 0\n1 0 "
    "0\n0 1 0 0 0 1\n1 1 "
    "1\n"
    "CELLS 3 14\n3 0 1 2\n4 0 1 2 3\n4 1 2 3 4\nCELL_TYPES 3\n5\n10 10\n"
    "CELL_DATA 3\nSCALARS quality int 1\nLOOKUP_TABLE default\n7 8 9\nFIELD FieldData 1\nregion 1 "
    "3 int\n0 5 2\n";

const std::string two_tets_5 =
    "# vtk DataFile Version 5.1\ntitle\nASCII\nDATASET UNSTRUCTURED_GRID\n"
    "FIELD FieldData 1\nTIME 1 1 double\n0.5\nMETADATA\nINFORMATION 1\nNAME A LOCATION B\n\n"
    "POINTS 5 float\n0 0 0 1 0 0 0 1 0 0 0 1 1 1 1\nMETADATA\nINFORMATION 0\n\n"
    "CELLS 4 11\nOFFSETS vtktypeint64\n0 3 7 11\nCONNECTIVITY vtktypeint64\n0 1 2 0 1 2 3 1 2 3 4\n"
    "CELL_TYPES 3\n5 10 10\nPOINT_DATA 5\nVECTORS v float\n0 0 0 0 0 0 0 0 0 0 0 0 0 nan 0\n"
    "CELL_DATA 3\nFIELD FieldData 2\nregion 1 3 int\n0 5 2\nMETADATA\nINFORMATION 0\n\nother 2 3 "
    "double\n1 2 3 4 5 6\n";

TetMesh read(const FileBytes& file) { return read_mesh(file); }
TetMesh read_text(const std::string& text) { return read_mesh(FileBytes{"m.vtk", text}); }

void expect_refused_with(const std::string& from, const std::string& to, int line,
                         const std::vector<std::string>& parts) {
  expect_refused(FileBytes{"m.vtk", with(two_tets, from, to)}, "m.vtk:" + std::to_string(line),
                 parts);
}

TEST(Vtk, TakesTetrahedraAndRegions) {
  MeshReport report;
  const TetMesh mesh = read_mesh(FileBytes{"m.vtk", two_tets}, &report);
  ASSERT_EQ(mesh.vertices.size(), 5u);
  EXPECT_EQ(mesh.vertices[3], Point(0, 0, 1));
  EXPECT_EQ(mesh.tets, (std::vector<std::array<int, 4>>{{0, 1, 2, 3}, {1, 2, 3, 4}}));
  EXPECT_EQ(mesh.region_names, (std::vector<std::string>{"region_2", "region_5"}));
  EXPECT_EQ(mesh.region, (std::vector<int>{1, 0}));
  EXPECT_EQ(report.format, "VTK legacy 3.0 ASCII");
  EXPECT_EQ(report.tet_tags, (std::vector<std::int64_t>{1, 2}));
  EXPECT_EQ(report.other_elements, (std::map<std::string, int>{{"triangle", 1}}));
  expect_same(read_text(two_tets_5), mesh);
}

TEST(Vtk, RegionsAreAnArrayWithAUsualName) {
  EXPECT_TRUE(read_text(with(two_tets, "region 1 3", "other 1 3")).region_names.empty());
  EXPECT_EQ(read_text(with(two_tets, "region 1 3 int\n0 5 2", "Material_IDs 1 3 float\n0 5.0 2e0"))
                .region_names,
            (std::vector<std::string>{"Material_IDs_2", "Material_IDs_5"}));
  EXPECT_TRUE(read_text(with(two_tets, "0 5 2", "7 0 0")).region_names.empty());
  EXPECT_TRUE(read_text(two_tets.substr(0, two_tets.find("CELL_DATA"))).region_names.empty());
}

TEST(Vtk, EveryVariantHoldsTheSameBlocks) {
  const TetMesh first = read(sample("blocks_20.vtk"));
  for (const std::string name : {"20", "42", "51"})
    for (const std::string form : {"", "_binary"}) {
      SCOPED_TRACE(name + form);
      MeshReport report;
      const TetMesh mesh = read_mesh(sample("blocks_" + name + form + ".vtk"), &report);
      EXPECT_EQ(report.format, "VTK legacy " + name.substr(0, 1) + "." + name.substr(1) +
                                   (form.empty() ? " ASCII" : " binary"));
      EXPECT_EQ(mesh.vertices.size(), 23u);
      EXPECT_EQ(mesh.tets, first.tets);
      EXPECT_EQ(mesh.region, first.region);
      const std::string array = name == "20" ? "CellEntityIds" : "region";
      EXPECT_EQ(mesh.region_names, (std::vector<std::string>{array + "_1", array + "_2"}));
      EXPECT_NEAR(mesh_quality(mesh).volume, 1.6e-5, 1e-17);
    }
}

// The arrays after the types may be cut off without a trace
TEST(Vtk, CutAtAnyByteIsRefused) {
  const TetMesh whole = read(sample("blocks_51.vtk"));
  for (const char* name : {"blocks_51.vtk", "blocks_51_binary.vtk", "blocks_42_binary.vtk"}) {
    SCOPED_TRACE(name);
    const FileBytes file = sample(name);
    for (std::size_t bytes = 0; bytes < file.bytes.size(); ++bytes) {
      try {
        const TetMesh mesh = read({file.name, file.bytes.substr(0, bytes)});
        EXPECT_EQ(mesh.tets, whole.tets) << bytes;
        EXPECT_EQ(mesh.vertices.size(), whole.vertices.size()) << bytes;
      } catch (const InputError&) {
      }
    }
    const std::size_t needed = file.bytes.find("CELL_DATA") - 2;
    expect_whole({file.name, file.bytes.substr(0, needed)}, 0, read);
  }
}

TEST(Vtk, AnyByteChangedIsRefusedOrSound) {
  const auto check = [](const TetMesh& mesh) { EXPECT_GT(mesh_quality(mesh).volume, 0.0); };
  change_every_byte({"m.vtk", two_tets}, read, check);
  change_every_byte({"m.vtk", two_tets_5}, read, check);
  for (const char* name : {"blocks_42_binary.vtk", "blocks_51_binary.vtk"})
    change_every_byte(sample(name), read, check, {'\0', '\x01', '\xff'});
}

TEST(MalformedVtk, Headings) {
  expect_refused(FileBytes{"m.vtk", ""}, "m.vtk", {"# vtk DataFile Version", "the file ends"});
  expect_refused_with("3.0", "6.0", 1, {"version is '6.0'", "1.0 to 5.1"});
  expect_refused_with("ASCII", "TEXT", 3, {"'TEXT'", "ASCII or BINARY"});
  expect_refused_with("UNSTRUCTURED_GRID", "RECTILINEAR_GRID", 4,
                      {"DATASET UNSTRUCTURED_GRID", "'DATASET RECT"});
  expect_refused_with("UNSTRUCTURED_GRID", "POLYDATA", 10, {"POLYGONS", "'CELLS 3 14'"});
  expect_refused_with("DATASET UNSTRUCTURED_GRID\n", "", 4, {"DATASET UNSTRUCTURED_GRID"});
  expect_refused_with("CELL_TYPES 3", "CELL_KINDS 3", 14, {"keyword", "'CELL_KINDS 3'"});
  expect_refused(FileBytes{"m.vtk", two_tets.substr(0, two_tets.find("CELL_TYPES"))}, "m.vtk:13",
                 {"CELL_TYPES", "ends"});
}

TEST(MalformedVtk, Points) {
  expect_refused_with("5 double", "5 doubel", 5, {"'doubel'", "did you mean 'double'"});
  expect_refused_with("5 double", "99999999999 double", 5, {"99999999999", "room for"});
  expect_refused_with("5 double", "-5 double", 5, {"-5"});
  expect_refused_with("5 double", "6 double", 10, {"coordinate x", "'CELLS'"});
  expect_refused_with("5 double", "4 double", 9, {"keyword", "'1 1 1'"});
  expect_refused_with("0 1 0 0 0 1", "0 1 0 0 0 1 1", 9, {"'1' is too much", "the points"});
  expect_refused_with("0 1 0 0 0 1", "0 1 0 0 nan 1", 8, {"coordinate y is 'nan'"});
  expect_refused_with("4 1 2 3 4", "4 1 2 3 5", 13, {"tetrahedron 2 names node 5"});
}

TEST(MalformedVtk, Cells) {
  expect_refused_with("CELLS 3 14", "CELLS 3 15", 13, {"take 14 numbers and not 15"});
  expect_refused_with("CELLS 3 14", "CELLS 3 13", 13, {"points of cell 2 is 4", "4 of 13"});
  expect_refused_with("CELLS 3 14", "CELLS 4 14", 14,
                      {"number of points of a cell", "'CELL_TYPES'"});
  expect_refused_with("CELLS 3 14", "CELLS 3 99999999999", 10, {"99999999999", "room for"});
  expect_refused_with("CELLS 3 14\n3 0 1 2", "CELLS 3 15\n4 0 1 2 3", 11,
                      {"cell 0, a triangle, has 4 points", "expected 3"});
  expect_refused_with("5\n10 10", "5\n10 12", 13,
                      {"cell 2, a hexahedron, has 4 points", "expected 8"});
  expect_refused_with("5\n10 10", "5\n10 42", 16,
                      {"cell 2 has type 42, a polyhedron", "supported"});
  expect_refused_with("5\n10 10", "5\n10 99", 16, {"cell 2 has type 99;"});
  expect_refused_with("CELL_TYPES 3\n5\n", "CELL_TYPES 2\n", 15, {"there are 2 types for 3 cells"});
  expect_refused_with("4 1 2 3 4", "4 1 2 3 0", 13,
                      {"tetrahedron 2 repeats tetrahedron 1 on line 12"});
  const auto refuse_5 = [](const std::string& from, const std::string& to, int line,
                           const std::vector<std::string>& parts) {
    expect_refused(FileBytes{"m.vtk", with(two_tets_5, from, to)}, "m.vtk:" + std::to_string(line),
                   parts);
  };
  refuse_5("0 3 7 11\n", "1 3 7 11\n", 19, {"first offset is 1"});
  refuse_5("0 3 7 11\n", "0 3 7 10\n", 19, {"use 10 of 11"});
  refuse_5("0 3 7 11\n", "0 3 12 11\n", 19, {"cell 1 is from 3 to 12 of 11"});
  refuse_5("0 3 7 11\n", "0 3 2 11\n", 19, {"cell 1 is from 3 to 2"});
  refuse_5("OFFSETS vtktypeint64", "OFFSETS double", 18, {"an offset is no integer"});
  refuse_5("OFFSETS", "OFSETS", 18, {"OFFSETS vtktypeint64", "'OFSETS vtktypeint64'"});
}

TEST(MalformedVtk, Arrays) {
  expect_refused_with("CELL_DATA 3", "CELL_DATA 4", 17, {"4 for 3 cells"});
  expect_refused_with("LOOKUP_TABLE default\n", "", 19, {"LOOKUP_TABLE default", "'7 8 9'"});
  expect_refused_with("region 1 3 int\n0 5 2", "region 3 3 int\n0 5 2 0 0 0 0 0 0", 22,
                      {"'region'", "one integer per cell"});
  expect_refused_with("region 1 3 int", "region 1 2 int", 23, {"'2' is too much"});
  expect_refused_with("region 1 3 int", "region 1 3 string", 22, {"'string'", "choices"});
  expect_refused_with("region 1 3 int", "region 0 3 int", 22, {"components is 0"});
  expect_refused_with("FieldData 1", "FieldData 2", 23, {"array 2 of 2", "the file ends"});
  expect_refused_with("0 5 2", "0 5 x", 23, {"a value of the array 'region' is 'x'"});
}

TEST(MalformedVtk, Binary) {
  const FileBytes file = sample("blocks_51_binary.vtk");
  const std::size_t points = file.bytes.find("double\n") + 7;
  const auto place = [&](std::size_t at) { return file.name + ": byte " + std::to_string(at); };
  FileBytes changed = file;
  changed.bytes.replace(points + 8, 2, "\x7f\xf8");
  expect_refused(changed, place(points + 8), {"coordinate y is nan"});
  changed = file;
  changed.bytes.resize(points + 100);
  expect_refused(changed, place(points), {"number of points is 23", "room for 4"});
}

// Line 4 is <Piece>, 7 and 8 are points, 13 the cells' points
const std::string xml_tets =
    "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" "
    "byte_order=\"LittleEndian\">\n<UnstructuredGrid>\n"
    "<Piece NumberOfPoints=\"5\" NumberOfCells='2'>\n<Points>\n"
    "<DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">\n0 0 0 1 0 0 0 1 0\n0 "
    "0 1 1 1 1\n"
    "</DataArray>\n</Points>\n<Cells>\n"
    "<DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">\n0 1 2 3 1 2 3 "
    "4\n</DataArray>\n"
    "<DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">4 8</DataArray>\n"
    "<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">10 10</DataArray>\n</Cells>\n"
    "<CellData>\n<DataArray type=\"Int32\" Name=\"region\" format=\"ascii\">5 "
    "2</DataArray>\n</CellData>\n"
    "<!-- a > comment --></Piece>\n</UnstructuredGrid>\n</VTKFile>\n";

TetMesh read_xml(const std::string& text) { return read_mesh(FileBytes{"m.vtu", text}); }

void expect_xml_refused(const std::string& from, const std::string& to, int line,
                        const std::vector<std::string>& parts) {
  expect_refused(FileBytes{"m.vtu", with(xml_tets, from, to)}, "m.vtu:" + std::to_string(line),
                 parts);
}

const char* const variants[] = {"blocks_ascii.vtu",         "blocks_base64.vtu",
                                "blocks_base64_32_big.vtu", "blocks_raw.vtu",
                                "blocks_raw_32_big.vtu",    "blocks_appended_base64.vtu"};

TEST(Vtu, TakesTetrahedraAndRegions) {
  const TetMesh mesh = read_xml(xml_tets);
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
    return with(xml_tets, "\"types\" format=\"ascii\">10 10",
                "\"types\" format=\"binary\"> " + text + "\n");
  };
  expect_same(read_xml(with_types("AgAAAAoK")), read_xml(xml_tets));      // together
  expect_same(read_xml(with_types("AgAAAA==Cgo=")), read_xml(xml_tets));  // apart
  for (const char* bad :
       {"AgAAAAo", "AgAAAA==", "AgAAAAoKCgo=", "AwAAAAoK", "!gAAAAoK", "", "AgAA", "//////8="})
    EXPECT_THROW(read_xml(with_types(bad)), InputError) << bad;
}

TEST(Vtu, CutAtAnyByteIsRefused) {
  for (const char* name : variants) {
    SCOPED_TRACE(name);
    expect_whole(sample(name), 1, read);
  }
}

TEST(Vtu, AnyByteChangedIsRefusedOrSound) {
  const auto check = [](const TetMesh& mesh) { EXPECT_GT(mesh_quality(mesh).volume, 0.0); };
  change_every_byte({"m.vtu", xml_tets}, read, check);
  for (const char* name : {"blocks_base64.vtu", "blocks_raw.vtu"})
    change_every_byte(sample(name), read, check, {'<', '\xff'});
}

TEST(MalformedVtu, Files) {
  expect_refused(FileBytes{"m.vtu", ""}, "m.vtu:1", {"XML tag", "the file ends"});
  expect_refused(FileBytes{"m.vtu", "$Format\n"}, "m.vtu:1", {"XML tag", "'$Format?'"});
  expect_xml_refused("\"UnstructuredGrid\"", "\"ImageData\"", 2,
                     {"'ImageData'", "UnstructuredGrid"});
  expect_xml_refused("\"LittleEndian\"", "\"Middle\"", 2, {"byte_order is 'Middle'"});
  expect_xml_refused(" byte_order=\"LittleEndian\"",
                     " byte_order=\"LittleEndian\" header_type=\"Int8\"", 2,
                     {"header_type is 'Int8'"});
  expect_xml_refused("</Piece>", "</Piece><Piece/>", 21, {"second <Piece>"});
}

TEST(MalformedVtu, Xml) {
  expect_xml_refused("</Points>", "</Pionts>", 10, {"malformed", "tags mismatch", "'</Pionts>"});
  expect_xml_refused("<Points>", "<Points", 6, {"malformed", "start element tag", "'<DataArray"});
  expect_xml_refused("'2'", "2", 4, {"malformed", "element attribute", "NumberOfCells=2"});
  expect_xml_refused("'2'", "'2", 4, {"malformed", "element attribute", "NumberOfCells='2"});
  expect_xml_refused("'2'", "'2' NumberOfPoints='5'", 4, {"second attribute 'NumberOfPoints'"});
  expect_xml_refused("'2'", "'&two;'", 4, {"NumberOfCells is '&two;'"});
  expect_xml_refused("<!-- a > comment -->", "<![CDATA[x]]>", 21, {"CDATA", "not supported"});
  expect_xml_refused("-->", "", 21, {"malformed", "comment", "'<!-- a > comment"});
  expect_refused(FileBytes{"m.vtu", xml_tets + "<VTKFile/>"}, "m.vtu:24", {"second outermost"});
  std::string deep;
  for (int i = 0; i < 1000; ++i) deep += "<a>";
  expect_refused(FileBytes{"m.vtu", xml_tets.substr(0, xml_tets.find("<Piece")) + deep}, "m.vtu:4",
                 {"malformed", "tags mismatch"});
}

TEST(MalformedVtu, Arrays) {
  expect_xml_refused("NumberOfPoints=\"5\"", "NumberOfPoints=\"6\"", 6,
                     {"NumberOfPoints is 6", "room for 5"});
  expect_xml_refused("NumberOfPoints=\"5\"", "NumberOfPoints=\"4\"", 8, {"too much", "1 1 1"});
  expect_xml_refused("NumberOfPoints=\"5\"", "NumberOfPoints=\"99999999999\"", 6,
                     {"99999999999", "room for"});
  expect_xml_refused("NumberOfPoints=\"5\"", "", 4, {"<Piece> has no NumberOfPoints"});
  expect_xml_refused("NumberOfComponents=\"3\"", "NumberOfComponents=\"2\"", 6,
                     {"'2'", "must be 3"});
  expect_xml_refused("0 0 1 1 1 1", "0 0 1 1 inf 1", 8, {"coordinate y is 'inf'"});
  expect_xml_refused("\"Float64\"", "\"Float46\"", 6, {"'Float46'", "did you mean 'Float64'"});
  expect_xml_refused("\"ascii\"", "\"hex\"", 6, {"'hex'", "ascii, binary or appended"});
  expect_xml_refused("\"ascii\"", "\"appended\" offset=\"0\"", 6, {"no <AppendedData>"});
  expect_xml_refused("\"offsets\"", "\"offset\"", 4, {"no array 'offsets'"});
  expect_xml_refused("\"offsets\"", "\"types\"", 16, {"second array of <Cells>"});
  expect_xml_refused("4 8", "4 9", 13, {"connectivity", "it ends here"});
  expect_xml_refused("10 10", "10 15", 16, {"cell 1 has type 15, a pentagonal prism"});
  expect_xml_refused("1 2 3 4\n", "1 2 3 9\n", 13, {"tetrahedron 1 names node 9"});
  expect_xml_refused("5 2", "5", 19, {"NumberOfCells is 2", "room for 1"});
}

TEST(MalformedVtu, Appended) {
  const FileBytes file = sample("blocks_raw.vtu");
  const auto changed = [&](const std::string& from, const std::string& to) {
    return FileBytes{file.name, with(file.bytes, from, to)};
  };
  const std::size_t begin = file.bytes.find("\n   _") + 5;
  const std::string at = file.name + ": byte ";
  EXPECT_THROW(read(changed("\n   _", "\n   -")), InputError);
  EXPECT_THROW(read(changed("\"raw\"", "\"rot\"")), InputError);
  expect_refused(changed("</AppendedData>", "</AppendedDate>"),
                 at + std::to_string(file.bytes.size()), {"expected </AppendedData>"});
  FileBytes huge = file;
  const std::size_t points =
      std::stoul(file.bytes.substr(file.bytes.find("offset=", file.bytes.find("<Points>")) + 8));
  huge.bytes[begin + points + 6] = '\x7f';
  expect_refused(huge, at + std::to_string(begin + points), {"the array 'Points' has", "are left"});
}

TEST(Base64, IsThatOfRfc4648) {
  const std::pair<const char*, const char*> known[] = {{"", ""},
                                                       {"f", "Zg=="},
                                                       {"fo", "Zm8="},
                                                       {"foo", "Zm9v"},
                                                       {"foob", "Zm9vYg=="},
                                                       {"fooba", "Zm9vYmE="},
                                                       {"foobar", "Zm9vYmFy"}};
  for (const auto& [bytes, text] : known) {
    std::string encoded = "after ";
    append_base64(encoded, bytes);
    EXPECT_EQ(encoded, std::string("after ") + text);
    EXPECT_EQ(decode_base64(text), bytes);
  }
  std::string all;
  for (int i = 0; i < 256 * 3; ++i) all += static_cast<char>(i / 3 + i % 3 * 85);
  std::string encoded;
  append_base64(encoded, all);
  EXPECT_EQ(decode_base64(encoded), all);
  for (const char* bad : {"Z", "Zm9", "Zm9=v", "Z===", "====", "Zm9-", "=Zm9"})
    EXPECT_FALSE(decode_base64(bad)) << bad;
}

}  // namespace
