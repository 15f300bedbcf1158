// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstring>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/files/list.hpp>
#include <plica/meshes/files/mesh_files.hpp>
#include <plica/meshes/files/validated_mesh.hpp>
#include <plica/meshes/mesh_quality.hpp>
#include <sstream>

#include "mesh_input.hpp"

namespace {

using namespace plica;
using namespace plica::test;

// A tetrahedron; line 1 is the first vertex, 5 the first face
const std::string obj =
    "v 0 0 0\nv 1 0 0 # a corner\nv 0 1 0 1.0\nv 0 0 1 0.5 0.5 0.5\nf 1 3 2\nf 1/1 2/2 4/3\nf 2//1 "
    "3//1 4//1\nf -4 -1 "
    "-2\n";
// A triangle; line 4 is its first corner
const std::string facet =
    "solid one\n facet normal 0 0 nan\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   vertex 0 "
    "1 -0\n  endloop\n"
    " endfacet\n";
const std::string stl = facet + "endsolid one\n";

TriangleSurface read(const FileBytes& file) { return read_surface(file); }

void expect_surface_refused(const FileBytes& file, const std::string& place,
                            const std::vector<std::string>& parts) {
  expect_refused([&] { read(file); }, place, parts);
}

TEST(Surfaces, ObjWithEveryFormOfCorner) {
  SurfaceReport report;
  const TriangleSurface surface = read_surface(FileBytes{"m.obj", obj}, &report);
  EXPECT_EQ(surface.vertices[3], Point(0, 0, 1));
  EXPECT_EQ(surface.triangles,
            (std::vector<std::array<int, 3>>{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}));
  EXPECT_TRUE(report.closed());
  EXPECT_EQ(report.parts, 1);
  EXPECT_FALSE(report.turned);
  EXPECT_NEAR(enclosed_volume(surface), 1.0 / 6.0, 1e-15);
}

TEST(Surfaces, ObjPolygonsAreCutOrRefused) {
  const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.8 0.8 0\nf 1 2 3 4\n";
  EXPECT_EQ(read({"m.obj", square}).triangles,
            (std::vector<std::array<int, 3>>{{0, 1, 2}, {0, 2, 3}}));
  expect_surface_refused({"m.obj", with(square, "f 1 2 3 4", "f 1 3 2 4")}, "m.obj:6",
                         {"4 corners", "cut"});
}

TEST(Surfaces, TurnsAClosedSurfaceThatIsInsideOut) {
  std::string inside_out = with(with(obj, "f 1 3 2", "f 1 2 3"), "f 1/1 2/2 4/3", "f 2 1 4");
  inside_out = with(with(inside_out, "f 2//1 3//1", "f 3 2"), "f -4 -1 -2", "f 1 3 4");
  SurfaceReport report;
  const TriangleSurface surface = read_surface(FileBytes{"m.obj", inside_out}, &report);
  EXPECT_TRUE(report.turned);
  EXPECT_NEAR(enclosed_volume(surface), 1.0 / 6.0, 1e-15);
}

// A cube of four-cornered faces, each with the whole picture on it: u and v are told by a corner's
// place on its face.
std::string textured_cube() {
  std::string text = "vt 0 0\nvt 1 0\nvt 1 1 0\nvt 0 1\n";
  for (int i = 0; i < 8; ++i)
    text += "v " + std::to_string(i & 1) + " " + std::to_string(i >> 1 & 1) + " " +
            std::to_string(i >> 2) + "\n";
  for (const auto& f : {std::array{1, 3, 4, 2},
                        {5, 6, 8, 7},
                        {1, 2, 6, 5},
                        {3, 7, 8, 4},
                        {1, 5, 7, 3},
                        {2, 4, 8, 6}}) {
    text += "f";
    for (int k = 0; k < 4; ++k)
      text += " " + std::to_string(f[static_cast<std::size_t>(k)]) + "/" +
              (k == 3 ? "-1" : std::to_string(k + 1));
    text += "\n";
  }
  return text;
}

/// Each triangle is half of a face: u and v are affine in its plane with unit derivatives.
void expect_unit_texture(const TriangleSurface& surface, double sign) {
  ASSERT_EQ(surface.texture.size(), surface.triangles.size());
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& [a, b, c] = surface.texture[t];
    const double area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    EXPECT_EQ(area, sign);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto at = [&](std::size_t i) {
        return surface.vertices[static_cast<std::size_t>(surface.triangles[t][i % 3])];
      };
      const auto &uv = surface.texture[t][k], &next = surface.texture[t][(k + 1) % 3];
      EXPECT_NEAR(std::hypot(next[0] - uv[0], next[1] - uv[1]), (at(k + 1) - at(k)).norm(), 1e-15);
    }
  }
}

TEST(Surfaces, ObjTextureStaysWithItsCorners) {
  const TriangleSurface cube = read({"m.obj", textured_cube()});
  ASSERT_EQ(cube.triangles.size(), 12u);
  expect_unit_texture(cube, 1);

  std::string twice = textured_cube();  // a face again: the second one is dropped
  const std::string last = twice.substr(twice.rfind("f "));
  EXPECT_EQ(read({"m.obj", twice + last}).texture, cube.texture);

  const std::filesystem::path path("cube.obj");
  const WrittenMesh written = write_surface(path, cube);
  EXPECT_EQ(read({"cube.obj", written.files[0].bytes}).texture, cube.texture);
  EXPECT_TRUE(written.left_out.empty());
  EXPECT_EQ(write_surface("cube.stl", cube).left_out.size(), 1u);
}

TEST(Surfaces, ObjTextureOfFacesThatAreTurned) {
  std::string text = textured_cube();
  for (std::size_t at = text.find("\nf "); at != text.npos; at = text.find("\nf ", at + 1)) {
    // the second corner and the last one change places
    const std::size_t end = text.find('\n', at + 1);
    std::vector<std::string> words;
    std::istringstream line(text.substr(at + 3, end - at - 3));
    for (std::string word; line >> word;) words.push_back(word);
    text.replace(at, end - at,
                 "\nf " + words[0] + " " + words[3] + " " + words[2] + " " + words[1]);
  }
  SurfaceReport report;
  const TriangleSurface cube = read_surface(FileBytes{"m.obj", text}, &report);
  EXPECT_TRUE(report.turned);
  expect_unit_texture(cube, 1);
}

// Two halves of a square that have their own vertices on the common edge, and another picture each
TEST(Surfaces, ObjTextureIsKeptByAWeld) {
  const std::string halves =
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 0.25 0\nvt 0.5 1\n"
      "f 1/1 2/2 3/3\nf 4/3 5/2 6/1\n";
  SurfaceReport report;
  const TriangleSurface square = read_surface(FileBytes{"m.obj", halves}, &report, 1e-6);
  EXPECT_EQ(report.welded, 2);
  EXPECT_EQ(square.vertices.size(), 4u);
  const std::array<double, 2> first{0, 0}, second{0.25, 0}, third{0.5, 1};
  EXPECT_EQ(square.texture,
            (std::vector<CornerTexture>{{{first, second, third}}, {{third, second, first}}}));
}

TEST(Surfaces, ObjCornersWithoutTextureHaveZero) {
  EXPECT_TRUE(read({"m.obj", obj}).texture.empty());  // its faces name coordinates that it lacks
  const auto texture = read({"m.obj", obj + "vt 0.5 0.25\n"}).texture;
  ASSERT_EQ(texture.size(), 4u);
  EXPECT_EQ(texture[0][0], (std::array{0.0, 0.0}));
  EXPECT_EQ(texture[1][0], (std::array{0.5, 0.25}));  // the corner 1/1
  EXPECT_EQ(texture[1][1], (std::array{0.0, 0.0}));   // the corner 2/2
}

TEST(Surfaces, CountsWhatIsNotClosed) {
  SurfaceReport report;
  const auto read_with = [&](const std::string& from, const std::string& to) {
    read_surface(FileBytes{"m.obj", with(with(obj, "f -4 -1 -2", "f 1 4 3"), from, to)}, &report);
    return report;
  };
  EXPECT_EQ(read_with("f 1 3 2\n", "").open_edges, 3);
  EXPECT_FALSE(report.closed());
  EXPECT_EQ(read_with("f 1 3 2\n", "f 1 2 3\n").inconsistent_edges, 3);
  EXPECT_EQ(read_with("f 1 3 2\n", "v 1 1 0\nf 1 3 2\nf 2 3 5\n").crowded_edges, 1);
  EXPECT_EQ(read_with("f 1 3 2\n", "f 1 3 2\nf 3 2 1\n").repeated, 1);
  EXPECT_TRUE(report.closed());
  EXPECT_EQ(read_with("f 1 3 2\n", "f 1 3 2\nf 3 3 1\n").collapsed, 1);
  EXPECT_EQ(read_with("f 1 3 2\n", "v 9 9 9\nf 1 3 2\n").unreferenced, 1);
  EXPECT_EQ(read_with("f 1 3 2\n", "v 5 0 0\nv 6 0 0\nv 5 1 0\nf 1 3 2\nf 5 6 7\n").parts, 2);
}

TEST(Surfaces, EveryFormatHoldsTheSameBlocks) {
  for (const char* name : {"blocks.stl", "blocks_binary.stl", "blocks.obj"}) {
    SCOPED_TRACE(name);
    SurfaceReport report;
    const TriangleSurface surface = read_surface(sample(name), &report);
    // Gmsh wrote the groups of surfaces, and turned one of them
    const bool whole = std::string(name) == "blocks.obj";
    EXPECT_EQ(surface.triangles.size(), whole ? 40u : 20u);
    EXPECT_EQ(report.open_edges, whole ? 0 : 4);
    EXPECT_EQ(report.crowded_edges, 0);
    EXPECT_EQ(report.inconsistent_edges, whole ? 0 : 4);
    EXPECT_NEAR(surface_area(surface), whole ? 10 * 4e-4 : 5 * 4e-4, 1e-9);
  }
  for (const char* name : {"blocks_22.msh", "blocks_41_binary.msh"}) {
    SurfaceReport report;
    EXPECT_EQ(read_surface(sample(name), &report).triangles.size(), 20u);
    EXPECT_EQ(report.open_edges, 4);
  }
}

TEST(Surfaces, StlCornersAtOnePlaceAreOneVertex) {
  const TriangleSurface surface = read(sample("blocks.stl"));
  EXPECT_EQ(surface.vertices.size(), 13u);
  EXPECT_EQ(read({"m.stl", stl}).vertices.size(), 3u);
  const std::string below =
      with(with(facet, "vertex 1 0 0", "vertex 0 1 0"), "vertex 0 1 -0", "vertex 1 -0 0");
  const TriangleSurface both = read({"m.stl", stl + below + "endsolid\n"});
  EXPECT_EQ(both.vertices.size(), 3u);
  EXPECT_EQ(both.triangles.size(), 2u);
}

TEST(Surfaces, CutAtAnyByteIsRefused) {
  expect_whole({"m.stl", stl}, 5, read);  // the name after endsolid
  expect_whole(sample("blocks_binary.stl"), 0, read);
}

TEST(Surfaces, AnyByteChangedIsRefusedOrSound) {
  const auto check = [](const TriangleSurface& surface) { EXPECT_GT(surface_area(surface), 0.0); };
  change_every_byte({"m.obj", obj}, read, check);
  change_every_byte({"m.stl", stl}, read, check);
  change_every_byte(sample("blocks_binary.stl"), read, check);
}

TEST(MalformedSurfaces, Obj) {
  const auto refused = [](const std::string& from, const std::string& to, int line,
                          const std::vector<std::string>& parts) {
    expect_surface_refused({"m.obj", with(obj, from, to)}, "m.obj:" + std::to_string(line), parts);
  };
  expect_surface_refused({"m.obj", ""}, "m.obj", {"no triangle"});
  refused("v 0 0 0", "v 0 0", 1, {"three coordinates"});
  refused("v 0 0 0", "v 0 inf 0", 1, {"coordinate y is 'inf'"});
  refused("0 1 0 1.0", "0 1 0 0.5", 3, {"weight", "'0.5'"});
  refused("f 1 3 2", "f 1 3", 5, {"three corners"});
  refused("f 1 3 2", "vt 0 x", 5, {"texture coordinate v is 'x'"});
  refused("f 1 3 2", "f 1 3 9", 5, {"triangle 1 names node 9"});
  refused("f 1 3 2", "f 1 3 0", 5, {"'0'", "from 1"});
  refused("f 1 3 2", "f 1 3 -5", 5, {"'-5'", "only 4 vertices"});
  refused("f 1 3 2", "f 1 3 x", 5, {"'x'"});
  refused("f 1 3 2", "f 1 3 \\\n2", 5, {"not supported"});
  refused("f 1 3 2", "curv 1 2 3", 5, {"'curv'", "supported are polygons"});
  refused("v 0 1 0 1.0", "v 2 0 0", 5, {"triangle 1 has no area"});
}

TEST(MalformedSurfaces, Stl) {
  const auto refused = [](const std::string& from, const std::string& to, int line,
                          const std::vector<std::string>& parts) {
    expect_surface_refused({"m.stl", with(stl, from, to)}, "m.stl:" + std::to_string(line), parts);
  };
  expect_surface_refused({"m.stl", "liquid"}, "m.stl", {"no STL file"});
  refused("vertex 1 0 0", "vertex 1 0", 5, {"three coordinates"});
  refused("vertex 1 0 0", "vertex 1 0 nan", 5, {"coordinate z is 'nan'"});
  refused("   vertex 1 0 0\n", "", 6, {"vertex 3 of 3", "'endloop'"});
  refused("endloop", "vertex 2 2 2\nendloop", 7, {"endloop after three vertices"});
  refused("outer loop", "inner loop", 3, {"outer loop"});
  refused("endsolid one", "facets", 9, {"facet or endsolid"});
  const FileBytes file = sample("blocks_binary.stl");
  FileBytes changed = file;
  changed.bytes[82] = 1;
  expect_surface_refused(changed, file.name + ": byte 80",
                         {"triangles is 65556", "3277884 bytes", "has 1084"});
  changed = file;
  std::memcpy(changed.bytes.data() + 84 + 12 + 4, "\0\0\xc0\x7f", 4);
  expect_surface_refused(changed, file.name + ": byte 100", {"coordinate y is nan"});
}

const std::string nodes =
    "# made by hand\n5 3 1 1\n0 0 0 0  7.5  0\n1 1 0 0 7.5 2 # on the base\n\n2 0 1 0 7.5 2\n3 0 0 "
    "1 0 0\n4 1 1 1 0 "
    "-1\n";
const std::string tets = "2 4 1\n0 0 1 2 3 5\n1 1 2 3 4 2\n";

TetMesh read_tetgen(const std::string& ele, const std::string& node, MeshReport* report = nullptr) {
  MeshReport found;
  const TetMesh mesh = validated_mesh(parse_tetgen({"m.ele", ele}, {"m.node", node}, found), found);
  if (report) *report = found;
  return mesh;
}

void expect_refused_ele(const std::string& from, const std::string& to, int line,
                        const std::vector<std::string>& parts) {
  expect_refused([&] { read_tetgen(with(tets, from, to), nodes); }, "m.ele:" + std::to_string(line),
                 parts);
}
void expect_refused_node(const std::string& from, const std::string& to, int line,
                         const std::vector<std::string>& parts) {
  expect_refused([&] { read_tetgen(tets, with(nodes, from, to)); },
                 "m.node:" + std::to_string(line), parts);
}

TEST(TetGen, TakesTetrahedraRegionsAndMarkers) {
  MeshReport report;
  const TetMesh mesh = read_tetgen(tets, nodes, &report);
  EXPECT_EQ(mesh.vertices[3], Point(0, 0, 1));
  EXPECT_EQ(mesh.tets, (std::vector<std::array<int, 4>>{{0, 1, 2, 3}, {1, 2, 3, 4}}));
  EXPECT_EQ(mesh.region_names, (std::vector<std::string>{"attribute_2", "attribute_5"}));
  EXPECT_EQ(mesh.vertex_sets,
            (std::map<std::string, std::vector<int>>{{"marker_-1", {4}}, {"marker_2", {1, 2}}}));
  EXPECT_EQ(report.format, "TetGen .node and .ele");
}

TEST(TetGen, ReadsEitherFileOfThePairFromZeroAndFromOne) {
  for (const char* name : {"blocks.ele", "blocks.node", "blocks_0.ele", "blocks_0.node"}) {
    SCOPED_TRACE(name);
    MeshReport report;
    const TetMesh mesh = read_mesh(std::filesystem::path(sample(name).name), &report);
    const MeshQuality quality = mesh_quality(mesh);
    EXPECT_EQ(mesh.vertices.size(), 12u);
    EXPECT_EQ(report.vertex_tags.front(),
              std::string(name).find("_0") == std::string::npos ? 1 : 0);
    EXPECT_NEAR(quality.volume, 1.6e-5, 1e-17);
    EXPECT_EQ(mesh.region_names, (std::vector<std::string>{"attribute_1", "attribute_2"}));
    EXPECT_NEAR(quality.regions[1].volume, 8e-6, 1e-17);
    EXPECT_EQ(mesh.vertex_sets.at("marker_1"), (std::vector<int>{0, 1, 2, 3}));
  }
  EXPECT_THROW(read_mesh("no/such.ele"), InputError);
  EXPECT_THROW(read_mesh(FileBytes{"no/such.ele", tets}), InputError);
}

// But for the digits of the last number the lengths tell
TEST(TetGen, CutAtAnyByteIsRefused) {
  for (std::size_t bytes = 0; bytes + 2 < tets.size(); ++bytes)
    EXPECT_THROW(read_tetgen(tets.substr(0, bytes), nodes), InputError) << bytes;
  for (std::size_t bytes = 0; bytes + 3 < nodes.size(); ++bytes)
    EXPECT_THROW(read_tetgen(tets, nodes.substr(0, bytes)), InputError) << bytes;
}

TEST(TetGen, AnyByteChangedIsRefusedOrSound) {
  const auto check = [](const TetMesh& mesh) { EXPECT_GT(mesh_quality(mesh).volume, 0.0); };
  change_every_byte(
      {"m.ele", tets}, [](const FileBytes& file) { return read_tetgen(file.bytes, nodes); }, check);
  change_every_byte(
      {"m.node", nodes}, [](const FileBytes& file) { return read_tetgen(tets, file.bytes); },
      check);
}

TEST(MalformedTetGen, Nodes) {
  expect_refused([] { read_tetgen(tets, ""); }, "m.node", {"the number of nodes", "the file ends"});
  expect_refused_node("5 3 1 1", "6 3 1 1", 8, {"node 6 of 6", "the file ends"});
  expect_refused_node("5 3 1 1", "4 3 1 1", 8, {"end of the file after 4 nodes", "'4 1 1 1"});
  expect_refused_node("5 3 1 1", "5 2 1 1", 2, {"dimension is 2", "must be 3"});
  expect_refused_node("5 3 1 1", "5 3 0 1", 3, {"boundary marker", "'7.5'"});
  expect_refused_node("5 3 1 1", "5 3 2 1", 3, {"line ends", "boundary marker"});
  expect_refused_node("5 3 1 1", "5 3 1 2", 2, {"markers is 2", "0 to 1"});
  expect_refused_node("5 3 1 1", "99999999999 3 1 1", 2, {"99999999999", "room for"});
  expect_refused_node("5 3 1 1", "5 3 99999999999 1", 2, {"99999999999", "room for"});
  expect_refused_node("3 0 0 1 0 0", "3 0 nan 1 0 0", 7, {"coordinate y is 'nan'"});
  expect_refused_node("3 0 0 1 0 0", "2 0 0 1 0 0", 7,
                      {"node 2 is defined again (first on line 6)"});
}

TEST(MalformedTetGen, Tetrahedra) {
  expect_refused_ele("2 4 1\n", "2 10 1\n", 2, {"line ends", "a node of a tetrahedron"});
  expect_refused_ele("2 4 1\n", "2 5 1\n", 1, {"nodes of a tetrahedron is 5", "must be 4"});
  expect_refused_ele("1 1 2 3 4 2", "# 1 1 2 3 4 2", 3, {"tetrahedron 2 of 2", "the file ends"});
  expect_refused_ele("2 4 1\n", "1 4 1\n", 3, {"end of the file after 1 tetrahedra"});
  expect_refused_ele("2 4 1\n", "2 4 0\n", 2, {"'5' is too much"});
  expect_refused_ele("2 4 1\n", "2 4\n", 1, {"line ends", "number of attributes"});
  expect_refused_ele("3 5\n", "3 5.5\n", 2, {"'attribute' has the value 5.5", "expected integers"});
  expect_refused_ele("1 1 2 3 4 2", "1 1 2 3 9 2", 3, {"tetrahedron 1 names node 9"});
  expect_refused_ele("1 1 2 3 4 2", "1 1 2 3 3 2", 3, {"names a node twice"});
  expect_refused_ele("1 1 2 3 4 2", "1 0 2 3 1 2", 3,
                     {"tetrahedron 1 repeats tetrahedron 0 on line 2"});
}

}  // namespace
