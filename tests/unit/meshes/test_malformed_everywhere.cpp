// SPDX-License-Identifier: BSD-3-Clause
#include <limits>
#include <plica/meshes/files/list.hpp>
#include <plica/meshes/files/sound_mesh.hpp>
#include <plica/meshes/mesh_quality.hpp>

#include "mesh_input.hpp"

// Every class of malformed mesh in every format that is written, text and binary: the same is said of all of them.
namespace {

using namespace plica;
using namespace plica::test;

class Malformed : public testing::TestWithParam<Writer<TetMesh>> {
 protected:
  // Two tetrahedra with a face in common
  TetMesh mesh = [] {
    TetMesh two;
    two.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
    two.tets = {{0, 1, 2, 3}, {1, 2, 3, 4}};
    return two;
  }();

  TetMesh read(MeshReport& report) const {
    const std::vector<MemoryFile> files = GetParam().write(std::string("m.") + GetParam().extension, mesh).files;
    if (files.size() == 1) return read_mesh(files[0], &report);
    return sound_mesh(parse_tetgen(files[1], files[0], report), report);
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
      for (const std::string& part : parts) EXPECT_NE(message.find(part), std::string::npos) << message;
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
  for (const double value : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
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
  for (const int v : {1, 2, 3}) mesh.vertices.push_back(Point(mesh.vertices[static_cast<std::size_t>(v)]));
  mesh.tets[1] = {5, 6, 7, 4};
  const TetMesh torn = read();
  EXPECT_EQ(count_duplicate_vertices(torn, 1e-9), 3);
  EXPECT_EQ(count_parts(torn), 2);
}

INSTANTIATE_TEST_SUITE_P(All, Malformed, testing::ValuesIn(mesh_writers), [](const auto& one) {
  return std::string(one.param.extension) + "_" + one.param.name + (one.param.binary ? "_binary" : "");
});

}  // namespace
