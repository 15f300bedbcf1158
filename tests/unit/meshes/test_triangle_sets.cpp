// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/files/validated_mesh.hpp>
#include <plica/meshes/generators.hpp>
#include <plica/meshes/refinement.hpp>
#include <plica/meshes/reordering.hpp>
#include <plica/meshes/repair_mesh.hpp>
#include <set>

#include "mesh_input.hpp"

// Groups of triangles in files, and what is done to meshes that have some.
namespace {

using namespace plica;
using namespace plica::test;
using Triangles = std::vector<std::array<int, 3>>;

FileBytes deck_of(const std::string& format, const std::string& name) {
  return {"m." + format,
          load_file(std::filesystem::path(PLICA_SOURCE_DIR) / "tests/fuzz/corpus" / format / name)
              .bytes};
}

Triangles ascending(Triangles all) {
  for (auto& triangle : all) std::ranges::sort(triangle);
  std::ranges::sort(all);
  return all;
}

double area_of(const TetMesh& mesh, const std::string& name) {
  return surface_area({mesh.vertices, mesh.triangle_sets.at(name)});
}

// A box of which the group "top" is all triangles at z = 1 but the first
TetMesh with_a_top() {
  TetMesh mesh = box_mesh({{0, 0, 0}, {1, 1, 1}}, {2, 2, 2});
  std::set<int> vertices;
  for (const auto& t : boundary_triangles(mesh))
    if (std::ranges::all_of(
            t, [&](int v) { return mesh.vertices[static_cast<std::size_t>(v)][2] == 1; }))
      mesh.triangle_sets["top"].push_back(t);
  Triangles& top = mesh.triangle_sets["top"];
  top.erase(top.begin());
  for (const auto& t : top) vertices.insert(t.begin(), t.end());
  mesh.vertex_sets["top"] = {vertices.begin(), vertices.end()};
  return mesh;
}

TEST(TriangleSets, OfFiles) {
  EXPECT_EQ(read_text(two_tets).triangle_sets,
            (std::map<std::string, Triangles>{{"base", {{0, 1, 2}}}}));
  EXPECT_EQ(read_text(two_tets_4).triangle_sets, read_text(two_tets).triangle_sets);
  const TetMesh inp = read_mesh(deck_of("inp", "two")), feb = read_mesh(deck_of("feb", "two_25"));
  for (const TetMesh* mesh : {&inp, &feb}) {
    EXPECT_EQ(ascending(mesh->triangle_sets.at("face")), (Triangles{{2, 3, 4}}));
    EXPECT_FALSE(mesh->triangle_sets.contains("base")) << "a set of nodes";
  }
  EXPECT_EQ(ascending(read_mesh(deck_of("inp", "part")).triangle_sets.at("side")),
            (Triangles{{0, 4, 6}, {1, 4, 5}, {2, 5, 6}, {4, 5, 6}}))
      << "second order is split";
  const TetMesh medit = read_mesh(sample("blocks.mesh")), msh = read_mesh(sample("blocks_41.msh"));
  std::size_t in_medit = 0, in_msh = 0;
  for (const auto& [name, set] : medit.triangle_sets) in_medit += set.size();
  for (const auto& [name, set] : msh.triangle_sets) in_msh += set.size();
  EXPECT_GT(in_msh, 0u);
  EXPECT_EQ(in_medit, in_msh);
}

TEST(TriangleSets, AreWrittenWithoutTheGroupsOfAFile) {
  TetMesh mesh = with_a_top();
  mesh.vertex_sets["top"].insert(mesh.vertex_sets["top"].begin(), 0);  // a vertex besides
  for (const char* format : {"msh22", "msh41"}) {
    const TetMesh back = read_mesh(write_mesh("m.msh", mesh, format).files.front());
    EXPECT_EQ(ascending(back.triangle_sets.at("top")), ascending(mesh.triangle_sets.at("top")))
        << format;
    EXPECT_EQ(back.vertex_sets, mesh.vertex_sets) << format;
  }
}

TEST(TriangleSets, GoWithTheirVertices) {
  const TetMesh mesh = with_a_top();
  EXPECT_EQ(mesh.triangle_sets.at("top").size(), 7u);
  const TetMesh fine = refined(mesh), other = reordered(mesh, locality_order(mesh));
  EXPECT_EQ(fine.triangle_sets.at("top").size(), 28u);
  for (const TetMesh* one : {&fine, &other}) {
    EXPECT_NEAR(area_of(*one, "top"), 7.0 / 8, 1e-14);
    const Triangles boundary = ascending(boundary_triangles(*one));
    for (const auto& t : ascending(one->triangle_sets.at("top")))
      EXPECT_TRUE(std::ranges::binary_search(boundary, t));
  }
  // The vertices of the upper right quarter stand twice
  TetMesh torn = mesh;
  std::vector<int> twin(mesh.vertices.size(), -1);
  for (std::size_t t = 36; t < torn.tets.size(); ++t)
    for (int& v : torn.tets[t]) {
      int& n = twin[static_cast<std::size_t>(v)];
      if (n < 0)
        n = static_cast<int>(torn.vertices.size()),
        torn.vertices.push_back(mesh.vertices[static_cast<std::size_t>(v)]);
      v = n;
    }
  for (auto& t : torn.triangle_sets["top"])
    for (int& v : t)
      if (twin[static_cast<std::size_t>(v)] >= 0) v = twin[static_cast<std::size_t>(v)];
  const TetMesh repaired = repair_mesh(torn).mesh, merged = merge_duplicates(torn, 1e-9).mesh;
  for (const TetMesh* one : {&repaired, &merged}) {
    EXPECT_EQ(one->triangle_sets.at("top").size(), 7u);
    EXPECT_NEAR(area_of(*one, "top"), 7.0 / 8, 1e-14);
  }
}

// What only some of the formats hold
TEST(FilledParts, OfAMeshInMsh) {
  TetMesh mesh = box_mesh({{0, 0, 0}, {1, 1, 1}}, {1, 1, 1});
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    mesh.filled.push_back(1 / (1.0 + static_cast<double>(t)));
  mesh.tet_vectors["fibres"].assign(mesh.tets.size(), Point(0, 1, 0.5));
  for (const char* format : {"msh22", "msh41"})
    for (const bool binary : {false, true}) {
      const FileBytes file = write_mesh("m.msh", mesh, format, binary).files.front();
      const TetMesh back = read_mesh(file);
      EXPECT_EQ(back.filled, mesh.filled);
      EXPECT_EQ(back.tet_vectors, mesh.tet_vectors);
    }
  EXPECT_FALSE(write_mesh("m.vtu", mesh).left_out.empty());
  const FileBytes text = write_mesh("m.msh", mesh, "msh22").files.front();
  expect_refused(FileBytes{"m.msh", with(text.bytes, "2 0.5\n", "2 1.5\n")}, "m.msh",
                 {"tetrahedron 2 is filled to 1.5; expected a part in (0, 1]"});
  expect_refused(FileBytes{"m.msh", with(text.bytes, "2 0.5\n", "1 0.5\n")}, "m.msh:50",
                 {"tag 1 has a part already"});
  EXPECT_EQ(merge_duplicates(mesh, 1e-9).mesh.filled, mesh.filled);
}

}  // namespace
