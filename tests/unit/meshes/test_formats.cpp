// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstring>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/files/list.hpp>
#include <plica/meshes/files/validated_mesh.hpp>
#include <plica/meshes/mesh_quality.hpp>

#include "mesh_input.hpp"

// Meshes as other programs write them: what is read of them, and what is left out with a word
namespace {

using namespace plica;
using namespace plica::test;

constexpr double blocks_volume = 1.6e-5;  // [m^3]

void expect_blocks(const TetMesh& mesh) {
  EXPECT_EQ(mesh.vertices.size(), 23u);
  EXPECT_EQ(mesh.tets.size(), 48u);
  const MeshQuality quality = mesh_quality(mesh);
  ASSERT_EQ(quality.regions.size(), 2u);
  EXPECT_NEAR(quality.regions[0].volume, blocks_volume / 2, 1e-11);
  EXPECT_NEAR(quality.regions[1].volume, blocks_volume / 2, 1e-11);
  EXPECT_NEAR(quality.boundary_area, 10 * 4e-4, 1e-8);
}

TEST(Formats, EveryFileHoldsTheSameBlocks) {
  for (const char* name : {"blocks_10.msh", "blocks.mesh", "blocks_zlib.vtu", "blocks_lz4.vtu",
                           "blocks_lz4_inline.vtu", "blocks_ascii_compressor.vtu"}) {
    SCOPED_TRACE(name);
    expect_blocks(read_mesh(sample(name)));
  }
}

TEST(Formats, NumbersThatTheMeshDoesNotHaveAreNotWritten) {
  const TetMesh sound = read_mesh(sample("blocks.mesh"));
  const auto refused = [&](const auto& spoil) {
    TetMesh mesh = sound;
    spoil(mesh);
    for (const char* name : {"m.msh", "m.vtk", "m.vtu", "m.mesh", "m.node"}) {
      SCOPED_TRACE(name);
      EXPECT_THROW(write_mesh(name, mesh), InputError);
    }
  };
  refused([](TetMesh& m) { m.region_names.clear(); });
  refused([](TetMesh& m) { m.region[3] = 2; });
  refused([](TetMesh& m) { m.region[3] = -1; });
  refused([](TetMesh& m) { m.region.pop_back(); });
  refused([](TetMesh& m) { m.tets[5][2] = static_cast<int>(m.vertices.size()); });
}

TEST(Formats, SecondOrderIsSplitInEight) {
  for (const char* name : {"blocks_order2.msh", "blocks_order2.vtk"}) {
    SCOPED_TRACE(name);
    MeshReport report;
    const TetMesh mesh = read_mesh(sample(name), &report);
    EXPECT_EQ(report.split, 48);
    EXPECT_TRUE(report.linearised.empty());
    EXPECT_EQ(report.flipped + report.unreferenced, 0);
    EXPECT_EQ(mesh.tets.size(), 384u);
    EXPECT_EQ(mesh.vertices.size(), 113u) << "all nodes of the file";
    EXPECT_EQ(report.vertex_tags.back() - report.vertex_tags.front(), 112) << "by their numbers";
    EXPECT_NEAR(mesh_quality(mesh).volume, blocks_volume, 1e-15);
    EXPECT_NEAR(mesh_quality(mesh).boundary_area, 10 * 4e-4, 1e-12);
  }
}

TEST(Formats, SecondOrderIsTakenByItsCornersIfAsked) {
  for (const char* name : {"blocks_order2.msh", "blocks_order2.vtk"}) {
    SCOPED_TRACE(name);
    MeshReport report;
    expect_blocks(read_mesh(sample(name), &report, {.order = SecondOrder::linear}));
    EXPECT_EQ(report.linearised.at("second-order tetrahedron"), 48);
    EXPECT_EQ(report.unreferenced, 0) << "the middles of edges are no stray points";
  }
}

TEST(Formats, HexahedraAreCutAlikeOnBothSides) {
  MeshReport report;
  const TetMesh mesh = read_mesh(sample("blocks_hexahedra.msh"), &report);
  ASSERT_GT(report.cut.at("hexahedron"), 10);
  EXPECT_EQ(mesh.tets.size(), 6u * static_cast<std::size_t>(report.cut.at("hexahedron")));
  EXPECT_NEAR(mesh_quality(mesh).volume, blocks_volume, 1e-15);
  // A face that two cells cut differently would be on the boundary
  EXPECT_NEAR(mesh_quality(mesh).boundary_area, 10 * 4e-4, 1e-12);
}

// One of each kind around common faces: a prism and a pyramid on a cube
const std::string kinds =
    "MeshVersionFormatted 2\nDimension\n3\nVertices\n11\n0 0 0 0\n1 0 0 0\n1 1 0 0\n0 1 0 0\n0 0 1 "
    "0\n1 0 1 0\n1 1 1 "
    "0\n"
    "0 1 1 0\n0.5 0.5 2 0\n2 0 0 0\n2 0 1 0\n"
    "Hexahedra 1\n1 2 3 4 5 6 7 8 4\nPyramids 1\n5 6 7 8 9 4\nPrisms 1\n2 10 3 6 11 7 9\n"
    "Quadrilaterals\n1\n1 4 3 2 7\nNormals\n1\n0 0 1\nEnd\n";

TEST(Formats, EveryKindOfCellIsCut) {
  MeshReport report;
  const TetMesh mesh = read_mesh(FileBytes{"m.mesh", kinds}, &report);
  EXPECT_EQ(mesh.tets.size(), 6u + 2 + 3);
  EXPECT_EQ(report.cut,
            (std::map<std::string, int>{{"hexahedron", 1}, {"prism", 1}, {"pyramid", 1}}));
  EXPECT_EQ(report.flipped, 0);
  const MeshQuality quality = mesh_quality(mesh);
  EXPECT_NEAR(quality.volume, 1 + 1.0 / 3 + 0.5, 1e-12);
  EXPECT_EQ(quality.boundary_triangles, 2 * 4 + 4 + 2 + 2 * 2)
      << "no face between two cells is on the boundary";
  EXPECT_EQ(mesh.region_names, (std::vector<std::string>{"reference_4", "reference_9"}));
  EXPECT_EQ(mesh.vertex_sets,
            (std::map<std::string, std::vector<int>>{{"reference_7", {0, 1, 2, 3}}}));
  EXPECT_EQ(report.skipped_sections, (std::vector<std::string>{"Normals"}));
  ASSERT_EQ(report.groups.sets.size(), 1u);
  EXPECT_EQ(report.groups.sets[0].elements,
            (std::vector<std::array<int, 3>>{{0, 3, 2}, {0, 2, 1}}));
}

TEST(Formats, AFoldedCellIsRefused) {
  const std::string folded = with(kinds, "1 1 1 0\n0 1 1 0\n", "0 1 1 0\n1 1 1 0\n");
  expect_refused(FileBytes{"m.mesh", folded}, "m.mesh:18", {"element 1 is folded"});
  const std::string collapsed = with(kinds, "2 10 3 6 11 7 9", "2 10 2 6 10 2 9");
  expect_refused(FileBytes{"m.mesh", collapsed}, "m.mesh:22", {"prism 1", "too few"});
  // A cube written as a collapsed one is a prism
  const TetMesh wedge =
      read_mesh(FileBytes{"m.mesh", with(kinds, "1 2 3 4 5 6 7 8 4", "1 2 3 3 5 6 7 7 4")});
  EXPECT_NEAR(mesh_quality(wedge).volume, 0.5 + 1.0 / 3 + 0.5, 1e-12);
}

TEST(Formats, MshOfOtherVersions) {
  const TetMesh mesh = read_text(two_tets);
  for (const char* version : {"2", "2.0", "2.1"})
    expect_same(read_text(with(two_tets, "2.2 0 8", version + std::string(" 0 8"))), mesh);
  const std::string first =
      "$NOD\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n10 0 0 1\n11 1 1 1\n$ENDNOD\n"
      "$ELM\n3\n6 2 4 1 3 1 2 3\n7 4 1 1 4 1 2 3 10\n8 4 2 2 4 2 3 10 11\n$ENDELM\n";
  MeshReport report;
  const TetMesh old = read_text(first, &report);
  EXPECT_EQ(report.format, "Gmsh MSH 1 ASCII");
  EXPECT_EQ(old.tets, mesh.tets);
  EXPECT_EQ(old.region_names, (std::vector<std::string>{"physical_1", "physical_2"}));
  EXPECT_EQ(old.vertex_sets.at("physical_4"), (std::vector<int>{0, 1, 2}));
  expect_refused(with(first, "7 4 1 1 4 1", "7 4 1 1 5 1"), 12, {"has 5 nodes; expected 4"});
  expect_refused(with(first, "$ENDNOD", "$EndNodes"), 8, {"$ENDNOD"});
}

template <typename Number>
void append(std::string& bytes, std::initializer_list<Number> numbers) {
  for (const Number number : numbers)
    bytes.append(reinterpret_cast<const char*>(&number), sizeof(number));
}

// Sections end without a line feed before their mark, those of data too
TEST(Formats, BinaryMshAsFTetWildWritesIt) {
  std::string bytes = "$MeshFormat\n2.2 1 8\n";
  append<std::int32_t>(bytes, {1});
  bytes += "$EndMeshFormat\n$Nodes\n4\n";
  for (const int v : {1, 2, 3, 4}) {
    append<std::int32_t>(bytes, {v});
    append<double>(bytes, {v == 2 ? 1.0 : 0.0, v == 3 ? 1.0 : 0.0, v == 4 ? 1.0 : 0.0});
  }
  bytes += "$EndNodes\n$Elements\n1\n";
  append<std::int32_t>(bytes, {4, 1, 0, 1, 1, 2, 3, 4});
  bytes += "$EndElements\n$ElementData\n1\n\"winding number\"\n1\n0\n3\n0\n1\n1\n";
  append<std::int32_t>(bytes, {1});
  append<double>(bytes, {0.5});
  bytes += "$EndElementData\n";
  MeshReport report;
  EXPECT_EQ(read_text(bytes, &report).tets.size(), 1u);
  EXPECT_EQ(report.skipped_sections, (std::vector<std::string>{"$ElementData"}));
}

TEST(Formats, GroupsKeepTheirNumbersAndTriangles) {
  const std::string tagged =
      with(with(with(with(two_tets, "3 1 \"tissue\"", "3 71 \"tissue\""), "7 4 2 1", "7 4 2 71"),
                "2 4 \"base\"", "2 40 \"base\""),
           "6 2 2 4", "6 2 2 40");
  MeshReport report;
  const TetMesh mesh = read_text(tagged, &report);
  ASSERT_EQ(report.groups.region_tags, (std::vector<std::int64_t>{2, 71}));
  for (const char* name : {"m.msh", "m.mesh"})
    for (const bool binary : {false, true})
      for (const char* format : {"msh41", "msh22"}) {
        const bool is_msh = std::string(name) == "m.msh";
        if (!is_msh && binary) continue;
        SCOPED_TRACE(name);
        MeshReport again;
        const TetMesh same = read_mesh(
            write_mesh(name, mesh, is_msh ? format : "", binary, report.groups).files.front(),
            &again);
        EXPECT_EQ(same.tets, mesh.tets);
        EXPECT_EQ(again.groups.region_tags, report.groups.region_tags);
        ASSERT_EQ(again.groups.sets.size(), 1u);
        EXPECT_EQ(again.groups.sets[0].dimension, 2);
        EXPECT_EQ(again.groups.sets[0].tag, 40);
        EXPECT_EQ(again.groups.sets[0].elements, report.groups.sets[0].elements);
        if (is_msh) expect_same(same, mesh);
      }
  const FileBytes vtk = write_mesh("m.vtk", mesh, "", false, report.groups).files.front();
  EXPECT_EQ(read_mesh(vtk).region_names, (std::vector<std::string>{"region_2", "region_71"}));
}

TEST(Formats, VectorsOfCellsAndPointsAreKept) {
  TetMesh mesh = read_mesh(sample("blocks_zlib.vtu"));
  auto& vectors = mesh.tet_vectors["the fibres"];
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    vectors.push_back(Point(1, static_cast<double>(t), -0.1));
  for (const char* name : {"m.vtk", "m.vtu"})
    for (const bool binary : {false, true}) {
      if (binary && name == std::string("m.vtu")) continue;
      const TetMesh again = read_mesh(write_mesh(name, mesh, "", binary).files.front());
      ASSERT_TRUE(again.tet_vectors.contains("the_fibres")) << name;
      EXPECT_EQ(again.tet_vectors.at("the_fibres"), vectors);
      EXPECT_EQ(again.region, mesh.region);
    }
  for (const char* format : {"msh22", "msh41"})
    for (const bool binary : {false, true}) {
      const TetMesh again = read_mesh(write_mesh("m.msh", mesh, format, binary).files.front());
      ASSERT_TRUE(again.tet_vectors.contains("the fibres")) << format;
      EXPECT_EQ(again.tet_vectors.at("the fibres"), vectors) << format;
    }
  const std::string points =
      "# vtk DataFile Version 3.0\nm\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 double\n9 9 9 0 0 "
      "0 1 0 0 0 1 0 0 0 "
      "1\n"
      "CELLS 1 5\n4 1 2 3 4\nCELL_TYPES 1\n10\nPOINT_DATA 5\nVECTORS a double\n9 9 9 4 0 0 0 4 0 0 "
      "0 4 0 0 8\n";
  const TetMesh one = read_mesh(FileBytes{"m.vtk", points});
  EXPECT_EQ(one.tet_vectors.at("a"), std::vector<Point>{Point(1, 1, 3)})
      << "the mean of its corners";
}

TEST(Formats, NoTwoArraysOfAFileHaveOneName) {
  TetMesh mesh = read_mesh(sample("blocks_zlib.vtu"));
  ASSERT_FALSE(mesh.region.empty());
  const auto vectors = [&](double x) {
    return std::vector<Point>(mesh.tets.size(), Point(x, 0, 1));
  };
  mesh.tet_vectors = {{"a b", vectors(1)},
                      {"a<b", vectors(2)},
                      {"a_b", vectors(3)},
                      {"a_b_2", vectors(4)},
                      {"region", vectors(5)}};
  for (const char* name : {"m.vtk", "m.vtu"}) {
    const WrittenMesh written = write_mesh(name, mesh, "", false);
    const TetMesh again = read_mesh(written.files.front());
    EXPECT_EQ(again.region, mesh.region) << name;
    ASSERT_EQ(again.tet_vectors.size(), 5u) << name;
    EXPECT_EQ(again.tet_vectors.at("a_b"), vectors(3)) << "a name that can stay stays";
    EXPECT_EQ(again.tet_vectors.at("a_b_2"), vectors(4));
    EXPECT_EQ(again.tet_vectors.at("a_b_3"), vectors(1));
    EXPECT_EQ(again.tet_vectors.at("a_b_4"), vectors(2));
    EXPECT_EQ(again.tet_vectors.at("region_2"), vectors(5));
    EXPECT_EQ(std::ranges::count_if(written.left_out,
                                    [](const std::string& s) {
                                      return s.find("another array has the name") !=
                                             std::string::npos;
                                    }),
              3)
        << name;
  }
  mesh.tet_vectors = {{"a\nb", vectors(1)}};
  EXPECT_THROW(write_mesh("m.msh", mesh, "msh41", false), InputError);
}

TEST(Formats, VectorsOfMshNodesAndElements) {
  const std::string mesh =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n5\n7 0 0 0\n8 1 0 0\n9 0 1 0\n10 0 0 1\n11 1 "
      "1 1\n$EndNodes\n"
      "$Elements\n2\n1000000000 4 2 0 1 7 8 9 10\n30 4 2 0 1 8 9 10 11\n$EndElements\n";
  const auto data = [](const std::string& section, const std::string& name,
                       const std::string& rest) {
    return "$" + section + "\n1\n\"" + name + "\"\n1\n0\n" + rest + "$End" + section + "\n";
  };
  const std::string of_cells =
                        data("ElementData", "f", "3\n0\n3\n2\n30 0 2 0\n1000000000 1 0 -1\n"),
                    of_nodes = data("NodeData", "g",
                                    "4\n0\n3\n4\n0\n7 4 0 0\n8 0 4 0\n9 0 0 4\n10 4 4 4\n"),
                    scalars = data("NodeData", "p", "3\n0\n1\n1\n7 3.5\n");
  const auto read = [&](const std::string& more) {
    return read_mesh(FileBytes{"m.msh", mesh + more});
  };
  const TetMesh both = read(of_cells + scalars + of_nodes);
  EXPECT_EQ(both.tet_vectors.size(), 2u) << "scalars are left out";
  EXPECT_EQ(both.tet_vectors.at("f"), (std::vector<Point>{{1, 0, -1}, {0, 2, 0}}));
  EXPECT_EQ(both.tet_vectors.at("g"), (std::vector<Point>{{2, 2, 2}, {1, 2, 2}}))
      << "means; node 11 has none";
  const auto refused = [&](const std::string& more, const char* line, const char* part) {
    expect_refused(FileBytes{"m.msh", mesh + data("NodeData", "f", more)}, line, {part});
  };
  refused("1\n0\n", "m.msh:21", "$NodeData has 1 integer tags; expected 3 or more");
  refused("3\n0\n3\n9999\n7 1 0 0\n", "m.msh:25", "the number of vectors is 9999");
  refused("3\n0\n3\n1x\n7 1 0 0\n", "m.msh:25", "integer tag 3 of 3");
  refused("3\n0\n3\n-1\n7 1 0 0\n", "m.msh:25", "the number of vectors is -1");
  refused("3\n0\n3\n99999999999999999999\n7 1 0 0\n", "m.msh:25", "integer tag 3 of 3");
  refused("3\n0\nthree\n1\n7 1 0 0\n", "m.msh:24", "integer tag 2 of 3");
  refused("3\n0\n3\n2\n7 1 0 0\n7 1 0 0\n", "m.msh:27", "tag 7 has a vector 'f' already");
  refused("3\n0\n3\n1\n7 1 0\n", "m.msh:26", "a component of a vector");
}

TEST(Formats, EverySurfaceOfTheBlocksIsTheSame) {
  for (const char* name : {"blocks.ply", "blocks_binary.ply", "blocks.off", "blocks.vtp",
                           "blocks_polydata_51.vtk", "blocks_polydata_42.vtk"}) {
    SCOPED_TRACE(name);
    SurfaceReport report;
    const TriangleSurface surface = read_surface(sample(name), &report);
    EXPECT_EQ(surface.triangles.size(), 40u);
    EXPECT_TRUE(report.closed());
    EXPECT_NEAR(enclosed_volume(surface), blocks_volume, 1e-11);
  }
  SurfaceReport report;
  read_surface(sample("blocks_51.vtk"), &report);  // the triangles of a grid
  EXPECT_EQ(report.open_edges, 4);
}

TEST(Formats, LooseOnesAreReadToo) {
  const std::string off =
      "COFF\n# c\n4 2 0\n0 0 0 1 0 0 1\n1 0 0 1 0 0 1\n1 1 0 1 0 0 1\n0 1 0 1 0 0 1\n4 0\n1 "
      "2\n3\n\n3 0 2 1 9 9\n";
  EXPECT_EQ(read_surface(FileBytes{"m.off", off}).triangles,
            (std::vector<std::array<int, 3>>{{0, 2, 1}, {0, 1, 2}, {0, 2, 3}}));
  const FileBytes stl = sample("blocks.stl");
  EXPECT_EQ(
      read_surface(FileBytes{"m.stl", with(stl.bytes, "endsolid", "end solid")}).triangles.size(),
      20u);
}

TEST(Formats, WrittenSurfacesAreTheSame) {
  const TriangleSurface surface = read_surface(sample("blocks.obj"));
  for (const char* name : {"m.ply", "m.off"}) {
    const TriangleSurface again = read_surface(write_surface(name, surface).files.front());
    EXPECT_EQ(again.vertices, surface.vertices) << name;
    EXPECT_EQ(again.triangles, surface.triangles) << name;
  }
}

TEST(Formats, StripsAndPolygons) {
  const std::string strip =
      "# vtk DataFile Version 3.0\n\nASCII\nDATASET POLYDATA\nPOINTS 5 float\n0 0 0 1 0 0 0 1 0 1 "
      "1 0 0 2 0\n"
      "LINES 1 3\n2 0 1\nTRIANGLE_STRIPS 1 6\n5 0 1 2 3 4\nPOLYGONS 1 5\n4 0 2 3 1\n";
  const TriangleSurface surface = read_surface(FileBytes{"m.vtk", strip});
  EXPECT_EQ(surface.triangles, (std::vector<std::array<int, 3>>{
                                   {0, 1, 2}, {1, 3, 2}, {2, 3, 4}, {0, 2, 3}, {0, 3, 1}}));
}

// A fan of `faces` triangles around a point
std::string fan(int faces, const std::string& more) {
  std::string text = "v 0 0 0\n";
  for (int k = 0; k <= faces; ++k)
    text += "v " + std::to_string(std::cos(0.001 * k)) + " " + std::to_string(std::sin(0.001 * k)) +
            " 0\n";
  for (int k = 2; k <= faces + 1; ++k)
    text += "f 1 " + std::to_string(k) + " " + std::to_string(k + 1) + "\n";
  return text + more;
}

TEST(Formats, AFewBadFacesAreLeftOut) {
  SurfaceReport report;
  const auto left_out = [&](const std::string& text) {
    read_surface(FileBytes{"m.obj", text}, &report);
    return report.left_out;
  };
  EXPECT_EQ(left_out(fan(300, "f 1 2\nf 1 2 9999\nf 1 2 x\n")), 3);
  EXPECT_EQ(left_out(fan(300, std::string(5, '\0'))), 0);
  EXPECT_THROW(left_out(fan(90, "f 1 2\n")), InputError);
  expect_refused([&] { left_out(fan(90, "f 1 2 x\nf 1 2\n")); }, "m.obj:183",
                 {"'x'", "2 of 92 faces", "1 %"});
}

TEST(Formats, CompressedArraysAreChecked) {
  const FileBytes zlib = sample("blocks_zlib.vtu");
  const auto changed = [&](const char* from, const char* to) {
    return FileBytes{zlib.name, with(zlib.bytes, from, to)};
  };
  EXPECT_THROW(read_mesh(changed("vtkZLibDataCompressor", "vtkLZMADataCompressor")), InputError);
  EXPECT_THROW(read_mesh(changed("vtkZLibDataCompressor", "vtkLZ4DataCompressor")), InputError);
  const auto check = [](const TetMesh& mesh) { EXPECT_GT(mesh_quality(mesh).volume, 0.0); };
  for (const char* name : {"blocks_zlib.vtu", "blocks_lz4.vtu", "blocks_lz4_inline.vtu"})
    change_every_byte(sample(name), [](const FileBytes& file) { return read_mesh(file); }, check,
                      {'A', '\xff'});
}

TEST(Formats, AnyByteChangedIsRefusedOrSound) {
  const auto of_mesh = [](const FileBytes& file) { return read_mesh(file); };
  const auto of_surface = [](const FileBytes& file) { return read_surface(file); };
  change_every_byte({"m.mesh", kinds}, of_mesh,
                    [](const TetMesh& mesh) { EXPECT_GT(mesh_quality(mesh).volume, 0.0); });
  for (const char* name :
       {"blocks.ply", "blocks_binary.ply", "blocks.off", "blocks_polydata_42.vtk"})
    change_every_byte(sample(name), of_surface,
                      [](const TriangleSurface& surface) { EXPECT_GT(surface_area(surface), 0.0); },
                      {' ', '9', '\xff'});
}

struct Refused {
  const char *sample, *from, *to;
  std::vector<std::string> parts;
};
const Refused refused[] = {
    {"blocks.ply", "ply", "plyy", {":1", "ply, the start"}},
    {"blocks.ply", "format ascii", "format text", {":2", "format ascii"}},
    {"blocks.ply", "property float x", "property floot x", {"'floot'", "did you mean 'float'"}},
    {"blocks.ply", "property float x", "property float a", {"not one property x"}},
    {"blocks.ply", "vertex_indices", "corners", {"not one list vertex_indices"}},
    {"blocks.ply", "element vertex 22", "element vertex 99999999999", {"99999999999", "room for"}},
    {"blocks.ply", "end_header", "end", {"end_header"}},
    {"blocks.off", "OFF", "OOF", {":1", "OFF, the start"}},
    {"blocks.off", "OFF", "OFF BINARY", {":1", "binary"}},
    {"blocks.off", "22 40 0", "22 99999999999 0", {"99999999999", "room for"}},
    {"blocks.off", "22 40 0", "22 41 0", {"face 41 of 41"}},
    {"blocks.mesh", "MeshVersionFormatted", "MeshVersion", {":1", "MeshVersionFormatted"}},
    {"blocks.mesh", " 3\n", " 2\n", {":3", "dimension is 2"}},
    {"blocks.mesh", " 23\n", " 24\n", {"coordinate x is 'Edges'"}},
    {"blocks.mesh", " 23\n", " 99999999999\n", {":5", "room for"}},
    {"blocks.vtp", "NumberOfPolys=\"40\"", "NumberOfPolys=\"41\"", {"offsets"}},
};

TEST(Formats, MalformedFilesAreRefused) {
  for (const Refused& one : refused) {
    SCOPED_TRACE(one.to);
    FileBytes file = sample(one.sample);
    file.bytes = with(file.bytes, one.from, one.to);
    try {
      file.name.ends_with(".mesh") ? void(read_mesh(file)) : void(read_surface(file));
      ADD_FAILURE() << "is read";
    } catch (const InputError& error) {
      for (const std::string& part : one.parts)
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  }
}

}  // namespace
