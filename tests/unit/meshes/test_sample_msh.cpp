// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <plica/meshes/mesh_quality.hpp>

#include "msh_text.hpp"
#include "support/tolerance.hpp"

// What Gmsh wrote, in every variant of its format
namespace {

using namespace plica;
using namespace plica::test;

TetMesh read(const MemoryFile& file) { return read_mesh(file); }

struct Variant {
  const char* file;
  const char* format;
  bool partitioned;  // has another order of nodes, and groups for the partitions
};
const Variant variants[] = {{"blocks_22.msh", "Gmsh MSH 2.2 ASCII", false},
                            {"blocks_22_binary.msh", "Gmsh MSH 2.2 binary", false},
                            {"blocks_41.msh", "Gmsh MSH 4.1 ASCII", false},
                            {"blocks_41_binary.msh", "Gmsh MSH 4.1 binary", false},
                            {"blocks_41_parametric.msh", "Gmsh MSH 4.1 ASCII", false},
                            {"blocks_41_parametric_binary.msh", "Gmsh MSH 4.1 binary", false},
                            {"blocks_41_partitioned.msh", "Gmsh MSH 4.1 ASCII", true},
                            {"blocks_41_partitioned_binary.msh", "Gmsh MSH 4.1 binary", true}};

TEST(SampleMsh, EveryVariantHoldsTheSameBlocks) {
  const TetMesh first = read(sample("blocks_22.msh"));
  for (const Variant& variant : variants) {
    SCOPED_TRACE(variant.file);
    MeshReport report;
    const TetMesh mesh = read_mesh(sample(variant.file), &report);
    EXPECT_EQ(report.format, variant.format);
    EXPECT_EQ(mesh.vertices.size(), first.vertices.size());
    EXPECT_EQ(mesh.tets.size(), first.tets.size());
    EXPECT_EQ(mesh.region_names, (std::vector<std::string>{"tissue", "large tumour"}));
    if (!variant.partitioned) {
      EXPECT_LE(largest_difference(mesh.vertices, first.vertices), 1e-17);  // Gmsh writes 16 digits
      EXPECT_EQ(mesh.vertex_sets, first.vertex_sets);
    }
    for (const auto& [name, set] : first.vertex_sets) EXPECT_EQ(mesh.vertex_sets.at(name).size(), set.size()) << name;
    const MeshQuality quality = mesh_quality(mesh);
    EXPECT_NEAR(quality.volume, 2 * 8e-6, 1e-15);
    EXPECT_NEAR(quality.regions[1].volume, 8e-6, 1e-15);
    EXPECT_EQ(report.flipped, 0);
  }
}

TEST(SampleMsh, GroupsOfEveryDimensionAreSets) {
  const TetMesh mesh = read(sample("blocks_41_binary.msh"));
  std::map<std::string, std::size_t> sizes;
  for (const auto& [name, set] : mesh.vertex_sets) sizes[name] = set.size();
  EXPECT_EQ(sizes, (std::map<std::string, std::size_t>{
                       {"base", 5}, {"lower half of the side", 12}, {"edge", 3}, {"corner", 1}}));
  for (const int v : mesh.vertex_sets.at("base")) EXPECT_EQ(mesh.vertices[static_cast<std::size_t>(v)].z(), 0.0);
}

// The last line feed may be missing; where a section follows that is skipped, a cut there is still a whole mesh
TEST(SampleMsh, CutAtAnyByteIsRefused) {
  for (const Variant& variant : variants) {
    SCOPED_TRACE(variant.file);
    if (!variant.partitioned) expect_whole(sample(variant.file), 1, read);
  }
}

TEST(SampleMsh, AnyByteChangedIsRefusedOrSound) {
  for (const char* name : {"blocks_22_binary.msh", "blocks_41.msh", "blocks_41_binary.msh"}) {
    SCOPED_TRACE(name);
    change_every_byte(sample(name), read, [](const TetMesh& mesh) { EXPECT_GT(mesh_quality(mesh).volume, 0.0); },
                      {'\0', '\x01', '9', '\xff'});
  }
}

std::string swapped(std::string bytes, std::size_t at, std::size_t size) {
  std::reverse(bytes.begin() + static_cast<long>(at), bytes.begin() + static_cast<long>(at + size));
  return bytes;
}

// Two tetrahedra of two_tets as a machine of the other order of bytes writes them
std::string other_order() {
  std::string text = "$MeshFormat\n2.2 1 8\n";
  const auto put = [&text](auto value) {
    text.append(reinterpret_cast<const char*>(&value), sizeof(value));
    text = swapped(text, text.size() - sizeof(value), sizeof(value));
  };
  put(1);
  text += "\n$EndMeshFormat\n$Nodes\n5\n";
  const double points[5][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  const int tags[5] = {1, 2, 3, 10, 11};
  for (int i = 0; i < 5; ++i) {
    put(tags[i]);
    for (const double x : points[i]) put(x);
  }
  text += "\n$EndNodes\n$Elements\n3\n";
  for (const int x : {2, 1, 2, 6, 4, 1, 1, 2, 3, 4, 2, 2, 7, 1, 1, 1, 2, 3, 10, 8, 2, 2, 2, 3, 10, 11}) put(x);
  return text + "\n$EndElements\n";
}

TEST(SampleMsh, EitherOrderOfBytes) {
  TetMesh mesh = read_text(other_order());
  TetMesh same = read_text(two_tets);
  EXPECT_EQ(mesh.region_names, (std::vector<std::string>{"physical_1", "physical_2"}));
  mesh.region_names = same.region_names;
  mesh.vertex_sets = {{"base", mesh.vertex_sets.at("physical_4")}};
  expect_same(mesh, same);
}

}  // namespace
