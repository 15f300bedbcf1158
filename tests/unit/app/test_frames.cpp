// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/drivers/app/output/frames.hpp>
#include <plica/drivers/app/output/write_file.hpp>
#include <plica/drivers/app/report/read_files.hpp>
#include <plica/meshes/files/mesh_files.hpp>

#include "unit/app/child.hpp"

namespace plica::app::test {
namespace {

// A triangle and points, with an array of every kind
VtuGrid triangle_with(int points) {
  VtuGrid grid;
  for (int i = 0; i < points; ++i) grid.points.emplace_back(i / 3.0, 0.1 * i, -1e-300 * i);
  grid.connectivity = {2, 0, 1};
  grid.point_fields = {{"velocity", grid.points}};
  grid.point_scalars = {{"mass", std::vector(grid.points.size(), 1.0 / points)}};
  grid.cell_scalars = {{"J", {1.0 / 3}}};
  grid.cell_vectors = {{"fibre", {Point(0.6, -0.8, 0)}}};
  grid.cell_fields = {{"body", {-points}}};
  return grid;
}

TEST(Vtu, IsReadToTheBit) {
  const TemporaryFolder folder;
  for (const int points : {3, 4, 5}) {  // with and without padding
    const VtuGrid grid = triangle_with(points);
    write_file(folder / "a.vtu", vtu_text(grid));
    const FrameFile frame = read_frame(folder / "a.vtu");
    EXPECT_EQ(frame.points, grid.points);
    EXPECT_EQ(frame.triangles, (std::vector<std::array<int, 3>>{{2, 0, 1}}));
    std::vector<std::string> names;
    for (const FrameArray& array : frame.arrays) names.push_back(array.name);
    EXPECT_EQ(names, (std::vector<std::string>{"velocity", "mass", "J", "fibre", "body"}));
    std::vector<double> velocities;
    for (const Point& p : grid.points) velocities.insert(velocities.end(), {p.x(), p.y(), p.z()});
    EXPECT_EQ(frame.find("velocity")->values, velocities);
    EXPECT_EQ(frame.find("mass")->values, grid.point_scalars[0].values);
    EXPECT_EQ(frame.find("J")->values, grid.cell_scalars[0].values);
    EXPECT_EQ(frame.find("fibre")->values, (std::vector<double>{0.6, -0.8, 0}));
    EXPECT_EQ(frame.find("body")->values, std::vector<double>{-1.0 * points});
  }
}

// The order of the arrays in the file is that of the tags, whatever the compiler
TEST(Vtu, HasItsArraysInTheOrderOfTheirTags) {
  const std::string text = vtu_text(triangle_with(4));
  std::vector<std::size_t> offsets;
  for (std::size_t at = 0; (at = text.find("offset=\"", at)) != std::string::npos;)
    offsets.push_back(std::stoul(text.substr(at += 8)));
  ASSERT_EQ(offsets.size(), 9);
  EXPECT_TRUE(std::ranges::is_sorted(offsets));
}

// By Python's parser, which takes nothing but XML
TEST(Vtu, IsStrictXml) {
  const TemporaryFolder folder;
  Frames(folder.path(), "surface", "frames.pvd").write(triangle_with(5));
  TetMesh mesh;
  mesh.vertices = {Point(0, 0, 0), Point(1, 0, 0), Point(0, 1, 0), Point(0, 0, 1)};
  mesh.tets = {{0, 1, 2, 3}};
  mesh.tet_vectors = {{"<fibres> \xfc & \"more\"", {Point(1, 0, 0)}}};
  write_files(write_mesh(folder / "mesh.vtu", mesh).files);
  const Child child = run_child(
      {python(), "-c", "import sys, xml.etree.ElementTree as x\nfor f in sys.argv[1:]: x.parse(f)",
       folder / "frames.pvd", folder / "frames/surface_0000.vtu", folder / "mesh.vtu"},
      folder);
  if (child.status == 127 || child.status < 0) GTEST_SKIP() << "no Python here";
  EXPECT_EQ(child.status, 0) << child.errors;
}

}  // namespace
}  // namespace plica::app::test
