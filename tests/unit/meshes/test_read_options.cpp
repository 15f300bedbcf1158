// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/meshes/files/list.hpp>
#include <plica/meshes/mesh_quality.hpp>
#include <plica/meshes/weld_open_edges.hpp>

#include "mesh_input.hpp"

// What a user may say about a file: regions, second order, welding; and files whose name is wrong.
namespace {

using namespace plica;
using namespace plica::test;
using Names = std::vector<std::string>;

// A row of cubes with 6 tetrahedra each around a diagonal, and arrays of these cells
std::string row_of_cubes(int cubes, const std::string& arrays) {
  std::string text = "# vtk DataFile Version 3.0\nrow\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS " +
                     std::to_string(4 * (cubes + 1)) + " double\n";
  for (int i = 0; i <= cubes; ++i)
    for (const char* yz : {" 0 0\n", " 1 0\n", " 1 1\n", " 0 1\n"}) text += std::to_string(i) + yz;
  text += "CELLS " + std::to_string(6 * cubes) + " " + std::to_string(30 * cubes) + "\n";
  // from corner 0 along the rest of the cube's edges to corner 6
  constexpr int paths[6][2] = {{4, 5}, {5, 1}, {1, 2}, {2, 3}, {3, 7}, {7, 4}};
  for (int i = 0; i < cubes; ++i)
    for (const auto& [a, b] : paths) {
      text += "4";
      for (const int v : {0, a, b, 6}) text += " " + std::to_string(4 * i + v);
      text += "\n";
    }
  text += "CELL_TYPES " + std::to_string(6 * cubes) + "\n";
  for (int t = 0; t < 6 * cubes; ++t) text += "10\n";
  return text + (arrays.empty() ? "" : "CELL_DATA " + std::to_string(6 * cubes) + "\n" + arrays);
}

template <class Value>
std::string scalars(const std::string& name, const std::string& type, int cells,
                    const Value& value) {
  std::string text = "SCALARS " + name + " " + type + " 1\nLOOKUP_TABLE default\n";
  for (int c = 0; c < cells; ++c) text += value(c) + "\n";
  return text;
}

const auto number_of = [](int cell) { return std::to_string(cell); };
const auto half_of = [](int cell) { return std::to_string(cell < 24 ? 1 : 2); };
const auto half_as_real = [](int cell) { return std::string(cell < 24 ? "1.0" : "2.0"); };

TetMesh read(const std::string& arrays, const ReadOptions& options = {},
             MeshReport* report = nullptr) {
  return read_mesh(FileBytes{"m.vtk", row_of_cubes(8, arrays)}, report, options);
}

bool noted(const MeshReport& report, const std::string& part) {
  return std::ranges::any_of(
      report.notes, [&](const std::string& note) { return note.find(part) != std::string::npos; });
}

TEST(Regions, NumbersOfCellsAreNone) {
  const std::string ids = scalars("vtkOriginalCellIds", "int", 48, number_of),
                    materials = scalars("MaterialIds", "double", 48, half_as_real);
  MeshReport report;
  const TetMesh mesh = read(ids + materials, {}, &report);
  EXPECT_EQ(mesh.region_names, (Names{"MaterialIds_1", "MaterialIds_2"}));
  EXPECT_EQ(std::ranges::count(mesh.region, 0), 24);
  EXPECT_TRUE(noted(report, "array 'MaterialIds'; not used: 'vtkOriginalCellIds'"));
  EXPECT_TRUE(read(ids, {}, &report).region_names.empty());
  EXPECT_TRUE(noted(report, "no array is taken for the regions; not used: 'vtkOriginalCellIds'"));
  expect_refused([&] { read(scalars("label", "int", 48, number_of)); }, "m.vtk",
                 {"'label' has a region of its own for each of 48 cells"});
}

TEST(Regions, AnArrayIsTakenByItsName) {
  const std::string both =
      scalars("parts", "int", 48, half_of) + scalars("kind", "float", 48, half_as_real);
  EXPECT_EQ(read(both, {.regions = "kind"}).region_names, (Names{"kind_1", "kind_2"}));
  EXPECT_TRUE(read(both, {.regions = "none"}).region_names.empty());
  expect_refused([&] { read(both, {.regions = "kinds"}); }, "m.vtk",
                 {"'kinds'; did you mean 'kind'?", "parts, kind, none"});
  const auto third = [](int cell) { return std::to_string(cell) + ".25"; };
  expect_refused([&] { read(scalars("x", "double", 48, third), {.regions = "x"}); }, "m.vtk:143",
                 {"'x' has the value 0.25; expected integers"});
  MeshReport report;
  read(both, {}, &report);
  EXPECT_TRUE(noted(report, "'parts'; not used: 'kind'"));
}

TEST(Regions, MayBeLeftOut) {
  const std::string halves = scalars("labels", "int", 48, half_of);
  MeshReport report;
  for (const char* one : {"1", "labels_1"}) {
    const TetMesh mesh = read(halves, {.leave_out = {one}}, &report);
    EXPECT_EQ(mesh.region_names, Names{"labels_2"});
    EXPECT_EQ(mesh.tets.size(), 24u);
    EXPECT_EQ(mesh.vertices.size(), 20u);
    EXPECT_EQ(report.left_out, (std::map<std::string, int>{{"labels_1", 24}}));
    EXPECT_EQ(report.unreferenced, 0) << "their points are no stray ones";
  }
  expect_refused([&] { read(halves, {.leave_out = {"0"}}); }, "m.vtk",
                 {"leave_out", "'0'", "labels_1, labels_2"});
  expect_refused([&] { read(halves, {.leave_out = {"1", "2"}}); }, "m.vtk", {"no tetrahedron"});
  // A hexahedron is left out with all tetrahedra that it is cut into
  const TetMesh cut = read_mesh(sample("blocks_hexahedra.msh"));
  ASSERT_EQ(cut.region_names.size(), 2u);
  const TetMesh part =
      read_mesh(sample("blocks_hexahedra.msh"), nullptr, {.leave_out = {cut.region_names[0]}});
  EXPECT_EQ(static_cast<std::ptrdiff_t>(part.tets.size()), std::ranges::count(cut.region, 1));
}

TEST(Regions, AllAttributesOfTetGenAreOffered) {
  const std::string nodes = "5 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 1 1\n",
                    tets = "2 4 2\n1 1 2 3 4 1.0 7\n2 2 3 4 5 2.0 8\n";
  MeshReport report;
  const auto parsed = [&] { return parse_tetgen({"m.ele", tets}, {"m.node", nodes}, report); };
  EXPECT_EQ(validated_mesh(parsed(), report).region_names, (Names{"attribute_1", "attribute_2"}));
  EXPECT_EQ(validated_mesh(parsed(), report, {.regions = "attribute2"}).region_names,
            (Names{"attribute2_7", "attribute2_8"}));
}

// One second-order tetrahedron of Gmsh; line 18 is the element
std::string ten_nodes(const std::string& middle = "1 0 0") {
  return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n10\n1 0 0 0\n2 2 0 0\n3 0 2 0\n4 0 0 "
         "2\n5 " +
         middle +
         "\n6 1 1 0\n7 0 1 0\n8 0 0 1\n9 0 1 1\n10 1 0 1\n$EndNodes\n$Elements\n2\n"
         "3 9 2 5 1 1 2 3 5 6 7\n7 11 2 1 1 1 2 3 4 5 6 7 8 9 10\n$EndElements\n";
}

TEST(SecondOrder, TheNodesOnEdgesAreFoundByTheirPlace) {
  MeshReport report;
  const TetMesh mesh = read_mesh(FileBytes{"m.msh", ten_nodes()}, &report);
  EXPECT_EQ(mesh.tets.size(), 8u);
  EXPECT_EQ(report.vertex_tags, (std::vector<std::int64_t>{1, 2, 3, 4, 5, 6, 7, 8, 9, 10}));
  EXPECT_EQ(report.tet_tags, std::vector<std::int64_t>(8, 7));
  EXPECT_EQ(report.flipped, 0);
  EXPECT_NEAR(mesh_quality(mesh).volume, 8.0 / 6, 1e-15);
  EXPECT_EQ(mesh.vertex_sets.at("physical_5"), (std::vector<int>{0, 1, 2, 4, 5, 6}))
      << "a group has the nodes on its edges, too";
  // VTK has the last two nodes in the other order
  const std::string swapped = with(ten_nodes(), "8 9 10\n$", "8 10 9\n$");
  EXPECT_EQ(read_mesh(FileBytes{"m.msh", swapped}).tets, mesh.tets);
  const std::string curved = ten_nodes("1 -0.3 -0.2");
  EXPECT_GT(mesh_quality(read_mesh(FileBytes{"m.msh", curved})).volume, 8.0 / 6);
}

TEST(SecondOrder, NodesOutOfPlaceAreRefused) {
  expect_refused(ten_nodes("0 0.9 0"), 20,
                 {"tetrahedron 7", "nodes 5 and 7", "order: linear, which takes the corners"});
  EXPECT_EQ(
      read_mesh(FileBytes{"m.msh", ten_nodes("0 0.9 0")}, nullptr, {.order = SecondOrder::linear})
          .tets.size(),
      1u);
}

TEST(Content, ComesBeforeTheName) {
  const std::string legacy = row_of_cubes(1, "");
  MeshReport report;
  const TetMesh mesh = read_mesh(FileBytes{"m.vtk", legacy}, &report);
  EXPECT_TRUE(report.notes.empty());
  for (const char* name : {"m.vtu", "m.msh", "m.dat", "m"}) {
    expect_same(read_mesh(FileBytes{name, legacy}, &report), mesh);
    EXPECT_TRUE(noted(report, "is VTK's legacy format by its first bytes")) << name;
  }
  const FileBytes xml = sample("blocks_zlib.vtu"), stl = sample("blocks.stl");
  expect_same(read_mesh(FileBytes{"m.vtk", xml.bytes}), read_mesh(xml));
  EXPECT_EQ(read_surface(FileBytes{"m.obj", stl.bytes}).triangles, read_surface(stl).triangles);
  expect_refused(FileBytes{"m.vtk", stl.bytes}, "m.vtk", {"is STL by its first bytes"});
  expect_refused(FileBytes{"m.msh", "\x1f\x8b\x08"}, "m.msh", {"compressed by gzip", "gunzip"});
}

// Two squares along x = 1, each with corners of its own there
std::string seam(double gap) {
  const std::string other = std::to_string(1 + gap);
  return "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv " + other + " 0 0\nv 2 0 0\nv 2 1 0\nv " + other +
         " 1 0\nf 1 2 3 4\nf 5 6 7 8\n";
}

TEST(Weld, JoinsPointsOnOpenEdges) {
  const auto read_seam = [](double gap, double weld) {
    SurfaceReport report;
    const TriangleSurface surface = read_surface(FileBytes{"m.obj", seam(gap)}, &report, weld);
    EXPECT_EQ(surface.vertices.size() + static_cast<std::size_t>(report.welded), 8u);
    EXPECT_EQ(surface.triangles.size(), 4u);
    EXPECT_EQ(report.parts, report.welded > 0 ? 1 : 2);
    EXPECT_EQ(report.open_edges, report.welded > 0 ? 6 : 8);
    return report.welded;
  };
  EXPECT_EQ(read_seam(0, weld_distance), 2);
  EXPECT_EQ(read_seam(2e-6, weld_distance), 2);
  EXPECT_EQ(read_seam(5e-6, weld_distance), 0);
  EXPECT_EQ(read_seam(5e-6, 1e-5), 2);
  EXPECT_EQ(read_seam(0, 0), 0);
}

TEST(Weld, ClosedPartsThatTouchStayApart) {
  // Two tetrahedra that have a face at one place
  const std::string one =
                        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n",
                    two =
                        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 -1\nf 5 6 7\nf 5 8 6\nf 6 8 7\nf 5 7 8\n";
  SurfaceReport report;
  const TriangleSurface surface = read_surface(FileBytes{"m.obj", one + two}, &report);
  EXPECT_TRUE(report.closed());
  EXPECT_EQ(report.parts, 2);
  EXPECT_EQ(surface.vertices.size(), 8u);
  EXPECT_EQ(report.welded, 0);
}

}  // namespace
