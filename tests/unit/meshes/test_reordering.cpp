// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/meshes/files/sound_mesh.hpp>
#include <plica/meshes/generators.hpp>
#include <plica/meshes/mesh_quality.hpp>
#include <plica/meshes/reordering.hpp>

#include "mesh_input.hpp"

namespace {

using namespace plica;
using namespace plica::test;

TetMesh beam() { return read_mesh(std::filesystem::path(PLICA_SOURCE_DIR) / "meshes" / "data" / "beam.msh"); }

TEST(Reordering, KeepsTheMesh) {
  const TetMesh before = beam();
  const Reordering order = locality_order(before);
  const TetMesh after = reordered(before, order);
  ASSERT_EQ(after.vertices.size(), before.vertices.size());
  ASSERT_EQ(after.tets.size(), before.tets.size());
  std::vector<int> sorted = order.tets;
  std::sort(sorted.begin(), sorted.end());
  EXPECT_EQ(std::unique(sorted.begin(), sorted.end()), sorted.end());
  for (std::size_t t = 0; t < after.tets.size(); ++t) {
    const auto old = static_cast<std::size_t>(order.tets[t]);
    EXPECT_EQ(after.region[t], before.region[old]);
    for (std::size_t k = 0; k < 4; ++k)
      EXPECT_EQ(order.vertices[static_cast<std::size_t>(after.tets[t][k])], before.tets[old][k]);
  }
  EXPECT_EQ(after.vertices, permuted(before.vertices, order.vertices));
  std::vector<int> base;
  for (const int v : after.vertex_sets.at("base")) base.push_back(order.vertices[static_cast<std::size_t>(v)]);
  std::sort(base.begin(), base.end());
  EXPECT_EQ(base, before.vertex_sets.at("base"));
  EXPECT_TRUE(std::is_sorted(after.vertex_sets.at("base").begin(), after.vertex_sets.at("base").end()));
}

TEST(Reordering, BringsNeighboursTogether) {
  const TetMesh before = beam();
  const TetMesh after = reordered(before, locality_order(before));
  EXPECT_LT(mean_vertex_span(after), 0.4 * mean_vertex_span(before));
  // and again the same, as its tetrahedra are where they were
  EXPECT_EQ(locality_order(after).tets.front(), 0);
}

// A torn mesh: two boxes whose common vertices are there twice
TetMesh torn() {
  TetMesh mesh = box_mesh({Point(0, 0, 0), Point(1, 1, 1)}, {2, 2, 2});
  const TetMesh other = box_mesh({Point(1, 0, 0), Point(2, 1, 1)}, {2, 2, 2});
  const int first = static_cast<int>(mesh.vertices.size());
  for (const Point& p : other.vertices) mesh.vertices.push_back(p + Point(1e-9, 0, 0));
  for (auto tet : other.tets) {
    for (int& v : tet) v += first;
    mesh.tets.push_back(tet);
  }
  mesh.vertex_sets["all"].resize(mesh.vertices.size());
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) mesh.vertex_sets["all"][v] = static_cast<int>(v);
  return mesh;
}

TEST(MergeDuplicates, GluesATornMesh) {
  const TetMesh mesh = torn();
  EXPECT_EQ(count_parts(mesh), 2);
  const MergedMesh glued = merge_duplicates(mesh, 1e-6);
  EXPECT_EQ(glued.merged, 9);
  EXPECT_EQ(glued.mesh.vertices.size(), mesh.vertices.size() - 9);
  EXPECT_EQ(glued.mesh.vertex_sets.at("all").size(), glued.mesh.vertices.size());
  EXPECT_EQ(count_parts(glued.mesh), 1);
  EXPECT_NEAR(mesh_quality(glued.mesh).volume, 2.0, 1e-8);
  for (std::size_t v = 0; v < glued.original_vertex.size(); ++v)
    EXPECT_EQ(glued.mesh.vertices[v], mesh.vertices[static_cast<std::size_t>(glued.original_vertex[v])]);
  EXPECT_EQ(merge_duplicates(mesh, 0.0).merged, 0);  // none is at exactly the same place
}

TEST(MergeDuplicates, RefusesWhatItWouldBreak) {
  const TetMesh mesh = torn();
  EXPECT_THROW(merge_duplicates(mesh, -1.0), InputError);
  EXPECT_THROW(merge_duplicates(mesh, std::numeric_limits<double>::quiet_NaN()), InputError);
  expect_refused([&] { merge_duplicates(mesh, 0.6); }, "vertices at most 0.6 m apart cannot be merged",
                 {"tetrahedron 0 names a node twice"});
  TetMesh twice = box_mesh({Point(0, 0, 0), Point(1, 1, 1)}, {1, 1, 1});
  const std::size_t tets = twice.tets.size();
  const int first = static_cast<int>(twice.vertices.size());
  for (std::size_t v = 0; v < static_cast<std::size_t>(first); ++v) twice.vertices.push_back(Point(twice.vertices[v]));
  for (std::size_t t = 0; t < tets; ++t) {
    auto tet = twice.tets[t];
    for (int& v : tet) v += first;
    twice.tets.push_back(tet);
  }
  EXPECT_THROW(merge_duplicates(twice, 0.0), InputError);
}

}  // namespace
